//! Neurolucida XML: outlines, nested branches, types, what is left out, faults, depth, and any elements at all.

use neurotess_formats::{Read, ReadOptions, neurolucida_xml, read_bytes};
use neurotess_morphology::{Measures, SomaKind};
use proptest::prelude::*;

fn file(inner: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n\
         <mbf version=\"4.0\" xmlns=\"http://www.mbfbioscience.com/2007/neurolucida\" appname=\"Neurolucida\">\n\
         <description><![CDATA[text <point/>]]></description>\n\
         <images><image><scale x=\"0.5\" y=\"0.5\"/><coord x=\"0\" y=\"0\" z=\"0\"/></image></images>\n{inner}</mbf>\n"
    )
}

fn points(points: &[[f64; 3]]) -> String {
    let point = |&[x, y, d]: &[f64; 3]| {
        format!("<point x=\"{x}\" y=\"{y}\" z=\"0\" d=\"{d}\" sid=\"S1\"/>\n")
    };
    points.iter().map(point).collect()
}

fn soma(name: &str) -> String {
    let corners = [[-5., -5., 0.], [5., -5., 0.], [5., 5., 0.], [-5., 5., 0.]];
    format!(
        "<contour name=\"{name}\" color=\"#FF0000\" closed=\"true\" shape=\"Contour\">\n\
         <property name=\"GUID\"><s></s></property>\n{}</contour>\n",
        points(&corners)
    )
}

/// A stem of 20 µm with two branches of 10 and 30 µm.
fn tree(named: &str, more: &str) -> String {
    format!(
        "<tree color=\"#FF\" type=\"{named}\" leaf=\"Normal\">\n{}{more}<branch leaf=\"Normal\">{}</branch>\n\
         <branch>{}</branch>\n</tree>\n",
        points(&[[5., 0., 2.], [25., 0., 2.]]),
        points(&[[25., 0., 2.], [25., 10., 1.]]),
        points(&[[25., -30., 1.]]),
    )
}

fn read(text: &str) -> Read {
    let options = ReadOptions::default();
    let read = read_bytes(text.as_bytes().to_vec(), "cell.xml", None, &options);
    read.expect("it is sound")
}

#[neurotess_testing::test]
fn trees_hang_on_the_soma_and_types_have_kinds() {
    for name in ["CellBody", "Cell Body", "Soma"] {
        for (named, kind) in [
            ("Axon", 2),
            ("Dendrite", 3),
            ("Apical Dendrite", 4),
            ("Apical", 4),
        ] {
            let read = read(&file(&(soma(name) + &tree(named, ""))));
            assert_eq!(
                (read.format, &*read.morphology.name),
                ("neurolucida_xml", "cell")
            );
            assert_eq!(read.warnings.len(), 0, "{:?}", read.warnings);
            let m = Measures::of(&read.morphology);
            assert_eq!((m.length, m.n_bifurcations, m.n_neurites), (60.0, 1, 1));
            assert!(
                read.morphology.sections.iter().all(|s| s.kind.0 == kind),
                "{named}"
            );
            let soma = read.morphology.soma().expect("a soma");
            assert_eq!(soma.kind, SomaKind::Contour);
            assert!((soma.radius - (100.0 / std::f32::consts::PI).sqrt()).abs() < 1e-4);
            assert_eq!(read.morphology.points[0].radius, 1.0);
            assert_eq!(read.morphology.header, ["text <point/>"]);
        }
    }
}

#[neurotess_testing::test]
fn what_is_left_out_is_counted() {
    let marker = format!(
        "<marker type=\"Dot\" name=\"m\">{}</marker>\n",
        points(&[[9., 9., 1.]])
    );
    let spine = format!(
        "<spine>{}</spine>\n",
        points(&[[20., 0., 1.], [20., 2., 1.]])
    );
    let pia = soma("pia");
    let text = file(&(pia + &tree("Axon", &(marker.clone() + &spine)) + &tree("", "") + &marker));
    let read = read(&text);
    let count = |code: &str| {
        read.warnings
            .iter()
            .find(|w| w.code == code)
            .map(|w| w.count)
    };
    assert_eq!(count("contours_left_out"), Some(1));
    assert_eq!(count("markers_left_out"), Some(2));
    assert_eq!(
        (count("spines_left_out"), read.morphology.spines.len()),
        (Some(1), 1)
    );
    assert_eq!(
        (count("untyped_tree"), count("disconnected")),
        (Some(1), Some(2))
    );
    assert_eq!(Measures::of(&read.morphology).length, 120.0);
}

#[neurotess_testing::test]
fn faults_name_line_and_remedy() {
    for (text, expected) in [
        (file(""), "f.xml:1: the <mbf> has no <tree>"),
        (
            file("<tree>\n<point x=\"0\" y=\"zero\" z=\"0\" d=\"1\"/></tree>"),
            "f.xml:6: <point> has y=\"zero\"",
        ),
        (file("<tree>"), "f.xml:5: the XML is broken"),
    ] {
        let read = neurolucida_xml::read_bytes(text.as_bytes(), "f.xml", &ReadOptions::default());
        let said = read.expect_err("it is broken").to_string();
        assert!(said.starts_with(expected), "{said}");
        assert!(said.matches(": ").count() >= 2, "what to do: {said}");
    }
}

#[neurotess_testing::test]
fn nesting_of_any_depth_is_read() {
    let depth = 20_000;
    let open: String = (0..depth)
        .map(|i| format!("<branch><point x=\"{i}\" y=\"0\" z=\"0\" d=\"1\"/>"))
        .collect();
    let text = file(&format!(
        "<tree type=\"Axon\">{open}{}</tree>",
        "</branch>".repeat(depth)
    ));
    assert_eq!(Measures::of(&read(&text).morphology).length, 19_999.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(200, 1000)))]
    #[neurotess_testing::test]
    fn any_elements_are_read_or_refused(
        parts in proptest::collection::vec(
            prop_oneof![
                Just("<tree type=\"Axon\">".to_owned()), Just("</tree>".to_owned()), Just("<branch>".to_owned()),
                Just("</branch>".to_owned()), Just("<contour name=\"CellBody\">".to_owned()),
                Just("</contour>".to_owned()), Just("<spine>".to_owned()), Just("</spine>".to_owned()),
                Just("<marker>".to_owned()), Just("</marker>".to_owned()), Just("&x; <".to_owned()),
                (0..3, 0..3).prop_map(|(x, d)| format!("<point x=\"{x}\" y=\"0\" z=\"0\" d=\"{d}\"/>")),
            ],
            0..30,
        ),
    ) {
        let text = format!("<mbf>{}", parts.concat());
        let _ = neurolucida_xml::read_bytes(text.as_bytes(), "any.xml", &ReadOptions::default());
    }
}
