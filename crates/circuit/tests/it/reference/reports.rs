//! Reports of others against values that h5py gives.

use neurotess_circuit::{RecordingFile, Report, ReportKind, Spikes};
use neurotess_testing::shared;
use serde_json::Value;

use super::sonata::sonata;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[neurotess_testing::test(needs(shared))]
fn reports_have_the_values_of_the_reference() {
    let sonata = sonata();
    let path = sonata.with_file_name("sonata_reference.json");
    let text = std::fs::read_to_string(path).expect("the reference");
    let reference: Value = serde_json::from_str(&text).expect("JSON");
    let files = [
        "bbp/usecase1/reporting/compartment_report.h5",
        "bbp/usecase1/reporting/soma_report.h5",
        "brion/compartment_report.h5",
        "allen/5_cells_iclamp/output/membrane_potential.h5",
    ];
    for file in files {
        let report = Report::open(sonata.join(file)).expect(file);
        for values in &report.populations {
            let name = if values.name.is_empty() {
                "(root)"
            } else {
                &values.name
            };
            let expected = &reference[format!("sonata/{file}")][format!("report:{name}")];
            let shape = [values.time.frames, values.compartment_count()];
            assert_eq!(
                shape.map(Some),
                [0, 1].map(|i| expected["shape"][i].as_u64()),
                "{file}"
            );
            assert_eq!(values.time.announced(), values.time.frames, "{file}");
            let ids = expected["node_ids"].as_array().expect("ids");
            let ids: Vec<u64> = ids.iter().filter_map(Value::as_u64).collect();
            assert_eq!(values.nodes, ids);
            let first = values.compartment_range(1).start;
            assert_eq!(Some(first), expected["index_pointers"][1].as_u64());
            let all: Vec<u64> = (0..values.compartment_count()).collect();
            let begin = values.values(0, &all[..2]).expect("values");
            for (i, value) in begin.iter().enumerate() {
                let expected = number(&expected["frame0_first"][i]) as f32;
                assert_eq!(*value, expected, "{file}");
            }
            let last = values
                .values(shape[0] - 1, &all[all.len() - 1..])
                .expect("values");
            assert_eq!(
                last[0],
                number(&expected["lastframe_last"]) as f32,
                "{file}"
            );
            if shape[0] <= 10 {
                let frames = (0..shape[0]).flat_map(|f| values.values(f, &all).expect("values"));
                let sum: f64 = frames.map(f64::from).sum();
                assert!(
                    (sum - number(&expected["sum"])).abs() < 1e-3,
                    "{file} {sum}"
                );
            }
            assert!(values.values(shape[0], &[0]).is_err());
            assert!(values.values(0, &[shape[1]]).is_err());
        }
    }
}

#[neurotess_testing::test(needs(shared))]
fn compartments_have_their_sections() {
    let sonata = sonata();
    let report = Report::open(sonata.join("brion/compartment_report.h5")).expect("a report");
    let values = &report.populations[0];
    assert_eq!(values.kind(), ReportKind::Compartment);
    let sections: Vec<u64> = values
        .compartments(1)
        .expect("some")
        .iter()
        .map(|c| c.section)
        .collect();
    assert_eq!(sections, [0, 4, 4, 3, 2]);
    assert_eq!(values.index_of(2), Some(2));
    assert_eq!(values.units, "mV");
    let allen = sonata.join("allen/5_cells_iclamp/output/membrane_potential.h5");
    let report = Report::open(allen).expect("a report");
    assert_eq!(report.populations[0].kind(), ReportKind::Soma);
    assert_eq!(
        report.populations[0].compartments(4).expect("one")[0].along,
        0.5
    );
}

#[neurotess_testing::test(needs(shared))]
fn spikes_of_both_simulators_are_read() {
    let sonata = sonata();
    let bbp = Spikes::open(sonata.join("bbp/usecase1/reporting/spikes.h5")).expect("spikes");
    assert_eq!(
        bbp.populations[0].times,
        [0.2, 0.4, 0.6000000000000001, 0.7000000000000001, 0.8]
    );
    let path = sonata.join("allen/5_cells_iclamp/output/spikes.h5");
    let Ok(RecordingFile::Spikes(allen)) = RecordingFile::open(path) else {
        panic!("no spikes");
    };
    let spikes = &allen.populations[0];
    assert_eq!(
        (spikes.times.len(), spikes.nodes[..3].to_vec()),
        (124, vec![2, 0, 1])
    );
    assert_eq!((spikes.times[0], spikes.times[123]), (533.0, 2999.6));
}
