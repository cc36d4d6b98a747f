//! SNT's traces: packed or not, forks, fitted paths, units, faults, and any elements at all.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use neurotess_formats::{Read, ReadOptions, read_bytes, traces};
use neurotess_morphology::{Measures, Morphology};
use proptest::prelude::*;

/// A file with its document type, whose declarations have brackets.
fn file(spacing: &str, paths: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE tracings [\n\
         <!ELEMENT tracings (samplespacing,imagesize,path*,fill*)>\n\
         <!ATTLIST point x CDATA #REQUIRED>\n]>\n<!-- a comment -->\n\
         <tracings>\n<samplespacing {spacing}/>\n\
         <imagesize width=\"9\" height=\"9\" depth=\"9\"/>\n{paths}\
         <fill id=\"0\"><node id=\"0\" x=\"1\" y=\"1\" z=\"1\" status=\"open\"/></fill>\n</tracings>\n"
    )
}

const MICRONS: &str = "x=\"0.5\" y=\"0.5\" z=\"2.0\" units=\"\u{b5}m\"";

fn point([x, y, z]: [f64; 3], radius: &str) -> String {
    let voxels = format!("x=\"{}\" y=\"{}\" z=\"{}\"", x * 2.0, y * 2.0, z / 2.0);
    format!("<point {voxels} xd=\"{x}\" yd=\"{y}\" zd=\"{z}\" {radius}/>\n")
}

fn path(attributes: &str, points: &[[f64; 3]], radius: &str) -> String {
    let points: String = points.iter().map(|&at| point(at, radius)).collect();
    format!("<path {attributes}>\n{points}</path>\n")
}

/// A soma, an axon of 40 µm, a branch of 30 µm at its middle.
fn branched() -> String {
    path("id=\"0\" swctype=\"1\"", &[[0., 0., 0.]], "r=\"5\"")
        + &path(
            "id=\"1\" swctype=\"2\" startson=\"0\" startsx=\"0\" startsy=\"0\" startsz=\"0\"",
            &[[5., 0., 0.], [25., 0., 0.], [45., 0., 0.]],
            "r=\"1\"",
        )
        + &path(
            "id=\"2\" swctype=\"2\" startson=\"1\" startsx=\"25.01\" startsy=\"0\" startsz=\"0\" \
             reallength=\"30.0\"",
            &[[25., 0., 0.], [25., 30., 0.]],
            "r=\"0.5\"",
        )
}

fn read(text: &str) -> Read {
    read_bytes(
        text.as_bytes().to_vec(),
        "cell.traces",
        None,
        &ReadOptions::default(),
    )
    .expect("it is sound")
}

fn morphology(paths: &str) -> Morphology {
    read(&file(MICRONS, paths)).morphology
}

#[neurotess_testing::test]
fn paths_hang_on_one_another() {
    let read = read(&file(MICRONS, &branched()));
    assert_eq!((read.format, &*read.morphology.name), ("traces", "cell"));
    assert_eq!(read.warnings, []);
    let m = Measures::of(&read.morphology);
    assert_eq!((m.length, m.length_by_type.axon), (70.0, 70.0));
    assert_eq!((m.n_bifurcations, m.n_neurites, m.n_points), (1, 1, 4));
    assert_eq!((m.soma.kind, m.soma.radius), ("point", 5.0));
}

#[neurotess_testing::test]
fn packed_files_are_read() {
    let mut packing = GzEncoder::new(Vec::new(), Compression::default());
    let text = file(MICRONS, &branched());
    packing.write_all(text.as_bytes()).expect("memory takes it");
    let packed = packing.finish().expect("memory takes it");
    let read = read_bytes(packed, "cell.traces", None, &ReadOptions::default());
    assert_eq!(Measures::of(&read.expect("read").morphology).length, 70.0);
}

#[neurotess_testing::test]
fn units_and_voxels_become_micrometers() {
    let nanometers = read(&file("x=\"1\" y=\"1\" z=\"1\" units=\"nm\"", &branched()));
    let m = Measures::of(&nanometers.morphology);
    assert!((m.length - 0.07).abs() < 1e-6, "{}", m.length);
    assert!((m.soma.radius - 0.005).abs() < 1e-9);
    let pixels = read(&file(
        "x=\"1\" y=\"1\" z=\"1\" units=\"pixel\"",
        &branched(),
    ));
    assert_eq!(pixels.warnings[0].code, "unknown_unit");
    let voxels = "<path id=\"0\"><point x=\"0\" y=\"0\" z=\"0\" r=\"1\"/>\
                  <point x=\"0\" y=\"0\" z=\"10\" r=\"1\"/></path>";
    assert_eq!(Measures::of(&morphology(voxels)).length, 20.0);
}

