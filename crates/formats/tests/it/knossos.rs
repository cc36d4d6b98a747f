//! webKnossos and KNOSSOS: told from NeuroML, voxels, edges without direction, names, faults, and any elements at all.

use neurotess_formats::{Format, Read, ReadOptions, knossos, read_bytes};
use neurotess_morphology::Measures;
use proptest::prelude::*;

fn file(parameters: &str, things: &str, comments: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- a comment -->\n<things>\n<parameters>\n\
         <experiment name=\"e\"/>\n{parameters}\n</parameters>\n{things}\
         <branchpoints><branchpoint id=\"2\"/></branchpoints>\n\
         <comments>{comments}</comments>\n</things>\n"
    )
}

fn thing(id: i64, name: &str, nodes: &[(i64, [f64; 3], &str)], edges: &[(i64, i64)]) -> String {
    let node = |&(id, [x, y, z], more): &(i64, [f64; 3], &str)| {
        format!("<node id=\"{id}\" x=\"{x}\" y=\"{y}\" z=\"{z}\" {more} inVp=\"0\" time=\"1\"/>\n")
    };
    let edge = |&(a, b): &(i64, i64)| format!("<edge source=\"{a}\" target=\"{b}\"/>\n");
    let nodes: String = nodes.iter().map(node).collect();
    let edges: String = edges.iter().map(edge).collect();
    format!(
        "<thing id=\"{id}\" name=\"{name}\" color.r=\"1\">\n<nodes>{nodes}</nodes>\n<edges>{edges}</edges>\n</thing>\n"
    )
}

const SCALE: &str = "<scale x=\"10\" y=\"10\" z=\"25\"/>";

/// A fork in the middle of three edges, whose directions say nothing.
fn forked() -> String {
    let nodes = [
        (1, [0., 0., 0.], "radius=\"200\""),
        (2, [1000., 0., 0.], "radius=\"100\""),
        (3, [2000., 0., 0.], "radius=\"100\""),
        (4, [1000., 0., 400.], "radius=\"100\""),
    ];
    thing(1, "axon of cell 3", &nodes, &[(2, 1), (3, 2), (2, 4)])
}

fn read(text: &str) -> Read {
    let options = ReadOptions::default();
    // The name's ending is that of NeuroML: the content tells.
    let read = read_bytes(
        text.as_bytes().to_vec(),
        "cell.nml",
        Some(Format::NeuroMl),
        &options,
    );
    read.expect("it is sound")
}

#[neurotess_testing::test]
fn voxels_become_micrometers_and_edges_get_a_direction() {
    let read = read(&file(SCALE, &forked(), ""));
    assert_eq!((read.format, &*read.morphology.name), ("knossos", "cell"));
    assert_eq!(read.warnings.len(), 1, "{:?}", read.warnings);
    assert_eq!(read.warnings[0].code, "no_soma");
    let m = Measures::of(&read.morphology);
    assert_eq!(m.length_by_type.axon, 30.0);
    assert_eq!((m.n_bifurcations, m.n_neurites, m.n_points), (1, 1, 4));
    let radii: Vec<f32> = read.morphology.points.iter().map(|p| p.radius).collect();
    assert_eq!(radii, [0.2, 0.1, 0.1, 0.1]);
}

#[neurotess_testing::test]
fn units_are_named_and_desktop_files_have_radii_in_voxels() {
    let micrometers = "<scale x=\"0.01\" y=\"0.01\" z=\"0.025\" unit=\"micrometer\"/>";
    let small = forked()
        .replace("\"200\"", "\"0.2\"")
        .replace("\"100\"", "\"0.1\"");
    let desktop = format!("{SCALE}<createdin version=\"5.1\"/><lastsavedin version=\"5.1\"/>");
    let voxels = forked()
        .replace("\"200\"", "\"20\"")
        .replace("\"100\"", "\"10\"");
    for text in [file(micrometers, &small, ""), file(&desktop, &voxels, "")] {
        let read = read(&text);
        let m = Measures::of(&read.morphology);
        assert!((m.length - 30.0).abs() < 1e-5, "{}", m.length);
        assert!((read.morphology.points[0].radius - 0.2).abs() < 1e-6);
    }
    let without = read(&file("", &forked(), ""));
    assert_eq!(without.warnings[0].code, "unknown_unit");
}

