//! Spines on dendrites: short twigs with a head, at random places of a given density.
//!
//! ```text
//!        ●        head: a sphere whose far half is the twig's round end
//!        │        neck
//! ──●────●────●── dendrite: the sample in the middle is new
//! ```
//!
//! **Theory.** Sizes are those that K. M. Harris and J. K. Stevens measured in the hippocampus (Dendritic
//! spines of CA1 pyramidal cells in the rat hippocampus, 1989): see `shape.rs`. Places are as far apart as the
//! density says, give or take a half, in directions that are random around the dendrite.
//!
//! **Practice.** A spine is a twig of the tracing, so whatever meshes, draws or measures tracings does the same
//! with spines. The surface at a fork needs room along its branch: bases are at least two radii apart, and as
//! far from forks and somata, so a thick dendrite may carry fewer than were asked for. A spine whose head or neck
//! would touch a neurite, a soma or another spine is turned around its dendrite; after eight tries it is left out.
//! Time grows with the samples, the lengths by the radii, and the spines.

mod room;
mod shape;

use glam::DVec3;

use super::nodes::{Edits, Nodes};
use super::{EditError, positive};
use crate::random::Random;
use crate::{Morphology, NeuriteKind, Node, SectionId};
use room::Room;
use shape::Spine;

/// Type of spines' samples, which is free in SWC files (5 and above).
pub const SPINE: NeuriteKind = NeuriteKind(7);

/// Bases are at least so many radii of the dendrite from one another, forks and somata. In meshes of level 2 of a
/// pyramidal cell with 3,200 to 7,000 spines, 20,600 pairs of triangles crossed at a share of 0.3, 157 at 1, 6 at 2.
const APART: f64 = 2.0;
/// Directions that are tried.
const TRIES: usize = 8;
/// Most spines: some gigabytes.
const MOST: f64 = 1e7;

/// A spine's place on the way from a node's parent to the node.
struct Base {
    center: DVec3,
    radius: f64,
    /// Unit vector away from the dendrite.
    outwards: DVec3,
    spine: Spine,
}

/// Grows spines on dendrites, so many for each µm.
pub(super) fn grow(
    morphology: &Morphology,
    nodes: &Nodes,
    density: f64,
    seed: u64,
) -> Result<Edits, EditError> {
    positive("the density of spines", density)?;
    let dendrites = || {
        let ids = (0..morphology.sections.len() as u32).map(SectionId);
        ids.filter(|id| is_dendrite(morphology.sections[id.index()].kind))
    };
    let lines = dendrites().map(|id| length(nodes, &nodes.of_section(morphology, id)));
    let spines = density * lines.sum::<f64>();
    if spines > MOST {
        return Err(EditError::TooManySpines { density, spines });
    }
    let mut room = Room::new(morphology, nodes);
    // By node: the spines between its parent and itself, in their order.
    let mut bases: Vec<Vec<Base>> = Vec::new();
    bases.resize_with(nodes.nodes.len(), Vec::new);
    let mut left = 0;
    for id in dendrites() {
        // A stream for each section, so that one that is edited leaves the others' spines as they are.
        let mut random = Random::new(seed, u64::from(id.0));
        let line = nodes.of_section(morphology, id);
        left += grow_on(nodes, &line, density, &mut random, &mut room, &mut bases);
    }
    Ok(Edits {
        largest_move: Some(0.0),
        left,
        ..Edits::in_place(with_spines(nodes, &bases))
    })
}

fn is_dendrite(kind: NeuriteKind) -> bool {
    [NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE].contains(&kind)
}

fn length(nodes: &Nodes, line: &[usize]) -> f64 {
    let ways = line.windows(2);
    ways.map(|way| {
        let [from, to] = [way[0], way[1]].map(|i| nodes.nodes[i].position);
        from.distance(to)
    })
    .sum()
}

/// Grows spines along a section. Returns how many there was no room for.
fn grow_on(
    nodes: &Nodes,
    line: &[usize],
    density: f64,
    random: &mut Random,
    room: &mut Room,
    bases: &mut [Vec<Base>],
) -> usize {
    let total = length(nodes, line);
    let mut left = 0;
    // Distances (µm) from the start of the section: of the node before, and of the next base.
    let mut before = 0.0;
    let radius_of = |i: usize| nodes.nodes[i].radius;
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return 0;
    };
    let mut next = (APART * radius_of(first)).max(random.unit() / density);
    let end = total - APART * radius_of(last);
    for way in line.windows(2) {
        let [from, to] = [way[0], way[1]].map(|i| &nodes.nodes[i]);
        let step = from.position.distance(to.position);
        while next < (before + step).min(end) {
            let share = (next - before) / step;
            let radius = from.radius + share * (to.radius - from.radius);
            let base = Base {
                center: from.position.lerp(to.position, share),
                radius,
                outwards: DVec3::ZERO,
                spine: Spine::new(radius, random),
            };
            let axis = (to.position - from.position) / step;
            // As thick as the way is where it is thickest, so that necks begin outside.
            let widest = from.radius.max(to.radius);
            match turned(base, axis, widest, random, room) {
                Some(base) => bases[way[1]].push(base),
                None => left += 1,
            }
            next += ((0.5 + random.unit()) / density).max(APART * radius);
        }
        before += step;
    }
    left
}

/// The spine in a direction in which it touches nothing, if one of a few is.
fn turned(
    mut base: Base,
    axis: DVec3,
    widest: f64,
    random: &mut Random,
    room: &mut Room,
) -> Option<Base> {
    let aside = axis.any_orthonormal_vector();
    let across = axis.cross(aside);
    base.spine.begin_outside(widest);
    for _ in 0..TRIES {
        let angle = std::f64::consts::TAU * random.unit();
        base.outwards = libm::cos(angle) * aside + libm::sin(angle) * across;
        let spheres = base.spine.spheres();
        let there =
            |&(distance, radius): &(f64, f64)| (base.center + distance * base.outwards, radius);
        let spheres: Vec<(DVec3, f64)> = spheres.iter().map(there).collect();
        if spheres
            .iter()
            .all(|&(center, radius)| room.is_free(center, radius))
        {
            for (center, radius) in spheres {
                room.take(center, radius);
            }
            return Some(base);
        }
    }
    None
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
        position: DVec3,
        radius: f64,
        parent: Option<u32>,
    ) -> u32 {
        self.nodes.push(Node {
            id: self.next_id,
            kind,
            position,
            radius,
            parent,
        });
        self.next_id = self.next_id.saturating_add(1);
        self.nodes.len() as u32 - 1
    }
}
