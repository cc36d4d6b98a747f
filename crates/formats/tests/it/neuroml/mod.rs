//! NeuroML: shapes, kinds, faults, and any elements at all.

mod groups;
mod written;

use neurotess_formats::{ReadOptions, neuroml};
use neurotess_morphology::{Measures, Morphology, SomaKind};
use proptest::prelude::*;

fn cell(inner: &str) -> String {
    format!(
        "<neuroml>\n<cell id=\"c\"><morphology id=\"m\">\n{inner}</morphology></cell></neuroml>"
    )
}

fn morphology(inner: &str) -> Morphology {
    let read = neuroml::read_bytes(cell(inner).as_bytes(), "c.nml", &ReadOptions::default());
    read.expect("it is sound").morphology
}

fn fault(inner: &str) -> String {
    let read = neuroml::read_bytes(cell(inner).as_bytes(), "c.nml", &ReadOptions::default());
    read.expect_err("it is broken").to_string()
}

fn segment(id: i64, name: &str, parent: &str, ends: [Option<[f64; 4]>; 2]) -> String {
    let end = |(name, end): (&str, Option<[f64; 4]>)| {
        end.map_or(String::new(), |[x, y, z, d]| {
            format!("<{name} x=\"{x}\" y=\"{y}\" z=\"{z}\" diameter=\"{d}\"/>")
        })
    };
    let [proximal, distal] = ends;
    format!(
        "<segment id=\"{id}\" name=\"{name}\">{parent}{}{}</segment>\n",
        end(("proximal", proximal)),
        end(("distal", distal)),
    )
}

const SPHERE: [Option<[f64; 4]>; 2] = [Some([0., 0., 0., 10.]), Some([0., 0., 0., 10.])];

#[neurotess_testing::test]
fn a_root_without_length_is_a_sphere() {
    let m = morphology(
        &(segment(0, "soma", "", SPHERE)
            + &segment(
                1,
                "dend",
                "<parent segment=\"0\"/>",
                [Some([0., 5., 0., 2.]), Some([0., 25., 0., 1.])],
            )),
    );
    let soma = m.soma().expect("a soma");
    assert_eq!((soma.kind, soma.radius), (SomaKind::Point, 5.0));
    let measures = Measures::of(&m);
    assert_eq!((measures.n_points, measures.length), (2, 20.0));
    assert_eq!(m.sections[0].kind.0, 3);
}

#[neurotess_testing::test]
fn a_child_half_way_cuts_its_parent_without_changing_it() {
    let straight = segment(
        0,
        "axon",
        "",
        [Some([0., 0., 0., 4.]), Some([8., 0., 0., 2.])],
    );
    let branch = segment(
        7,
        "axon",
        "<parent segment=\"0\" fractionAlong=\"0.25\"/>",
        [None, Some([2., 9., 0., 3.5])],
    );
    let (alone, both) = (morphology(&straight), morphology(&(straight + &branch)));
    let (alone, both) = (Measures::of(&alone), Measures::of(&both));
    assert_eq!((both.n_bifurcations, both.n_sections), (1, 3));
    let branch = std::f64::consts::PI * 1.75 * 1.75 * 9.0;
    assert!((both.volume - alone.volume - branch).abs() < 1e-4);
    assert!((both.length - 17.0).abs() < 1e-6);
}

#[neurotess_testing::test]
fn faults_name_line_and_remedy() {
    let line = segment(0, "a", "", [Some([0., 0., 0., 1.]), Some([1., 0., 0., 1.])]);
    for (inner, expected) in [
        (
            segment(0, "a", "", [None, Some([1., 0., 0., 1.])]),
            "c.nml:3: segment 0 has no <proximal>",
        ),
        (
            segment(0, "a", "", [Some([1., 0., 0., 1.]), None]),
            "c.nml:3: segment 0 has no <distal>",
        ),
        (
            line.clone() + &line,
            "c.nml:4: segment 0 stands in line 3 already",
        ),
        (
            line.clone() + &segment(1, "a", "<parent segment=\"9\"/>", [None, Some([1.; 4])]),
            "c.nml:4: segment 1 has parent 9, which is not in the cell",
        ),
        (
            segment(5, "a", "<parent segment=\"5\"/>", [None, Some([1.; 4])]),
            "c.nml:3: the point is its own ancestor",
        ),
        (
            line.replace("y=\"0\"", "y=\"nan\""),
            "c.nml:3: <proximal> has y=\"nan\"",
        ),
        (
            line.replace("</segment>", "</egment>"),
            "c.nml:3: the XML is broken",
        ),
        (
            String::new(),
            "c.nml:1: no <morphology> or <segments> with a <segment>",
        ),
    ] {
        let said = fault(&inner);
        assert!(said.starts_with(expected), "{said}");
        assert!(said.matches(": ").count() >= 2, "what to do: {said}");
    }
}