#[neurotess_testing::test]
fn a_fitted_path_is_read_where_its_source_says_so() {
    let source = |uses: bool| format!("id=\"0\" swctype=\"3\" fitted=\"7\" usefitted=\"{uses}\"");
    let drawn = [[0., 0., 0.], [10., 0., 0.]];
    let fitted = path(
        "id=\"7\" fittedversionof=\"0\" usefitted=\"false\"",
        &[[0., 1., 0.], [20., 1., 0.]],
        "r=\"2\"",
    );
    let branch = path(
        "id=\"3\" startson=\"0\" startsx=\"20\" startsy=\"1\" startsz=\"0\"",
        &[[20., 1., 0.], [20., 6., 0.]],
        "r=\"2\"",
    );
    for (uses, length, zeros) in [(true, 25.0, 0), (false, 15.0 + 101.0_f64.sqrt(), 2)] {
        let paths = path(&source(uses), &drawn, "") + &fitted + &branch;
        let read = read(&file(MICRONS, &paths));
        let m = Measures::of(&read.morphology);
        assert_eq!(m.n_neurites, 1);
        assert!((m.length - length).abs() < 1e-5, "{uses}: {}", m.length);
        let zero = read.warnings.iter().find(|w| w.code == "zero_radius");
        assert_eq!(zero.map_or(0, |w| w.count), zeros, "{uses}");
    }
}

#[neurotess_testing::test]
fn several_trees_are_one_cell_and_a_path_may_end_on_its_parent() {
    let tree = |id: i64, y: f64| {
        path(
            &format!("id=\"{id}\" swctype=\"3\""),
            &[[0., y, 0.], [10., y, 0.]],
            "r=\"1\"",
        )
    };
    let read = read(&file(MICRONS, &(tree(0, 0.0) + &tree(1, 50.0))));
    assert_eq!(Measures::of(&read.morphology).n_neurites, 2);
    assert!(read.warnings.iter().any(|w| w.code == "disconnected"));
    for place in [
        "startsx=\"10\" startsy=\"0\" startsz=\"0\"",
        "startx=\"10\" starty=\"0\" startz=\"0\"",
        "startsindex=\"1\"",
    ] {
        let starts = path(
            &format!("id=\"5\" startson=\"0\" {place}"),
            &[[10., 0., 0.], [10., 20., 0.]],
            "r=\"1\"",
        );
        let m = Measures::of(&morphology(&(tree(0, 0.0) + &starts)));
        assert_eq!((m.n_neurites, m.length), (1, 30.0), "{place}");
    }
    let ends = path(
        "id=\"5\" endson=\"0\" endsx=\"10\" endsy=\"0\" endsz=\"0\"",
        &[[10., 20., 0.], [10., 0., 0.]],
        "r=\"1\"",
    );
    let m = Measures::of(&morphology(&(tree(0, 0.0) + &ends)));
    assert_eq!((m.n_neurites, m.length), (1, 30.0));
}

#[neurotess_testing::test]
fn faults_name_line_and_remedy() {
    let text = |paths: &str| format!("<tracings>\n{paths}</tracings>");
    let points = "<point xd=\"0\" yd=\"0\" zd=\"0\"/>";
    for (file, expected) in [
        (text(""), "f.traces:1: the <tracings> has no <path>"),
        (text("<path id=\"x\">"), "f.traces:2: <path> has id=\"x\""),
        (
            text(&format!("<path id=\"1\">{points}</path>\n<path id=\"1\"/>")),
            "f.traces:3: path 1 stands in line 2 already",
        ),
        (
            text(&format!("<path id=\"1\" startson=\"9\">{points}</path>")),
            "f.traces:2: path 1 starts on path 9, which is not in the file",
        ),
        (
            text(&format!(
                "<path id=\"1\" startson=\"2\">{points}</path>\n<path id=\"2\" startson=\"1\">{points}</path>"
            )),
            "f.traces:2: the point is its own ancestor",
        ),
        (
            text("<path id=\"1\">\n<point xd=\"0\" yd=\"1e99\" zd=\"0\"/></path>"),
            "f.traces:3: <point> has yd=\"1e99\"",
        ),
        (text("<path id=\"1\">"), "f.traces:2: the XML is broken"),
        (String::new(), "f.traces:1: the file is empty"),
    ] {
        let read = traces::read_bytes(file.as_bytes(), "f.traces", &ReadOptions::default());
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
                Just("</path>".to_owned()), Just("<fill>".to_owned()), Just("&x; <".to_owned()),
                Just("<samplespacing x=\"2\" units=\"mm\"/>".to_owned()),
                (0..4_i64).prop_map(|i| format!("<path id=\"{i}\">")),
                (0..4_i64, 0..4_i64).prop_map(|(i, p)| format!("<path id=\"{i}\" startson=\"{p}\" startsindex=\"1\">")),
                (0..4_i64, 0..4_i64).prop_map(|(i, p)| format!("<path id=\"{i}\" endson=\"{p}\">")),
                (0..4_i64, 0..4_i64).prop_map(|(i, p)| format!(
                    "<path id=\"{i}\" fitted=\"{p}\" usefitted=\"true\">")),
                (0..4_i64, 0..4_i64).prop_map(|(i, p)| format!("<path id=\"{i}\" fittedversionof=\"{p}\">")),
                (0..3, 0..3).prop_map(|(x, r)| format!("<point xd=\"{x}\" yd=\"0\" zd=\"0\" r=\"{r}\"/>")),
                (0..3).prop_map(|x| format!("<point x=\"{x}\" y=\"0\" z=\"0\"/>")),
            ],
            0..30,
        ),
    ) {
        let text = format!("<tracings>{}", parts.concat());
        let _ = traces::read_bytes(text.as_bytes(), "any.traces", &ReadOptions::default());
    }
}
