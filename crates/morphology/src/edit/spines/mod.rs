//! Spines on dendrites: short twigs with a head, at random places of a given density or where they are known to be.
//!
//! ```text
//!        ●        head: a sphere whose far half is the twig's round end
//!        │        neck
//! ──●────●────●── dendrite: the sample in the middle is new
//! ```
//!
//! **Theory.** Sizes are those that K. M. Harris and J. K. Stevens measured in the hippocampus (Dendritic
//! spines of CA1 pyramidal cells in the rat hippocampus, 1989): see `shape.rs`. Of a density (`density.rs`), places are
//! as far apart as it says, give or take a half, in directions that are random around the dendrite. A given place
//! (`given.rs`), as that of a synapse, is on the nearest neurite, in the direction in which it lies.
//!
//! **Practice.** A spine is a twig of the tracing, so whatever meshes, draws or measures tracings does the same
//! with spines. The surface at a fork needs room along its branch: bases are at least two radii apart, and as
//! far from forks and somata, so a thick dendrite may carry fewer than were asked for. A spine whose head or neck
//! would touch a neurite, a soma or another spine is turned around its dendrite; after eight tries it is left out.
//! Time grows with the samples, the lengths by the radii, and the spines.

mod base;
mod density;
mod given;
mod line;
mod room;
mod shape;

use super::nodes::{Edits, Nodes};
use super::{EditError, SpinePlaces};
use crate::{Morphology, NeuriteKind, Node};
use base::Base;
pub use given::SPINE_REACH;
use room::Room;

/// Type of spines' samples, which is free in SWC files (5 and above).
pub const SPINE: NeuriteKind = NeuriteKind(7);

/// Most spines: some gigabytes.
const MOST: f64 = 1e7;

/// Spines that have a place, and those that have none.
struct Grown {
    /// By node: the spines between its parent and itself, in their order.
    bases: Vec<Vec<Base>>,
    room: Room,
    /// How many there was no room for.
    left: usize,
}

/// Grows spines on dendrites.
pub(super) fn grow(
    morphology: &Morphology,
    nodes: &Nodes,
    places: &SpinePlaces,
    seed: u64,
) -> Result<Edits, EditError> {
    let mut grown = Grown {
        bases: Vec::new(),
        room: Room::new(morphology, nodes),
        left: 0,
    };
    grown.bases.resize_with(nodes.nodes.len(), Vec::new);
    match places {
        SpinePlaces::Density(density) => {
            density::grow(morphology, nodes, *density, seed, &mut grown)?;
        }
        SpinePlaces::File => given::grow_at(morphology, nodes, &nodes.spines, seed, &mut grown)?,
        SpinePlaces::At(places) => given::grow_at(morphology, nodes, places, seed, &mut grown)?,
        SpinePlaces::Along(shares) => {
            given::grow_along(morphology, nodes, shares, seed, &mut grown)?;
        }
    }
    Ok(Edits {
        largest_move: Some(0.0),
        left: grown.left,
        spines: (*places == SpinePlaces::File).then(Vec::new),
        ..Edits::in_place(with_spines(nodes, &grown.bases))
    })
}

/// The nodes with a new one for each base, on which the spine's hang.
fn with_spines(nodes: &Nodes, bases: &[Vec<Base>]) -> Vec<Node> {
    let highest = nodes.nodes.iter().map(|node| node.id).max().unwrap_or(0);
    let mut made = Made {
        nodes: Vec::with_capacity(nodes.nodes.len()),
        next_id: highest.saturating_add(1),
    };
    // Samples of somata may stand before their parents: none of them moves.
    let mut new: Vec<u32> = (0..nodes.somata as u32).collect();
    made.nodes.extend_from_slice(&nodes.nodes[..nodes.somata]);
    for (node, bases) in nodes.nodes.iter().zip(bases).skip(nodes.somata) {
        let mut parent = node.parent.map(|p| new[p as usize]);
        for base in bases {
            let fork = made.push(node.kind, base.center, base.radius, parent);
            made.nodes[fork as usize].section = node.section;
            parent = Some(fork);
            let mut above = fork;
            for &(distance, radius) in base.spine.samples() {
                let center = base.center + distance * base.outwards;
                above = made.push(SPINE, center, radius, Some(above));
            }
        }
        new.push(made.nodes.len() as u32);
        made.nodes.push(Node { parent, ..*node });
    }
    made.nodes
}

struct Made {
    nodes: Vec<Node>,
    /// Number of the next new sample: those that were traced keep theirs.
    next_id: i64,
}

impl Made {
    fn push(
        &mut self,
        kind: NeuriteKind,
        position: glam::DVec3,
        radius: f64,
        parent: Option<u32>,
    ) -> u32 {
        self.nodes.push(Node {
            id: self.next_id,
            kind,
            position,
            radius,
            parent,
            section: None,
        });
        self.next_id = self.next_id.saturating_add(1);
        self.nodes.len() as u32 - 1
    }
}
