//! Whether 32-bit coordinates hold the surface.

use glam::DVec3;
use neurotess_morphology::Morphology;

use super::skeleton::Skeleton;
use crate::error::{GenerateError, LARGEST};
use crate::warning::Warnings;

/// A rounding below this one (µm), the thickness of a membrane, is never an error: some files have
/// radii of 0.0001 µm for unknown ones.
const MEMBRANE: f64 = 0.01;
/// A rounding by more than this share of the radius is an error: rings become noise. An axon of 0.1 µm
/// at 10 mm from its soma, as in a whole brain, is at 0.005.
const LOST: f64 = 0.1;
/// From this share on it is a warning: of 20 real cells one reaches it, in one point.
const COARSE: f64 = 1e-3;

/// Judges coordinates and radii, after mending.
///
/// # Errors
/// If the surface of some point would be lost in rounding.
pub(crate) fn check(
    morphology: &Morphology,
    skeleton: &Skeleton,
    warnings: &mut Warnings,
) -> Result<(), GenerateError> {
    let nodes = skeleton.nodes().iter();
    let neurites = nodes.map(|node| (node.sample, node.center, node.radius));
    let somata = morphology.somata.iter().map(|soma| {
        let sample = soma.samples.first().map_or(-1, |sample| sample.id);
        (sample, soma.center.as_dvec3(), f64::from(soma.radius))
    });
    let mut coarse = 0;
    for (sample, center, radius) in somata.chain(neurites) {
        coarse += usize::from(check_point(sample, center, radius)?);
    }
    warnings.add_many(
        "coarse_coordinates",
        coarse,
        "point so far from the origin that rounding moves it by more than a thousandth of its radius",
    );
    Ok(())
}

/// Whether rounding shows.
fn check_point(sample: i64, center: DVec3, radius: f64) -> Result<bool, GenerateError> {
    let distance = center.abs().max_element();
    let size = distance.max(radius.abs());
    if size.is_nan() || size > LARGEST {
        return Err(GenerateError::TooLarge { sample, size });
    }
    // Half the step between two numbers of 24 bits.
    let rounding = distance * f64::from(f32::EPSILON) / 2.0;
    if radius > 0.0 && rounding > (LOST * radius).max(MEMBRANE) {
        return Err(GenerateError::Unresolved {
            sample,
            radius,
            distance,
            rounding,
        });
    }
    Ok(radius > 0.0 && rounding > COARSE * radius)
}
