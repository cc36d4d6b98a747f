//! The samples of the soma, the first ones of the cell.

use glam::DVec3;
use neurotess_morphology::{NeuriteKind, Node};

use crate::spec::Spec;
use neurotess_morphology::random::Random;

/// One sample, or NeuroMorpho.Org's three, around the origin.
pub(crate) fn samples(spec: &Spec, random: &mut Random) -> Vec<Node> {
    // Hundredths, so that the three samples are exact in their file.
    let radius = (random.between(spec.soma_radius) * 100.0).round() / 100.0;
    let sample = |id, y, parent| Node {
        id,
        kind: NeuriteKind::SOMA,
        position: DVec3::new(0.0, y, 0.0),
        radius,
        parent,
        section: None,
    };
    let mut samples = vec![sample(1, 0.0, None)];
    if spec.three_point {
        samples.extend([sample(2, -radius, Some(0)), sample(3, radius, Some(0))]);
    }
    samples
}