#[neurotess_testing::test]
fn only_ends_directly_in_a_segment_are_places() {
    let m = morphology(
        &(segment(0, "soma", "", SPHERE)
            + &segment(
                1,
                "dend",
                "<parent segment=\"0\"/><properties><proximal translationStart=\"1\"/></properties>",
                [Some([0., 5., 0., 2.]), Some([0., 25., 0., 1.])],
            )
            + "<segmentGroup id=\"dendrite_group\"><member segment=\"1\"/>\
               <inhomogeneousParameter id=\"p\" variable=\"p\" metric=\"Path Length from root\">\
               <proximal translationStart=\"0\"/><distal normalizationEnd=\"1\"/>\
               </inhomogeneousParameter></segmentGroup>"),
    );
    assert_eq!(Measures::of(&m).length, 20.0);
    assert_eq!(m.soma().map(|soma| soma.radius), Some(5.0));
}

/// A straight axon from (0, 0, 0) to (50, 0, 0), radius 1, and what hangs on it.
fn forked(parent: &str, ends: [Option<[f64; 4]>; 2]) -> Measures {
    let straight = [Some([0., 0., 0., 2.]), Some([50., 0., 0., 2.])];
    Measures::of(&morphology(
        &(segment(0, "axon", "", straight) + &segment(1, "axon", parent, ends)),
    ))
}

#[neurotess_testing::test]
fn the_way_to_a_segment_that_begins_elsewhere_is_no_neurite() {
    let parent = "<parent segment=\"0\"/>";
    let apart = forked(parent, [Some([50., 20., 0., 1.]), Some([50., 50., 0., 1.])]);
    assert_eq!((apart.length, apart.n_neurites), (80.0, 2));
    let half = "<parent segment=\"0\" fractionAlong=\"0.5\"/>";
    let apart = forked(half, [Some([25., 20., 0., 1.]), Some([25., 50., 0., 1.])]);
    assert_eq!((apart.length, apart.n_bifurcations), (80.0, 0));
    let file = cell(
        &(segment(
            0,
            "axon",
            "",
            [Some([0., 0., 0., 2.]), Some([50., 0., 0., 2.])],
        ) + &segment(
            1,
            "axon",
            parent,
            [Some([50., 20., 0., 1.]), Some([50., 50., 0., 1.])],
        )),
    );
    let read = neuroml::read_bytes(file.as_bytes(), "c.nml", &ReadOptions::default());
    let warnings = read.expect("read").warnings;
    let gap = warnings
        .iter()
        .find(|w| w.code == "gap")
        .expect("a warning");
    assert_eq!((gap.line, gap.count), (Some(4), 1));
}

#[neurotess_testing::test]
fn a_segment_that_begins_on_its_parent_forks_there() {
    // The fraction is missing, is wrong, or is right.
    for parent in [
        "<parent segment=\"0\"/>",
        "<parent segment=\"0\" fractionAlong=\"0.9\"/>",
        "<parent segment=\"0\" fractionAlong=\"0.5\"/>",
    ] {
        for diameter in [2.0, 1.0] {
            let fork = forked(
                parent,
                [Some([25., 0., 0., diameter]), Some([25., 30., 0., 1.])],
            );
            assert_eq!((fork.length, fork.n_bifurcations), (80.0, 1), "{parent}");
            assert_eq!((fork.n_neurites, fork.n_ends), (1, 2), "{parent}");
        }
    }
    // At the surface: attached, the way out of the parent is within it.
    let half = "<parent segment=\"0\" fractionAlong=\"0.5\"/>";
    let spine = forked(half, [Some([25., 1., 0., 1.]), Some([25., 31., 0., 1.])]);
    assert_eq!((spine.n_neurites, spine.n_bifurcations), (1, 1));
    assert_eq!(spine.length, 81.0);
}

