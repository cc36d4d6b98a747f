//! What is written is what was read, or it is said what is not.

use neurotess_formats::{Format, Read, ReadOptions, Warning, read_bytes, write};
use neurotess_morphology::Measures;

fn read(bytes: &[u8], format: Format) -> Read {
    let read = read_bytes(
        bytes.to_vec(),
        "cell",
        Some(format),
        &ReadOptions::default(),
    );
    read.expect("read")
}

fn copied(read_first: &Read, format: Format) -> (Measures, Vec<Warning>) {
    let mut bytes = Vec::new();
    let lost = write(&read_first.morphology, format, &mut bytes).expect("memory takes it");
    (Measures::of(&read(&bytes, format).morphology), lost)
}

fn codes(lost: &[Warning]) -> Vec<&'static str> {
    lost.iter().map(|warning| warning.code).collect()
}

/// An outline that does not lie in a plane, of points with a diameter.
const OUTLINE: &str = "(\"CellBody\" (Color Red) (CellBody)
 (10 0 0 0.3) (7 7 0 0.3) (0 10 0 0.3) (-7 7 3 0.3) (-10 0 3 0.3) (-7 -7 3 0.3) (0 -10 3 0.2) (7 -7 0 0.3))
((Dendrite) (0 12 0 2) (0 60 0 2))
";

#[neurotess_testing::test]
fn an_outline_becomes_a_sphere_of_its_radius_in_swc() {
    let outlined = read(OUTLINE.as_bytes(), Format::Asc);
    let before = Measures::of(&outlined.morphology);
    assert!(
        (before.soma.radius - 9.53).abs() < 0.01,
        "{}",
        before.soma.radius
    );
    let (after, lost) = copied(&outlined, Format::Swc);
    assert!((after.soma.radius - before.soma.radius).abs() < 1e-4);
    assert_eq!(
        (after.soma.kind, codes(&lost)),
        ("point", vec!["soma_as_sphere"])
    );
    assert_eq!(after.length, before.length);
    // An outline that SWC has itself stays as it is.
    let of_swc =
        "1 1 10 0 0 0 -1\n2 1 0 10 0 0 1\n3 1 -10 0 0 0 2\n4 1 0 -10 0 0 3\n5 3 0 20 0 1 1\n";
    let outlined = read(of_swc.as_bytes(), Format::Swc);
    let (after, lost) = copied(&outlined, Format::Swc);
    assert_eq!(after.soma.kind, "contour");
    assert!(lost.is_empty(), "{lost:?}");
}

#[neurotess_testing::test]
fn points_of_type_1_in_a_neurite_are_points_in_every_format() {
    let text = "1 0 0 0 0 0.2 -1\n2 0 0 70 0 0.2 1\n3 1 0 80 0 1.2 2\n4 1 0 100 0 1.2 3\n5 1 10 80 0 0.2 2\n\
                6 1 60 130 0 0.2 5\n";
    let cell = read(text.as_bytes(), Format::Swc);
    let before = Measures::of(&cell.morphology);
    assert!((before.length - 154.9).abs() < 0.05, "{}", before.length);
    for format in [Format::Swc, Format::Asc, Format::H5, Format::NeuroMl] {
        let (after, lost) = copied(&cell, format);
        let is_told = codes(&lost).contains(&"length_changed");
        let is_same = (after.length - before.length).abs() < 0.05;
        assert!(is_same || is_told, "{format:?}: {} {lost:?}", after.length);
    }
    assert!((copied(&cell, Format::H5).0.length - 154.9).abs() < 0.05);
}
