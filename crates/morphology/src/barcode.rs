//! Persistence barcode of a tree: the topological morphology descriptor of Kanari et al., A Topological
//! Representation of Branching Neuronal Morphologies, 2018, with the radial distance.
//!
//! Every end begins a bar. At a fork, the bar that comes from farthest away goes on, and the others stop there; the
//! last one stops at the neurite's first point. So there are as many bars as ends.

use glam::DVec3;

use crate::{Morphology, SectionId, shape};

/// One bar: a path from an end to where it stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// The section at whose last point it begins.
    pub end: SectionId,
    /// The section at whose last point it stops; `None` for the neurite's first point.
    pub fork: Option<SectionId>,
    /// Distance (µm) of the end from the center.
    pub end_distance: f64,
    /// Distance (µm) from the center of where it stops.
    pub fork_distance: f64,
}

/// The bars of all neurites by their ends, in the order of the sections. Distances are measured from `center`, in
/// the file's coordinates (µm). Of bars that come from equally far, that of the first child goes on.
pub fn barcode(morphology: &Morphology, center: DVec3) -> Vec<Bar> {
    let distances = shape::end_distances(morphology, center);
    // Of each section the end whose bar passes through it.
    let mut passing: Vec<Option<usize>> = vec![None; distances.len()];
    let mut bars = Vec::new();
    for (index, section) in morphology.sections.iter().enumerate().rev() {
        let own = passing[index].unwrap_or(index);
        let mut stop = |end: usize, fork: Option<SectionId>, fork_distance: f64| {
            bars.push(Bar {
                end: SectionId(end as u32),
                fork,
                end_distance: distances[end],
                fork_distance,
            });
        };
        let Some(parent) = section.parent() else {
            let first = morphology.points[section.first as usize].position;
            let first = morphology.origin + first.as_dvec3();
            stop(own, None, first.distance(center));
            continue;
        };
        match &mut passing[parent.index()] {
            Some(other) => {
                // Children come from the last to the first.
                let stays = if distances[own] >= distances[*other] {
                    std::mem::replace(other, own)
                } else {
                    own
                };
                stop(stays, Some(parent), distances[parent.index()]);
            }
            none => *none = Some(own),
        }
    }
    bars.sort_by_key(|bar| bar.end);
    bars
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NeuriteKind, Node};

    #[test]
    fn the_farthest_end_goes_on() {
        let row = |id: i64, x: f64, y: f64, parent: Option<u32>| Node {
            id,
            kind: NeuriteKind::AXON,
            position: DVec3::new(x, y, 0.0),
            radius: 1.0,
            parent,
            section: None,
        };
        // A fork at 10 with ends at 30 and, by way of a fork at 20, at 25 and 40.
        let nodes = [
            row(1, 0.0, 0.0, None),
            row(2, 10.0, 0.0, Some(0)),
            row(3, 30.0, 0.0, Some(1)),
            row(4, 0.0, 20.0, Some(1)),
            row(5, 0.0, 25.0, Some(3)),
            row(6, 0.0, 40.0, Some(3)),
        ];
        let cell = Morphology::from_nodes("cell", Vec::new(), &nodes)
            .expect("built")
            .morphology;
        let bars = barcode(&cell, DVec3::ZERO);
        let lengths: Vec<[f64; 2]> = bars
            .iter()
            .map(|b| [b.end_distance, b.fork_distance])
            .collect();
        assert_eq!(lengths, [[30.0, 10.0], [25.0, 20.0], [40.0, 0.0]]);
        assert_eq!(bars[2].fork, None);
        assert_eq!(barcode(&Morphology::default(), DVec3::ZERO), []);
    }
}