#[neurotess_testing::test]
fn things_are_trees_of_one_cell_and_a_comment_names_the_soma() {
    let soma = thing(
        1,
        "cell 3",
        &[
            (1, [0., 0., 0.], "radius=\"5000\""),
            (2, [600., 0., 0.], ""),
        ],
        &[(1, 2)],
    );
    let dendrite = thing(
        2,
        "dendrite",
        &[
            (3, [0., 900., 0.], ""),
            (4, [0., 990., 0.], "radius=\"-1\""),
        ],
        &[(3, 4)],
    );
    let read = read(&file(
        SCALE,
        &(soma + &dendrite),
        "<comment node=\"1\" content=\"Soma\"/>",
    ));
    let m = Measures::of(&read.morphology);
    assert_eq!(
        (m.soma.kind, m.soma.radius, m.n_neurites),
        ("point", 5.0, 2)
    );
    assert!((m.length_by_type.basal_dendrite - 0.9).abs() < 1e-6);
    let count = |code: &str| {
        read.warnings
            .iter()
            .find(|w| w.code == code)
            .map(|w| w.count)
    };
    assert_eq!(
        (count("disconnected"), count("zero_radius")),
        (Some(1), Some(3))
    );
}

#[neurotess_testing::test]
fn an_edge_that_closes_a_loop_is_left_out() {
    let looped = forked().replace("<edges>", "<edges>\n<edge source=\"4\" target=\"3\"/>\n");
    let read = read(&file(SCALE, &looped, ""));
    let left_out = read.warnings.iter().find(|w| w.code == "loops_left_out");
    assert_eq!(left_out.map(|w| w.count), Some(1));
    assert_eq!(Measures::of(&read.morphology).n_points, 4);
}

#[neurotess_testing::test]
fn faults_name_line_and_remedy() {
    let node = (1, [0., 0., 0.], "");
    for (text, expected) in [
        (file(SCALE, "", ""), "f.nml:1: the <things> has no <node>"),
        (
            file(SCALE, &thing(1, "a", &[node], &[(1, 7)]), ""),
            "f.nml:11: an edge names node 7, which is not in the file",
        ),
        (
            file(SCALE, &thing(1, "a", &[node, node], &[]), ""),
            "f.nml:10: sample 1 stands in line 9 already",
        ),
        (
            file(
                "<scale x=\"1\" y=\"1\" z=\"1\" unit=\"ell\"/>",
                &forked(),
                "",
            ),
            "f.nml:6: <scale> has unit=\"ell\"",
        ),
        (
            file("<scale x=\"1\" y=\"1\"/>", &forked(), ""),
            "f.nml:6: <scale> has z=\"\"",
        ),
        (
            file(SCALE, &forked(), "").replace("</nodes>", "</node>"),
            "f.nml:13: the XML is broken",
        ),
    ] {
        let read = knossos::read_bytes(text.as_bytes(), "f.nml", &ReadOptions::default());
        let said = read.expect_err("it is broken").to_string();
        assert!(said.starts_with(expected), "{said}");
        assert!(said.matches(": ").count() >= 2, "what to do: {said}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(200, 1000)))]
    #[neurotess_testing::test]
    fn any_elements_are_read_or_refused(
        parts in proptest::collection::vec(
            prop_oneof![
                Just("<nodes>".to_owned()), Just("</nodes>".to_owned()), Just("&x; <".to_owned()),
                Just("<edges>".to_owned()), Just("</edges>".to_owned()), Just("<thing name=\"soma\">".to_owned()),
                Just("<comments><comment node=\"1\" content=\"soma\"/></comments>".to_owned()),
                (0..6_i64, 0..3).prop_map(|(i, x)| format!("<node id=\"{i}\" x=\"{x}\" y=\"0\" z=\"0\" radius=\"1\"/>")),
                (0..6_i64, 0..6_i64).prop_map(|(a, b)| format!("<edge source=\"{a}\" target=\"{b}\"/>")),
            ],
            0..30,
        ),
    ) {
        let text = format!("<things>{}", parts.concat());
        let _ = knossos::read_bytes(text.as_bytes(), "any.nml", &ReadOptions::default());
    }
}
