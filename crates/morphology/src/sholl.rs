//! Sholl analysis: how often neurites cross spheres around the soma (Sholl, Dendritic Organization in the Neurons
//! of the Visual and Motor Cortices of the Cat, 1953).

use std::ops::Range;

use glam::DVec3;
use thiserror::Error;

use crate::{Morphology, SectionId, shape};

/// Most spheres.
const MOST: f64 = 1e6;

/// The spheres are too many.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("spheres {step} µm apart are {count:.0} around this cell: take a larger distance")]
pub struct TooManySpheres {
    /// Distance of the spheres (µm).
    pub step: f64,
    /// How many there would be.
    pub count: f64,
}

/// What radial distances are measured from, in the file's coordinates (µm): the main soma's center, or the first
/// neurite's first point; `None` without either.
pub fn center(morphology: &Morphology) -> Option<DVec3> {
    let soma = morphology.soma().map(|soma| soma.center);
    let root = || morphology.points.first().map(|point| point.position);
    let center = soma.or_else(root)?;
    Some(morphology.origin + center.as_dvec3())
}

/// How many links between consecutive points of a section cross or touch the spheres of radius `step`, 2 `step`, …
/// (µm, above 0) around [`center`], up to the farthest point of these sections. The way from a soma to a neurite
/// is no link. As in NeuroM, a point on a sphere counts with both its links.
///
/// # Errors
/// [`TooManySpheres`].
///
/// # Panics
/// If `step` is not above 0, or a section is not of this morphology.
pub fn crossings(
    morphology: &Morphology,
    step: f64,
    sections: Range<u32>,
) -> Result<Vec<u64>, TooManySpheres> {
    assert!(step > 0.0, "spheres are some distance apart");
    let Some(center) = center(morphology) else {
        return Ok(Vec::new());
    };
    let center = center - morphology.origin;
    let distance = |p: &crate::Point| p.position.as_dvec3().distance(center);
    let ids = || sections.clone().map(SectionId);
    let points = ids().flat_map(|id| morphology.section_points(id));
    let farthest = points.map(distance).fold(0.0, f64::max);
    let count = (farthest / step).floor();
    if count > MOST {
        return Err(TooManySpheres { step, count });
    }
    // Where links begin to cross, and where they no longer do.
    let mut changes = vec![0_i64; count as usize + 2];
    for id in ids() {
        for (a, b) in shape::links(morphology, id) {
            let (a, b) = (distance(a), distance(b));
            let first = (a.min(b) / step).ceil().max(1.0) as usize;
            let last = (a.max(b) / step).floor() as usize;
            if first <= last {
                changes[first] += 1;
                if let Some(change) = changes.get_mut(last + 1) {
                    *change -= 1;
                }
            }
        }
    }
    let running = changes[1..=count as usize].iter().scan(0, |sum, change| {
        *sum += change;
        Some(*sum as u64)
    });
    Ok(running.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NeuriteKind, Node};

    fn cell(rows: &[(f64, Option<u32>)]) -> Morphology {
        let node = |(i, &(x, parent)): (usize, &(f64, Option<u32>))| Node {
            id: i as i64 + 1,
            kind: NeuriteKind::AXON,
            position: DVec3::new(x, 0.0, 0.0),
            radius: 1.0,
            parent,
            section: None,
        };
        let nodes: Vec<Node> = rows.iter().enumerate().map(node).collect();
        Morphology::from_nodes("axon", Vec::new(), &nodes)
            .expect("built")
            .morphology
    }

    #[test]
    fn links_cross_spheres_and_points_on_them_count_twice() {
        let cell = cell(&[
            (0.0, None),
            (10.0, Some(0)),
            (25.0, Some(1)),
            (7.0, Some(1)),
        ]);
        // At 5: one link. At 10: three links meet. At 15, 20, 25: one.
        assert_eq!(crossings(&cell, 5.0, 0..3), Ok(vec![1, 3, 1, 1, 1]));
        assert_eq!(crossings(&cell, 30.0, 0..3), Ok(vec![]));
        assert!(crossings(&cell, 1e-9, 0..3).is_err());
        assert_eq!(crossings(&Morphology::default(), 5.0, 0..0), Ok(vec![]));
    }
}
