//! MouseLight's neurons and CATMAID's skeletons: shapes, units, somata, faults, and any values at all.

use neurotess_formats::json::{catmaid, mouselight};
use neurotess_formats::{Read, ReadOptions, read_bytes};
use neurotess_morphology::Measures;
use proptest::prelude::*;

fn read(text: &str) -> Read {
    let options = ReadOptions::default();
    let read = read_bytes(text.as_bytes().to_vec(), "cell.json", None, &options);
    read.unwrap_or_else(|e| panic!("{e}"))
}

fn sample(id: i64, kind: i64, [x, y]: [f64; 2], radius: &str, parent: i64) -> String {
    format!(
        "{{\"sampleNumber\": {id}, \"structureIdentifier\": {kind}, \"x\": {x}, \"y\": {y}, \"z\": 100.5, \
         \"radius\": {radius}, \"parentNumber\": {parent}, \"allenId\": null}}"
    )
}

/// An axon of 40 µm with a branch of 30 µm, and a dendrite of 20 µm; both begin with the soma.
fn neuron(id: &str, radius: &str) -> String {
    let axon = [
        sample(1, 1, [0., 0.], radius, -1),
        sample(2, 2, [10., 0.], "1.0", 1),
        sample(3, 5, [30., 0.], "1.0", 2),
        sample(4, 6, [50., 0.], "1.0", 3),
        sample(5, 6, [30., 30.], "1.0", 3),
    ];
    let dendrite = [
        sample(1, 1, [0., 0.], radius, -1),
        sample(2, 3, [0., 10.], "1.0", 1),
        sample(3, 6, [0., 30.], "1.0", 2),
    ];
    format!(
        "{{\"id\": 1, \"idString\": \"{id}\", \"DOI\": \"10.1/x\", \"sample\": {{\"date\": \"2015\"}},\n\
         \"soma\": {{\"x\": 0.0, \"y\": 0.0, \"z\": 100.5, \"allenId\": 1}},\n\
         \"axonId\": \"a\", \"axon\": [\n{}],\n\"dendrite\": [\n{}]}}",
        axon.join(",\n"),
        dendrite.join(",\n"),
    )
}

#[neurotess_testing::test]
fn axon_and_dendrite_of_mouselight_share_the_soma() {
    let one = neuron("AA0001", "6.5");
    for text in [
        format!("{{\"comment\": \"c\", \"neurons\": [{one}]}}"),
        format!("{{\"neuron\": {one}}}"),
        format!("[{one}]"),
        one.clone(),
        one.replace(
            "\"soma\": {\"x\": 0.0, \"y\": 0.0, \"z\": 100.5, \"allenId\": 1}",
            "\"soma\": null",
        ),
    ] {
        let read = read(&text);
        assert_eq!(
            (read.format, &*read.morphology.name),
            ("mouselight", "cell")
        );
        assert_eq!(read.warnings.len(), 0, "{:?}", read.warnings);
        assert_eq!(read.morphology.header, ["AA0001", "10.1/x"]);
        let m = Measures::of(&read.morphology);
        assert_eq!((m.soma.kind, m.soma.radius), ("point", 6.5));
        let by_type = &m.length_by_type;
        assert_eq!((by_type.axon, by_type.basal_dendrite), (70.0, 20.0));
        assert_eq!((m.n_bifurcations, m.n_neurites, m.n_ends), (1, 2, 3));
    }
}

#[neurotess_testing::test]
fn of_several_cells_the_first_is_read() {
    let others = format!(
        "{{\"neurons\": [{},\n{}]}}",
        neuron("A", "1"),
        neuron("B", "1")
    );
    let read = read(&others);
    assert_eq!(read.warnings[0].code, "other_cells_left_out");
    assert_eq!(read.warnings[0].line, Some(13));
    assert_eq!(read.morphology.header[0], "A");
    let missing = self::read(&neuron("A", "null"));
    assert_eq!(missing.warnings[0].code, "soma_zero_radius");
}

#[neurotess_testing::test]
fn one_of_several_cells_is_named_after_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let neurons = folder.path().join("neurons.json");
    let two = format!(
        "{{\"neurons\": [{},\n{}]}}",
        neuron("A", "1"),
        neuron("B", "2")
    );
    std::fs::write(&neurons, two).expect("written");
    let skeletons = folder.path().join("skeletons.json");
    let two = format!(
        "{{\"skeletons\": {{\"7\": {}, \"8\": {}}}}}",
        skeleton(1000.0),
        skeleton(2000.0)
    );
    std::fs::write(&skeletons, two).expect("written");
    let named = |path: &std::path::Path, member: &str| {
        let path = format!("{}#{member}", path.display());
        neurotess_formats::read(path, &ReadOptions::default())
    };
    for (path, member, radius) in [
        (&neurons, "B", 2.0),
        (&neurons, "A", 1.0),
        (&skeletons, "8", 2.0),
    ] {
        let read = named(path, member).expect(member);
        assert_eq!(
            (&*read.morphology.name, read.morphology.somata[0].radius),
            (member, radius)
        );
        assert!(
            read.warnings
                .iter()
                .all(|w| w.code != "other_cells_left_out")
        );
    }
    for (path, first) in [(&neurons, "A"), (&skeletons, "7")] {
        let said = named(path, "C").expect_err("it is not there").to_string();
        let expected = format!(
            "no morphology 'C' is in the file, which has 2: name another one, as in FILE#{first}"
        );
        assert!(said.ends_with(&expected), "{said}");
    }
}

