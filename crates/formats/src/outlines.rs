//! The outlines that somata become in formats which know no others.

use glam::Vec3;
use neurotess_morphology::{Morphology, Soma, SomaKind};

/// Corners of the outline that stands for a sphere.
const CORNERS: usize = 32;

/// Positions (relative to the origin) and radii of all somata's outlines.
pub(crate) fn outlines(morphology: &Morphology) -> Vec<Vec<(Vec3, f32)>> {
    morphology.somata.iter().flat_map(soma_outlines).collect()
}

fn soma_outlines(soma: &Soma) -> Vec<Vec<(Vec3, f32)>> {
    if soma.kind != SomaKind::Contour {
        return vec![circle(soma)];
    }
    let mut outlines: Vec<Vec<(Vec3, f32)>> = Vec::new();
    for (i, sample) in (0_u32..).zip(&soma.samples) {
        let follows = i > 0 && sample.parent == Some(i - 1);
        if !follows {
            outlines.push(Vec::new());
        }
        if let Some(outline) = outlines.last_mut() {
            outline.push((sample.position, sample.radius));
        }
    }
    // Samples of no thickness that hang together in another way are one outline.
    if outlines.iter().all(|outline| outline.len() < 3) {
        return vec![outlines.concat()];
    }
    outlines
}

/// A polygon in the xy-plane of the same area as the sphere's great circle.
fn circle(soma: &Soma) -> Vec<(Vec3, f32)> {
    use std::f64::consts::TAU;
    let corners = CORNERS as f64;
    let stretch = (TAU / (corners * (TAU / corners).sin())).sqrt();
    let reach = f64::from(soma.radius.max(0.0)) * stretch;
    (0..CORNERS)
        .map(|i| {
            let (sin, cos) = (i as f64 * TAU / corners).sin_cos();
            let corner = glam::DVec3::new(cos, sin, 0.0) * reach;
            (soma.center + corner.as_vec3(), 0.0)
        })
        .collect()
}
