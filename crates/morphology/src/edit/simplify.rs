//! Samples that a tube does not need are left out: Douglas and Peucker, Algorithms for the Reduction of the
//! Number of Points Required to Represent a Digitized Line or its Caricature, 1973, in three dimensions and
//! with radii.
//!
//! A sample may go if its ball is near enough to the frustum that replaces it: the distance of its center from
//! the axis and the difference of its radius from the frustum's there are together no more than the tolerance.
//! That is as far as the membrane can move.
//!
//! The method takes the square of a section's samples at worst. So sections are done in pieces of a few
//! thousand samples, whose ends stay.

use super::nodes::{Edits, Nodes};
use super::resample::from_segment;
use super::{EditError, positive};
use crate::{Morphology, Node, SectionId};

/// Samples of a piece.
const PIECE: usize = 4096;

pub(super) fn simplify(
    morphology: &Morphology,
    nodes: &Nodes,
    tolerance: f64,
) -> Result<Edits, EditError> {
    positive("the tolerance", tolerance)?;
    let mut kept = vec![false; nodes.nodes.len()];
    kept[..nodes.somata].fill(true);
    let mut largest_move = 0.0_f64;
    for id in (0..morphology.sections.len() as u32).map(SectionId) {
        let line = nodes.of_section(morphology, id);
        // The start of a piece is the end of the one before.
        for start in (0..line.len()).step_by(PIECE - 1) {
            let piece = &line[start..line.len().min(start + PIECE)];
            let moved = reduce(&nodes.nodes, piece, tolerance, &mut kept);
            largest_move = largest_move.max(moved);
        }
    }
    Ok(Edits {
        largest_move: Some(largest_move),
        ..Edits::in_place(without_gaps(&nodes.nodes, &kept))
    })
}

/// Marks the nodes of a line that are kept. Returns the greatest distance of a center that goes.
fn reduce(nodes: &[Node], line: &[usize], tolerance: f64, kept: &mut [bool]) -> f64 {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return 0.0;
    };
    kept[first] = true;
    kept[last] = true;
    let mut largest_move = 0.0_f64;
    let mut stack = vec![(0, line.len() - 1)];
    while let Some((from, to)) = stack.pop() {
        let mut worst = (tolerance, None);
        let mut moved = 0.0_f64;
        for i in from + 1..to {
            let (distance, error) = error(nodes, [line[from], line[i], line[to]]);
            moved = moved.max(distance);
            if error > worst.0 {
                worst = (error, Some(i));
            }
        }
        match worst.1 {
            Some(i) => {
                kept[line[i]] = true;
                stack.extend([(from, i), (i, to)]);
            }
            None => largest_move = largest_move.max(moved),
        }
    }
    largest_move
}

/// Distance (µm) of the middle node from the axis between the others, and with the difference of the radii.
fn error(nodes: &[Node], [from, middle, to]: [usize; 3]) -> (f64, f64) {
    let [from, middle, to] = [from, middle, to].map(|i| &nodes[i]);
    let (distance, share) = from_segment(middle.position, from.position, to.position);
    let radius = from.radius + share * (to.radius - from.radius);
    (distance, distance + (middle.radius - radius).abs())
}

/// The nodes that are kept, each on the nearest one above it that is.
fn without_gaps(nodes: &[Node], kept: &[bool]) -> Vec<Node> {
    // Samples of somata, which may stand before their parents, are all kept and so keep their numbers.
    let mut number: Vec<Option<u32>> = Vec::with_capacity(nodes.len());
    let mut left: Vec<Node> = Vec::new();
    for (node, &kept) in nodes.iter().zip(kept) {
        let above = |p: u32| number.get(p as usize).copied().unwrap_or(Some(p));
        let parent = node.parent.and_then(above);
        if kept {
            number.push(Some(left.len() as u32));
            left.push(Node { parent, ..*node });
        } else {
            number.push(parent);
        }
    }
    left
}