/// A soma, a dendrite, and an axon that begins half way along it, as NeuroML 1 has them.
fn version_1(units: &str) -> String {
    let end = |name: &str, x: f64, y: f64, d: f64| {
        format!("<mml:{name} x=\"{x}\" y=\"{y}\" z=\"0\" diameter=\"{d}\"/>")
    };
    let segment = |id: i64, more: &str, ends: &[String]| {
        format!(
            "<mml:segment id=\"{id}\" name=\"s{id}\" {more}>{}</mml:segment>\n",
            ends.concat()
        )
    };
    let group = |name: &str| format!("<meta:group>{name}</meta:group>");
    [
        format!("<neuroml xmlns=\"http://morphml.org/neuroml/schema\" {units}>\n"),
        "<cells><cell name=\"c\">\n<mml:segments>\n".to_owned(),
        segment(
            0,
            "cable=\"0\"",
            &[end("proximal", 0., 0., 10.), end("distal", 10., 0., 10.)],
        ),
        segment(
            1,
            "parent=\"0\" cable=\"1\"",
            &[end("proximal", 10., 0., 2.), end("distal", 50., 0., 2.)],
        ),
        segment(2, "parent=\"1\" cable=\"1\"", &[end("distal", 90., 0., 2.)]),
        segment(
            3,
            "parent=\"1\" cable=\"2\"",
            &[end("distal", 30., 30., 2.)],
        ),
        "</mml:segments>\n<mml:cables>".to_owned(),
        format!(
            "<mml:cable id=\"0\" name=\"a\">{}</mml:cable>",
            group("soma_group")
        ),
        format!(
            "<mml:cable id=\"1\" name=\"b\">{}{}</mml:cable>",
            group("all"),
            group("dendrite_group")
        ),
        "<mml:cable id=\"2\" name=\"c\" fract_along_parent=\"0.5\"></mml:cable>\
         <mml:cablegroup name=\"axon_group\"><mml:cable id=\"2\"/></mml:cablegroup>\
         </mml:cables>\n</cell></cells></neuroml>\n"
            .to_owned(),
    ]
    .concat()
}

#[neurotess_testing::test]
fn neuroml_1_has_cables_with_groups_and_fractions() {
    for (units, scale) in [
        ("", 1.0),
        ("length_units=\"micrometer\"", 1.0),
        ("length_units=\"micron\"", 1.0),
        ("lengthUnits=\"mm\"", 1000.0),
    ] {
        let file = version_1(units);
        let read = neuroml::read_bytes(file.as_bytes(), "c.nml", &ReadOptions::default());
        let m = Measures::of(&read.expect(units).morphology);
        let by_type = &m.length_by_type;
        assert_eq!(
            (by_type.axon, by_type.basal_dendrite),
            (30.0 * scale, 80.0 * scale)
        );
        assert_eq!((m.n_bifurcations, m.n_neurites, m.n_ends), (1, 1, 2));
        assert!(
            (m.soma.area / scale / scale - 314.159).abs() < 0.01,
            "{}",
            m.soma.area
        );
    }
    let file = version_1("length_units=\"parsec\"");
    let read = neuroml::read_bytes(file.as_bytes(), "c.nml", &ReadOptions::default());
    let said = read.expect_err("no unit of cells").to_string();
    assert!(said.starts_with("c.nml:1: \"parsec\" is no unit"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(300, 1500)))]
    #[neurotess_testing::test]
    fn any_elements_are_read_or_refused(
        parts in proptest::collection::vec(
            prop_oneof![
                Just("<morphology>".to_owned()), Just("</morphology>".to_owned()),
                Just("</segment>".to_owned()), Just("<notes>x</notes>".to_owned()),
                Just("<segmentGroup id=\"soma\">".to_owned()), Just("</segmentGroup>".to_owned()),
                Just("<include segmentGroup=\"soma\"/>".to_owned()), Just("&x; <".to_owned()),
                Just("<segments>".to_owned()), Just("<cables>".to_owned()),
                (0..3_i64).prop_map(|i| format!("<cable id=\"{i}\"><group>axon</group></cable>")),
                (0..6_i64, 0..6_i64).prop_map(|(i, p)| format!(
                    "<segment id=\"{i}\" parent=\"{p}\" cable=\"0\">")),
                Just("<path>".to_owned()), Just("</path>".to_owned()),
                Just("<subTree>".to_owned()), Just("</subTree>".to_owned()),
                (0..6_i64).prop_map(|i| format!("<from segment=\"{i}\"/>")),
                (0..6_i64).prop_map(|i| format!("<to segment=\"{i}\"/>")),
                (0..6_i64).prop_map(|i| format!("<segment id=\"{i}\" name=\"soma\">")),
                (0..6_i64, 0..3).prop_map(|(i, f)| format!(
                    "<parent segment=\"{i}\" fractionAlong=\"{}\"/>", f64::from(f) / 2.0)),
                (0..3, 0..3).prop_map(|(x, d)| format!(
                    "<proximal x=\"{x}\" y=\"0\" z=\"0\" diameter=\"{d}\"/>")),
                (0..3, 0..3).prop_map(|(x, d)| format!(
                    "<distal x=\"{x}\" y=\"0\" z=\"0\" diameter=\"{d}\"/>")),
                (0..6_i64).prop_map(|i| format!("<member segment=\"{i}\"/>")),
            ],
            0..40,
        ),
    ) {
        let text = format!("<neuroml><morphology>{}", parts.concat());
        let _ = neuroml::read_bytes(text.as_bytes(), "any.nml", &ReadOptions::default());
    }
}