/// A root tagged as the soma and two branches, in nanometers.
fn skeleton(radius: f64) -> String {
    format!(
        "[[[10, null, 3, 0.0, 0.0, 0.0, {radius}, 5],\n[11, 10, 3, 5000.0, 0.0, 0.0, 250.0, 5],\n\
         [13, 12, 3, 25000.0, 9000.0, 0.0, -1, 5, 1400.5, \"edited\"],\n\
         [12, 11, 3, 25000.0, 0.0, 0.0, 250.0, 5],\n[14, 12, 3, 45000.0, 0.0, 0.0, 250.0, 5]],\n\
         [[11, 99, 0, 1.0, 2.0, 3.0]], {{\"soma\": [10], \"ends\": [13]}}]"
    )
}

#[neurotess_testing::test]
fn nanometers_of_catmaid_become_micrometers() {
    for text in [
        skeleton(4000.0),
        format!("{{\"skeletons\": {{\"7\": {}}}}}", skeleton(4000.0)),
    ] {
        let read = read(&text);
        assert_eq!(read.format, "catmaid");
        let m = Measures::of(&read.morphology);
        assert_eq!(
            (m.soma.kind, m.soma.radius, m.soma.center),
            ("point", 4.0, Some([0.0; 3]))
        );
        assert_eq!((m.length, m.n_bifurcations, m.n_points), (49.0, 1, 4));
        let zero = read.warnings.iter().find(|w| w.code == "zero_radius");
        assert_eq!(zero.map(|w| w.count), Some(1));
        assert_eq!(read.morphology.points[0].radius, 0.25);
    }
    // Without a radius the mark is no soma.
    let read = read(&skeleton(-1.0));
    assert!(read.morphology.somata.is_empty());
    assert_eq!(Measures::of(&read.morphology).length, 54.0);
}

#[neurotess_testing::test]
fn faults_name_line_and_remedy() {
    let node = "[1, null, 3, 0, 0, 0, 1, 5]";
    for (text, expected) in [
        (
            format!("[[{node},\n[2, 9, 3, 0, 0, 0, 1, 5]], [], {{}}]"),
            "f.json:2: sample 2 has parent 9",
        ),
        (
            format!("[[{node},\n{node}], [], {{}}]"),
            "f.json:2: sample 1 stands in line 1 already",
        ),
        (
            format!("[[{node},\n[2, 1, 3, \"x\", 0, 0, 1, 5]], [], {{}}]"),
            "f.json:2: x is not a number but",
        ),
        (
            format!("[[{node},\n[2, 1]], [], {{}}]"),
            "f.json:2: x is not a number but \"\"",
        ),
        (
            "[[[1, 2, 3, 0, 0, 0, 1, 5],\n[2, 1, 3, 0, 0, 0, 1, 5]]]".to_owned(),
            "f.json:1: sample 1 is its own ancestor",
        ),
        (
            "[[[1, null, 3, 1e99, 0, 0, 1, 5]]]".to_owned(),
            "f.json:1: x is 1",
        ),
        ("[[]]".to_owned(), "f.json:1: no sample"),
        (
            format!("[[{node},\n"),
            "f.json:2: the JSON is not what it should be",
        ),
        (
            "{\"neurons\": [], \"sampleNumber\": 1}".to_owned(),
            "f.json:1: no sample",
        ),
        (
            "{\"axon\": [{\"sampleNumber\": 1, \"x\": 0,\n\"y\": 0}]}".to_owned(),
            "f.json:2: the JSON is not what it should be (missing field `z`)",
        ),
        (
            format!("{{\"axon\": [\n{}]}}", sample(2, 2, [0., 0.], "1", 7)),
            "f.json:2: sample 2 has parent 7",
        ),
        (
            format!(
                "{{\"axon\": [\n{},\n{}]}}",
                sample(2, 2, [0., 0.], "1", -1),
                sample(2, 2, [0., 0.], "1", -1)
            ),
            "f.json:3: sample 2 stands in line 2 already",
        ),
        ("{\"a\": 1}".to_owned(), "f.json: the JSON is no tracing"),
        (
            "[".repeat(100_000),
            "f.json:1: the JSON is not what it should be",
        ),
    ] {
        let read = read_bytes(
            text.into_bytes(),
            "f.json",
            Some(neurotess_formats::Format::MouseLight),
            &ReadOptions::default(),
        );
        let said = read.expect_err("it is broken").to_string();
        assert!(said.starts_with(expected), "{said}");
        assert!(said.matches(": ").count() >= 2, "what to do: {said}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(200, 1000)))]
    #[neurotess_testing::test]
    fn any_values_are_read_or_refused(
        rows in proptest::collection::vec(
            (0..5_i64, -1..5_i64, -2.0..2.0_f64, 0..7_i64), 0..8),
        cut in 0..400_usize,
    ) {
        let skeleton: Vec<String> = rows.iter()
            .map(|(id, parent, x, kind)| format!("[{id}, {parent}, 1, {x}, 0, 0, {kind}, 5]"))
            .collect();
        let samples: Vec<String> = rows.iter()
            .map(|&(id, parent, x, kind)| sample(id, kind, [x, 0.0], "1", parent))
            .collect();
        let skeleton = format!("[[{}], [], {{\"soma\": [1]}}]", skeleton.join(", "));
        let neuron = format!("{{\"axon\": [{}]}}", samples.join(", "));
        for text in [&skeleton, &neuron] {
            for text in [text, &text[..cut.min(text.len())]] {
                let _ = catmaid::read_bytes(text.as_bytes(), "any.json", &ReadOptions::default());
                let _ = mouselight::read_bytes(text.as_bytes(), "any.json", &ReadOptions::default());
            }
        }
    }
}
