//! The nodes of a cell in the making, and the room that they leave.

use glam::DVec3;
use neurotess_morphology::{NeuriteKind, Node};

use crate::room::{Capsule, Room};

/// A cell in the making.
pub(crate) struct Grown {
    /// The soma's samples first, parents before what comes of them.
    pub(crate) nodes: Vec<Node>,
    /// How many samples the soma has: capsule 0 leads to the node after them.
    somata: usize,
    /// Where the neurites are; `None` if they may cross.
    pub(crate) room: Option<Room>,
}

impl Grown {
    /// A soma, with room for neurites or without a look at it.
    pub(crate) fn new(soma: Vec<Node>, room: Option<Room>) -> Self {
        Self {
            somata: soma.len(),
            nodes: soma,
            room,
        }
    }

    /// Number of the last node.
    pub(crate) fn last(&self) -> u32 {
        (self.nodes.len() - 1) as u32
    }

    /// Number of the capsule that leads to a node; none leads to the soma.
    pub(crate) fn capsule_to(&self, node: u32) -> Option<u32> {
        (node as usize)
            .checked_sub(self.somata)
            .map(|number| number as u32)
    }

    /// Appends the point that a capsule leads to, rounded as files have it: thousandths, radii to a tenth of
    /// that.
    pub(crate) fn push(&mut self, kind: NeuriteKind, parent: u32, radius: f64, capsule: &Capsule) {
        self.nodes.push(Node {
            id: self.nodes.len() as i64 + 1,
            kind,
            position: (capsule.to * 1e3).round() / 1e3,
            radius: rounded(radius),
            parent: Some(parent),
            section: None,
        });
        if let Some(room) = &mut self.room {
            room.add(capsule);
        }
    }

    /// Takes back all nodes but the first `count`.
    pub(crate) fn keep(&mut self, count: usize) {
        self.nodes.truncate(count);
        if let Some(room) = &mut self.room {
            room.keep(count - self.somata);
        }
    }

    /// Gives the last node another radius.
    pub(crate) fn set_last_radius(&mut self, radius: f64) {
        if let Some(node) = self.nodes.last_mut() {
            node.radius = rounded(radius);
        }
    }

    /// Direction of the step to a node of a neurite that is not its first.
    pub(crate) fn step_to(&self, node: u32) -> Option<DVec3> {
        let node = &self.nodes[node as usize];
        let before = node.parent.filter(|&before| before != 0)?;
        let step = node.position - self.nodes[before as usize].position;
        Some(step.normalize_or_zero())
    }

    /// Direction of the first branch that was grown from a node, if one was.
    pub(crate) fn first_step_from(&self, node: u32) -> Option<DVec3> {
        let next = self.nodes.get(node as usize + 1)?;
        let step = next.position - self.nodes[node as usize].position;
        (next.parent == Some(node)).then(|| step.normalize_or_zero())
    }

    /// Of the nodes of a kind, or of all if there is none, the one farthest from the soma's center.
    pub(crate) fn farthest(&self, kind: NeuriteKind) -> u32 {
        let key = |node: u32| {
            let node = &self.nodes[node as usize];
            (node.kind == kind, node.position.length_squared())
        };
        let nodes = 0..self.nodes.len() as u32;
        let further = |&a: &u32, &b: &u32| {
            let (a, b) = (key(a), key(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        };
        nodes.max_by(further).unwrap_or(0)
    }
}

fn rounded(radius: f64) -> f64 {
    (radius * 1e4).round() / 1e4
}
