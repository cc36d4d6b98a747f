//! What segments are by their groups and names.

use neurotess_morphology::{Measures, Morphology};

use super::{SPHERE, morphology, segment};

#[neurotess_testing::test]
fn groups_tell_kinds_before_names_and_the_more_special_wins() {
    let ends = |y: f64| [Some([0., y, 0., 1.]), Some([0., y + 1., 0., 1.])];
    let parent = "<parent segment=\"0\" fractionAlong=\"0\"/>";
    let m = morphology(
        &(segment(0, "soma", "", SPHERE)
            + &segment(1, "axon_x", parent, ends(6.0))
            + &segment(2, "x", parent, ends(7.0))
            + &segment(3, "y", parent, ends(8.0))
            + "<segmentGroup id=\"a\" neuroLexId=\"GO:0030425\"><member segment=\"1\"/>\
               <member segment=\"2\"/><include segmentGroup=\"b\"/></segmentGroup>\
               <segmentGroup id=\"b\"><include segmentGroup=\"a\"/></segmentGroup>\
               <segmentGroup id=\"apical_dends\"><member segment=\"2\"/></segmentGroup>"),
    );
    let kinds: Vec<i32> = m.sections.iter().map(|s| s.kind.0).collect();
    assert_eq!(kinds, [3, 4, 0]);
}

/// A soma and a dendrite of two segments along x, with groups.
fn grouped(groups: &str) -> Morphology {
    let beside = |x: f64| [Some([x, 0., 0., 2.]), Some([x + 50., 0., 0., 2.])];
    let soma = [Some([0., 0., 0., 10.]), Some([10., 0., 0., 10.])];
    morphology(
        &(segment(0, "s0", "", soma)
            + &segment(1, "s1", "<parent segment=\"0\"/>", beside(10.0))
            + &segment(2, "s2", "<parent segment=\"1\"/>", beside(60.0))
            + groups),
    )
}

/// A group's element around `inner`.
fn group(id: &str, term: &str, inner: &str) -> String {
    format!("<segmentGroup id=\"{id}\" neuroLexId=\"{term}\">{inner}</segmentGroup>\n")
}

fn member(ids: &[i64]) -> String {
    let member = |id: &i64| format!("<member segment=\"{id}\"/>");
    ids.iter().map(member).collect()
}

#[neurotess_testing::test]
fn the_right_names_come_first_then_the_smaller_group() {
    let all = member(&[0, 1, 2]);
    for (case, groups) in [
        (
            "a name of two kinds says nothing",
            group("soma_group", "GO:0043025", &member(&[0]))
                + &group("dendrite_group", "GO:0030425", &member(&[1, 2]))
                + &group("soma_dends", "", &member(&[0, 1])),
        ),
        (
            "a term on all",
            group("all", "GO:0043025", &all)
                + &group("Soma", "", &member(&[0]))
                + &group("dends", "", &member(&[1, 2])),
        ),
        (
            "a dendrite's term on all",
            group("all", "GO:0030425", &all) + &group("soma_group", "", &member(&[0])),
        ),
        (
            "the right name against a smaller group of another",
            group("dendrite_group", "", &member(&[1, 2]))
                + &group("soma_group", "", &member(&[0]))
                + &group("near_soma", "", &member(&[1])),
        ),
        (
            "what is denied",
            group("no_axon", "", &all)
                + &group("soma_group", "", &member(&[0]))
                + &group("dendrite_group", "", &member(&[1, 2])),
        ),
    ] {
        let measures = Measures::of(&grouped(&groups));
        let area = measures.soma.area;
        assert!((area - 314.159).abs() < 0.01, "{case}: {area}");
        assert_eq!(measures.length_by_type.basal_dendrite, 100.0, "{case}");
    }
}

#[neurotess_testing::test]
fn names_of_segments_tell_more_than_a_group_of_all() {
    let ends = |x: f64| [Some([x, 0., 0., 2.]), Some([x + 10., 0., 0., 2.])];
    let parent = "<parent segment=\"0\"/>";
    let cell = |second: &str| {
        let m = morphology(
            &(segment(0, "Soma", "", ends(0.0))
                + &segment(1, second, parent, ends(10.0))
                + &group("all", "GO:0043025", &member(&[0, 1]))),
        );
        Measures::of(&m)
    };
    assert_eq!(cell("Dend_1").length_by_type.basal_dendrite, 10.0);
    // Where nothing else tells, the group does.
    assert_eq!(
        (cell("x").length, cell("x").soma.area),
        (0.0, 2.0 * cell("Dend_1").soma.area)
    );
}

#[neurotess_testing::test]
fn apical_dendrites_are_told_within_the_group_of_dendrites() {
    let m = grouped(
        &(group("soma_group", "", &member(&[0]))
            + &group("dendrite_group", "GO:0030425", &member(&[1, 2]))
            + &group("apic_2", "", &member(&[2]))),
    );
    let by_type = Measures::of(&m).length_by_type;
    assert_eq!(
        (by_type.basal_dendrite, by_type.apical_dendrite),
        (50.0, 50.0)
    );
}

#[neurotess_testing::test]
fn paths_subtrees_and_included_groups_have_segments() {
    let span = |name: &str, inner: &str| format!("<{name}>{inner}</{name}>");
    let (from, to) = ("<from segment=\"1\"/>", "<to segment=\"2\"/>");
    for inner in [
        span("path", &format!("{from}{to}")),
        span("path", "<from segment=\"2\"/><to segment=\"1\"/>"),
        span("subTree", from),
        "<include segmentGroup=\"inner\"/>".to_owned(),
    ] {
        let m = grouped(
            &(group(
                "inner",
                "",
                &format!(
                    "{}<include segmentGroup=\"axon_group\"/>",
                    span("subTree", from)
                ),
            ) + &group("axon_group", "", &inner)
                + &group("soma_group", "", &member(&[0]))),
        );
        assert_eq!(Measures::of(&m).length_by_type.axon, 100.0, "{inner}");
    }
    let up = span("path", "<to segment=\"1\"/>");
    let m = grouped(&(group("axon_group", "", &up) + &group("soma_group", "", &member(&[0]))));
    assert_eq!(Measures::of(&m).length_by_type.axon, 50.0);
}
