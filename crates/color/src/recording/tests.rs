use neurotess_mesh::Role;
use neurotess_picture::color::CATEGORY_BIT;

use super::*;
use crate::CellSeries;

#[test]
fn numbers_in_memory_are_a_recording() {
    let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 20 0 1 2\n4 3 0 40 0 1 3\n";
    let read = neurotess_formats::swc::read_bytes(text, "cell", &Default::default());
    let morphology = read.expect("a cell").morphology;
    let generated = neurotess_generate::generate(&morphology, &Default::default());
    let mesh = generated.expect("meshed").mesh;
    let cell = Cell {
        name: "",
        morphology: &morphology,
        mesh: &mesh,
        radius_factor: 1.0,
    };
    let time = TimeAxis {
        start: 10.0,
        end: 11.0,
        step: 0.5,
        frames: 2,
    };
    let series = OwnSeries {
        cells: vec![CellSeries {
            points: vec![Some(1), None, Some(2)],
            soma: Some(0),
            columns: 3,
            values: vec![-65.0, -64.0, -63.0, 5.0, 6.0, f32::NAN],
        }],
        time,
        title: "voltage".into(),
        unit: "mV".into(),
    };
    let recording = Recording::of_series(series, &[cell], &[0, 0]);
    assert_eq!((recording.places(), recording.without()), (2, 0));
    for (point, &key) in mesh.tracing.iter().zip(&recording.color_keys()[0]) {
        let expected = match (point.role, point.sample.0) {
            (Role::Soma, _) => 0,
            (_, 2) => 1,
            (_, 3) => category(0),
            _ => 2,
        };
        assert_eq!(key, expected, "{point:?}");
    }
    let frame = recording.at(10.7, DECAY, &|_| true).expect("a frame");
    assert_eq!(frame.of(1)[..2], [5.0, 6.0]);
    let range = recording.range(&|_| true).expect("a range");
    assert_eq!(range, [-65.0, 6.0]);
    let keys = recording.color_keys()[0].iter().enumerate();
    let visible: Vec<_> = keys
        .filter(|(_, key)| *key & CATEGORY_BIT == 0)
        .map(|(_, &color_key)| neurotess_picture::recolor::VisibleKey {
            instance: 1,
            color_key,
        })
        .collect();
    let found = recording.visible(&visible);
    let values = recording.visible_at(10.0, DECAY, &found).expect("values");
    for (key, value) in visible.iter().zip(values) {
        assert_eq!(value, [-65.0, -64.0, -63.0][key.color_key as usize]);
    }
    let beyond = recording.at(11.0, DECAY, &|_| true).expect_err("the end");
    let expected = "voltage: has no values at 11 ms: choose a time from 10 to below 11";
    assert_eq!(beyond.to_string(), expected);
}
