//! Forks so near a soma that no first ring fits between.
//!
//! A neurite's first ring stands a hillock's height over its soma. Where a neurite forks within its soma, or below that
//! height, its branches are followed to where they reach it. Those that touch there share a stem, and the fork moves out
//! to that place; the others leave the soma by themselves.

use glam::DVec3;

use super::insertion_quads::{GAP, QUAD_REACH};
use super::site::{MAX_WAY, THIN, hillock};
use crate::tracing::{Children, NONE, Root, Skeleton, SkeletonNode, SomaSphere};
use crate::warning::Warnings;

/// Steps of a bisection: links are cut at a thousandth of their length.
const HALVINGS: usize = 10;

/// Parts neurites that fork too near their soma, or moves their forks outwards. `hillocks`: whether neurites draw the
/// surface out; without, a fork has to be a radius above it.
pub(crate) fn part(
    skeleton: &mut Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    hillocks: bool,
    warnings: &mut Warnings,
) {
    let children = skeleton.children();
    let mut changes = Changes::default();
    for (index, node) in skeleton.nodes().iter().enumerate() {
        let (Root::Soma(number), NONE) = (node.root, node.parent) else {
            continue;
        };
        if let Some(soma) = &soma_spheres[number as usize] {
            let around = AroundSoma {
                skeleton,
                children,
                soma,
                number,
                hillocks,
            };
            around.part(index as u32, &mut changes);
        }
    }
    for &fork in &changes.forks {
        warnings.add(
            "fork_at_soma",
            Some(skeleton.node(fork).sample),
            "fork within the soma, or too near it for a ring between: its branches leave the soma by themselves, or fork \
             a little farther out",
        );
    }
    if !changes.forks.is_empty() {
        changes.apply(skeleton);
    }
}

/// The neurites of a soma.
struct AroundSoma<'a> {
    skeleton: &'a Skeleton,
    children: &'a Children,
    soma: &'a SomaSphere,
    number: u32,
    hillocks: bool,
}

/// A branch up to where its first ring may be.
struct Branch {
    /// The nodes below that place.
    below: Vec<u32>,
    /// The node at it or beyond.
    next: u32,
    center: DVec3,
    radius: f64,
}

