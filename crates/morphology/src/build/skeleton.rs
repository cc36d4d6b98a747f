//! What is odd in skeletons of electron microscopy, which have no soma.

use super::Node;
use super::notes::{Notes, Oddity};
use crate::NeuriteKind;

/// Fewer samples are no skeleton, but something that was made by hand.
const FEW: usize = 50;
/// How many times as thick as the next one a sample is that stands for a soma. Skeletons that were made with somata have
/// 4 and more, dendrites where they are widest below 2.
const THICK: f64 = 3.0;

pub(super) fn note(nodes: &[Node], notes: &mut Notes) {
    let Some(first) = nodes.first().filter(|_| nodes.len() >= FEW) else {
        return;
    };
    let is_round = (first.radius * 1000.0).fract() == 0.0;
    if first.radius > 0.0 && is_round && nodes.iter().all(|node| node.radius == first.radius) {
        notes.add_many(Oddity::EqualRadii, 0, nodes.len() as u64);
        return;
    }
    if nodes.iter().any(|node| node.kind != NeuriteKind::UNDEFINED) {
        return;
    }
    let (mut thickest, mut next) = (0, 0.0);
    for (i, node) in nodes.iter().enumerate().skip(1) {
        if node.radius > nodes[thickest].radius {
            next = nodes[thickest].radius;
            thickest = i;
        } else if node.radius > next {
            next = node.radius;
        }
    }
    if nodes[thickest].radius >= THICK * next {
        notes.add(Oddity::ThickSample, thickest as u32);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::Morphology;

    fn codes(radius: impl Fn(u32) -> f64, kind: NeuriteKind) -> Vec<&'static str> {
        let node = |i: u32| Node {
            id: i64::from(i) + 1,
            kind,
            position: DVec3::new(f64::from(i), 0.0, 0.0),
            radius: radius(i),
            parent: i.checked_sub(1),
            section: None,
        };
        let nodes: Vec<Node> = (0..60).map(node).collect();
        let built = Morphology::from_nodes("skeleton", Vec::new(), &nodes).expect("built");
        built.notes.iter().map(|note| note.oddity.code()).collect()
    }

    #[test]
    fn radii_that_were_never_measured_and_somata_without_a_type_are_noted() {
        let (none, axon) = (NeuriteKind::UNDEFINED, NeuriteKind::AXON);
        assert_eq!(codes(|_| 1.0, none), ["no_soma", "equal_radii"]);
        assert_eq!(codes(|_| 0.1, axon), ["no_soma", "equal_radii"]);
        assert_eq!(codes(|_| 0.123_456, none), ["no_soma"]);
        let soma = |i| {
            if i == 7 {
                5.0
            } else {
                0.2 + f64::from(i) * 0.01
            }
        };
        assert_eq!(codes(soma, none), ["no_soma", "thick_sample"]);
        assert_eq!(codes(soma, axon), ["no_soma"]);
        assert_eq!(codes(|i| 0.2 + f64::from(i) * 0.01, none), ["no_soma"]);
    }
}
