//! How many stems there are, what each may spend, and which way it starts.

use glam::DVec3;

use crate::spec::Tree;
use neurotess_morphology::random::Random;

/// Directions tried for a stem; the one farthest from the other stems is taken.
const TRIES: u32 = 24;
/// A stem of fewer points would be a stub.
const MIN_POINTS: usize = 8;

/// Number of stems of a tree with `points` in all; `size` is 1 in a cell of the usual size.
pub(crate) fn count(tree: &Tree, points: usize, size: f64, random: &mut Random) -> usize {
    let (least, most) = tree.stems;
    if most == 1 {
        return 1;
    }
    let usual = random
        .between((f64::from(least), f64::from(most) + 1.0))
        .floor();
    let scaled = (usual * libm::pow(size, 0.1)).round() as usize;
    scaled.min(points / MIN_POINTS).max(1)
}

/// Shares points so that none is lost: each gets the part that its weight asks for.
pub(crate) fn shared(points: usize, weights: &[f64]) -> Vec<usize> {
    let whole: f64 = weights.iter().sum();
    let (mut so_far, mut given) = (0.0, 0);
    let part = |weight: &f64| {
        so_far += weight;
        let up_to = (so_far / whole * points as f64).round() as usize;
        let part = up_to - given;
        given = up_to;
        part
    };
    weights.iter().map(part).collect()
}

/// A direction within the tree's aim, far from those taken.
pub(crate) fn direction(tree: &Tree, taken: &[DVec3], random: &mut Random) -> DVec3 {
    let mut best = (f64::INFINITY, tree.aim.0);
    for _ in 0..TRIES {
        let tried = within(tree, random);
        let nearest = taken.iter().map(|t| t.dot(tried)).fold(-1.0, f64::max);
        if nearest < best.0 {
            best = (nearest, tried);
        }
    }
    best.1
}

/// A random direction, at most the aim's angle from its middle.
fn within(tree: &Tree, random: &mut Random) -> DVec3 {
    let (middle, least_cosine) = tree.aim;
    let along = random.between((least_cosine, 1.0));
    let angle = std::f64::consts::TAU * random.unit();
    let across = (1.0 - along * along).max(0.0).sqrt();
    let (u, v) = middle.any_orthonormal_pair();
    let mut direction = middle * along + (u * libm::cos(angle) + v * libm::sin(angle)) * across;
    if tree.flat {
        direction.z *= 0.1;
    }
    direction.normalize_or(middle)
}
