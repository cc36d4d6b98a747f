//! Where a segment begins on its parent.
//!
//! `fractionAlong` names a place on the parent's axis, the end if it is missing, and a segment may have a proximal end
//! of its own besides. Where that is on the axis, the fork is there, whatever the fraction says. Where it is within
//! the parent, as at its surface, the fork is on the axis at the place named, or else beside it. Anywhere else there is
//! a gap, which is no neurite.

use glam::DVec3;
use neurotess_morphology::NeuriteKind;

use crate::sample::Sample;

/// How a segment begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Joint {
    /// On its parent: 0 at the parent's start, 1 at its end.
    Along(f64),
    /// On nothing: it is a root, or apart from its parent.
    None,
}

/// Coordinates are written with a few decimals (µm): what is nearer is the same place.
const ROUNDING: f64 = 1e-3;

/// How a segment begins. `ends`: the parent's; `named`: its fraction; `kinds`: the parent's and its own.
pub(super) fn joint(
    ends: [Sample; 2],
    named: f64,
    proximal: Option<Sample>,
    kinds: [NeuriteKind; 2],
) -> Joint {
    let [start, end] = ends;
    let (Some(proximal), false) = (proximal, kinds.contains(&NeuriteKind::SOMA)) else {
        return Joint::Along(named);
    };
    let distance = |along: f64| proximal_distance(&self::along(&start, &end, along), &proximal);
    let named_distance = distance(named);
    if named_distance <= ROUNDING {
        return Joint::Along(named);
    }
    let beside = beside(&start, &end, proximal.position);
    let beside_distance = distance(beside);
    let reach = |along: f64| {
        let thickness = self::along(&start, &end, along).radius.max(proximal.radius);
        thickness * (1.0 + 1e-3) + ROUNDING
    };
    match () {
        () if beside_distance <= ROUNDING => Joint::Along(beside),
        () if named_distance <= reach(named) => Joint::Along(named),
        () if beside_distance <= reach(beside) => Joint::Along(beside),
        () => Joint::None,
    }
}

/// Whether a neurite begins on a soma.
pub(super) fn leaves_soma(parent: NeuriteKind, own: NeuriteKind) -> bool {
    parent == NeuriteKind::SOMA && own != NeuriteKind::SOMA
}

/// What a frustum is between its ends.
pub(super) fn along(a: &Sample, b: &Sample, along: f64) -> Sample {
    if along == 1.0 {
        return *b;
    }
    Sample {
        position: DVec3::lerp(a.position, b.position, along),
        radius: a.radius + (b.radius - a.radius) * along,
        line: b.line,
    }
}

fn proximal_distance(a: &Sample, b: &Sample) -> f64 {
    a.position.distance(b.position)
}

/// The place on the axis that is nearest to a point; one at an end is the end itself.
fn beside(start: &Sample, end: &Sample, point: DVec3) -> f64 {
    let axis = end.position - start.position;
    let length = axis.length();
    if length <= ROUNDING {
        return 1.0;
    }
    let along = ((point - start.position).dot(axis) / (length * length)).clamp(0.0, 1.0);
    match along {
        along if along * length <= ROUNDING => 0.0,
        along if (1.0 - along) * length <= ROUNDING => 1.0,
        along => along,
    }
}