impl AroundSoma<'_> {
    /// Parts a neurite, and those that it becomes.
    fn part(&self, root: u32, changes: &mut Changes) {
        let mut stems = vec![root];
        while let Some(root) = stems.pop() {
            let Some(run) = self.run_to_near_fork(root) else {
                continue;
            };
            let fork = run[run.len() - 1];
            changes.forks.push(fork);
            let mut branches = Vec::new();
            for &child in self.children.of(fork) {
                match self.branch(fork, child) {
                    Some(branch) => branches.push(branch),
                    // It forks or ends before.
                    None => {
                        changes.hung.push((child, Above::Soma(self.number)));
                        stems.push(child);
                    }
                }
            }
            self.hang(&run, self.bundles(branches), changes);
        }
    }

    /// The nodes of a neurite up to its first fork, if that is too near the soma.
    fn run_to_near_fork(&self, root: u32) -> Option<Vec<u32>> {
        let (mut run, mut here, mut way) = (vec![root], root, 0.0);
        while let [next] = *self.children.of(here) {
            way += self.way([here, next]);
            if way > MAX_WAY * self.soma.radius {
                return None;
            }
            run.push(next);
            here = next;
        }
        let fork = self.skeleton.node(here);
        let near = way.max(self.height(fork.center)) < self.first_ring(fork.radius);
        (near && self.children.of(here).len() > 1).then_some(run)
    }

    /// A branch of a fork, if it gets as high as its first ring before it forks or ends.
    fn branch(&self, fork: u32, child: u32) -> Option<Branch> {
        let radius = |node: u32| self.skeleton.node(node).radius;
        let needed = self.first_ring(radius(fork).min(radius(child)));
        let (mut here, mut next, mut below, mut way) = (fork, child, Vec::new(), 0.0);
        loop {
            let [a, b] = [here, next].map(|node| self.skeleton.node(node));
            if self.height(b.center) >= needed {
                let share = self.share([a.center, b.center], needed);
                // A branch has its own radius from its fork on.
                let before = if here == fork { b.radius } else { a.radius };
                return Some(Branch {
                    below,
                    next,
                    center: a.center.lerp(b.center, share),
                    radius: before + share * (b.radius - before),
                });
            }
            way += self.way([here, next]);
            let [after] = *self.children.of(next) else {
                return None;
            };
            if way > MAX_WAY * self.soma.radius {
                return None;
            }
            below.push(next);
            (here, next) = (next, after);
        }
    }

    /// Hangs branches on their fork, moved to where those that touch are, or on roots of their own.
    fn hang(&self, run: &[u32], bundles: Vec<Vec<Branch>>, changes: &mut Changes) {
        let fork = run[run.len() - 1];
        let mut is_moved = false;
        for bundle in bundles {
            let share = bundle.len() > 1;
            if share && !is_moved {
                let sum: DVec3 = bundle.iter().map(|branch| branch.center).sum();
                changes.moved.push((fork, sum / bundle.len() as f64));
                is_moved = true;
            }
            for branch in bundle {
                let above = match share {
                    true => Above::Fork(fork),
                    false => Above::New(self.root(&branch)),
                };
                changes.hung.push((branch.next, above));
                changes.left_out.extend(branch.below);
            }
        }
        if !is_moved {
            changes.left_out.extend(run);
        }
    }

    /// A root where a branch leaves the soma by itself.
    fn root(&self, branch: &Branch) -> SkeletonNode {
        SkeletonNode {
            center: branch.center,
            radius: branch.radius,
            parent: NONE,
            root: Root::Soma(self.number),
            ..*self.skeleton.node(branch.next)
        }
    }

    /// Branches by those whose first rings would have no room beside one another.
    fn bundles(&self, branches: Vec<Branch>) -> Vec<Vec<Branch>> {
        let mut bundles: Vec<Vec<Branch>> = Vec::new();
        for branch in branches {
            let touches = |other: &Branch| {
                let room = self.room(other.radius) + self.room(branch.radius);
                other.center.distance(branch.center) < room
            };
            let (near, far): (Vec<_>, Vec<_>) = bundles
                .into_iter()
                .partition(|bundle: &Vec<Branch>| bundle.iter().any(touches));
            bundles = far;
            bundles.push(near.into_iter().flatten().chain([branch]).collect());
        }
        bundles
    }

    /// Half the room (µm) that a first ring takes on the soma; see [`make_room`](super::insertion_quads::make_room).
    fn room(&self, radius: f64) -> f64 {
        match self.hillocks && radius < THIN * self.soma.radius {
            true => QUAD_REACH * radius,
            false => GAP * radius,
        }
    }

    /// Height (µm) of a place over the soma's surface, as seen from its center.
    fn height(&self, place: DVec3) -> f64 {
        place.distance(self.soma.center) - self.soma.towards(place)
    }

    /// Height (µm) of the first ring of a neurite.
    fn first_ring(&self, radius: f64) -> f64 {
        match self.hillocks {
            true => hillock(radius, self.soma),
            false => radius.min(0.5 * self.soma.radius),
        }
    }

    /// The share of a link after which it is so high (µm) over the soma; its end is.
    fn share(&self, [from, to]: [DVec3; 2], height: f64) -> f64 {
        let (mut below, mut beyond) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(below, beyond);
            match self.height(from.lerp(to, middle)) < height {
                true => below = middle,
                false => beyond = middle,
            }
        }
        beyond
    }

    /// Length (µm) of a link; within the soma it is none.
    fn way(&self, link: [u32; 2]) -> f64 {
        let [a, b] = link.map(|node| self.skeleton.node(node).center);
        match self.height(a).min(self.height(b)) > 0.0 {
            true => a.distance(b),
            false => 0.0,
        }
    }
}

/// What becomes of the nodes around somata.
#[derive(Default)]
struct Changes {
    /// Forks that were too near.
    forks: Vec<u32>,
    /// Where forks are instead.
    moved: Vec<(u32, DVec3)>,
    /// Nodes that hang on something else.
    hung: Vec<(u32, Above)>,
    left_out: Vec<u32>,
}

/// What a node hangs on.
enum Above {
    Fork(u32),
    New(SkeletonNode),
    Soma(u32),
}

impl Changes {
    fn apply(self, skeleton: &mut Skeleton) {
        let nodes = skeleton.links();
        for (fork, center) in self.moved {
            nodes[fork as usize].center = center;
        }
        for (node, above) in self.hung {
            nodes[node as usize].parent = match above {
                Above::Fork(fork) => fork,
                Above::New(root) => {
                    nodes.push(root);
                    nodes.len() as u32 - 1
                }
                Above::Soma(soma) => {
                    nodes[node as usize].root = Root::Soma(soma);
                    NONE
                }
            };
        }
        let mut keep = vec![true; nodes.len()];
        for node in self.left_out {
            keep[node as usize] = false;
        }
        skeleton.cut(&keep);
        skeleton.reorder();
    }
}
