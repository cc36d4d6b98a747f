//! Comparison and barcodes of any tracing, beside slower ways to the same.

use glam::DVec3;
use neurotess_morphology::barcode::barcode;
use neurotess_morphology::edit::{Edit, apply};
use neurotess_morphology::{
    Difference, MatchedBy, Morphology, NeuriteKind, Node, SectionId, shape,
};
use proptest::prelude::*;

/// A tree of neurites' samples on a coarse grid, so that places and distances repeat.
fn any_tree() -> impl Strategy<Value = Morphology> {
    let row = (2..4_i32, prop::array::uniform3(-9..9_i32), 0..9_u32);
    prop::collection::vec(row, 1..60).prop_map(|rows| {
        let node = |(i, (kind, place, back)): (usize, &(i32, [i32; 3], u32))| Node {
            id: 3 * i as i64 + 1,
            kind: NeuriteKind(*kind),
            position: DVec3::from_array(place.map(f64::from)),
            radius: 1.0,
            parent: (i > 0).then(|| (i as u32 - 1).saturating_sub(*back)),
            section: None,
        };
        let nodes: Vec<Node> = rows.iter().enumerate().map(node).collect();
        let built = Morphology::from_nodes("tree", Vec::new(), &nodes);
        built.expect("parents stand before").morphology
    })
}

/// The algorithm as it is published: parents are processed once all their children are, and take over the value of
/// the farthest one.
fn published(m: &Morphology, center: DVec3) -> Vec<[f64; 2]> {
    let f = shape::end_distances(m, center);
    let children = |section: Option<usize>| -> Vec<usize> {
        let parent = |i: &usize| m.sections[*i].parent().map(SectionId::index) == section;
        (0..f.len()).filter(parent).collect()
    };
    let mut value: Vec<Option<f64>> = (0..f.len())
        .map(|i| children(Some(i)).is_empty().then_some(f[i]))
        .collect();
    let mut bars = Vec::new();
    while let Some(ready) = (0..f.len())
        .find(|&i| value[i].is_none() && children(Some(i)).iter().all(|&c| value[c].is_some()))
    {
        let mut values: Vec<f64> = children(Some(ready))
            .iter()
            .filter_map(|&c| value[c])
            .collect();
        values.sort_by(f64::total_cmp);
        value[ready] = values.pop();
        bars.extend(values.into_iter().map(|v| [v, f[ready]]));
    }
    for root in children(None) {
        let first = m.points[m.sections[root].first as usize]
            .position
            .as_dvec3()
            + m.origin;
        bars.extend(value[root].map(|v| [v, first.distance(center)]));
    }
    bars.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    bars
}

proptest! {
    #[neurotess_testing::test]
    fn bars_are_those_of_the_published_algorithm(m in any_tree(), center in prop::array::uniform3(-9..9_i32)) {
        let center = DVec3::from_array(center.map(f64::from));
        let bars = barcode(&m, center);
        let ends = shape::child_counts(&m).into_iter().filter(|&n| n == 0).count();
        prop_assert_eq!(bars.len(), ends);
        let mut lengths: Vec<[f64; 2]> = bars.iter().map(|b| [b.end_distance, b.fork_distance]).collect();
        lengths.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        prop_assert_eq!(lengths, published(&m, center));
    }

    #[neurotess_testing::test]
    fn a_tracing_is_the_same_as_itself_and_as_itself_renumbered(m in any_tree()) {
        prop_assert!(Difference::of(&m, &m, 0.0).same);
        let mut renumbered = m.clone();
        renumbered.sample_ids.iter_mut().for_each(|id| *id += 7);
        let difference = Difference::of(&m, &renumbered, 0.0);
        prop_assert!(difference.same && difference.matched_by == MatchedBy::Order);
    }

    #[neurotess_testing::test]
    fn what_is_cut_off_is_only_in_the_first(m in any_tree(), pick in any::<prop::sample::Index>()) {
        let sample = *pick.get(&m.sample_ids);
        let part = apply(&m, &[Edit::Subtree { sample }]).expect("there").morphology;
        let there = Difference::of(&m, &part, 0.0);
        let back = Difference::of(&part, &m, 0.0);
        let cut = m.points.len() - part.points.len();
        prop_assert_eq!((there.only_in_first.count, there.only_in_second.count), (cut, 0));
        prop_assert_eq!((back.only_in_first.count, back.only_in_second.count), (0, cut));
        prop_assert_eq!(there.same, cut == 0 && there.parents.count == 0);
    }
}
