//! What takes up the room around a dendrite.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

use crate::Morphology;
use crate::edit::nodes::Nodes;

/// Side of a cell of the grid (µm): about a spine.
const CELL: f64 = 2.0;
/// Gap (µm) that is kept free around things.
pub(super) const GAP: f64 = 0.05;

/// Spheres in a grid, each in all cells that it reaches. Asked for one cell at a time, so the order of the map
/// does not matter.
#[derive(Default)]
pub(super) struct Room {
    cells: HashMap<IVec3, Vec<(DVec3, f64)>>,
}

impl Room {
    /// The neurites and somata of a tracing.
    pub(super) fn new(morphology: &Morphology, nodes: &Nodes) -> Self {
        let mut room = Self::default();
        for soma in &morphology.somata {
            let center = morphology.origin + soma.center.as_dvec3();
            room.take(center, f64::from(soma.radius));
        }
        for node in &nodes.nodes[nodes.somata..] {
            let parent = node.parent.filter(|&p| p as usize >= nodes.somata);
            let Some(parent) = parent.map(|p| &nodes.nodes[p as usize]) else {
                room.take(node.position, node.radius);
                continue;
            };
            let thin = node.radius.min(parent.radius).max(0.1);
            let length = node.position.distance(parent.position);
            let steps = (2.0 * length / thin).ceil().clamp(1.0, 1e6) as u32;
            for step in 1..=steps {
                let share = f64::from(step) / f64::from(steps);
                let radius = parent.radius + share * (node.radius - parent.radius);
                room.take(parent.position.lerp(node.position, share), radius);
            }
        }
        room
    }

    /// Whether nothing touches a sphere (µm).
    pub(super) fn is_free(&self, center: DVec3, radius: f64) -> bool {
        let meets = |&(other, reach): &(DVec3, f64)| {
            center.distance_squared(other) < (radius + reach + GAP).powi(2)
        };
        let [low, high] = reached(center, radius + GAP);
        cells(low, high).all(|cell| {
            let there = self.cells.get(&cell);
            !there.is_some_and(|spheres| spheres.iter().any(meets))
        })
    }

    /// Takes up the room of a sphere (µm).
    pub(super) fn take(&mut self, center: DVec3, radius: f64) {
        if !(center.is_finite() && radius > 0.0 && radius.is_finite()) {
            return;
        }
        let [low, high] = reached(center, radius);
        for cell in cells(low, high) {
            self.cells.entry(cell).or_default().push((center, radius));
        }
    }
}

/// Most cells along a side that a sphere is put into: what is larger is no neurite.
const MAX_CELLS: i32 = 64;

fn reached(center: DVec3, radius: f64) -> [IVec3; 2] {
    let cell = |at: DVec3| (at / CELL).floor().as_ivec3();
    let (low, high) = (cell(center - radius), cell(center + radius));
    [low, high.min(low.saturating_add(IVec3::splat(MAX_CELLS)))]
}

fn cells(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.x..=high.x).flat_map(move |x| {
        (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z)))
    })
}
