//! Rings that may be at fault, by tests of a few products each: nearly all rings of a cell are sound, and
//! nothing is refined of them.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind, Role, TracingPoint};
use rayon::prelude::*;

use super::graph::RingGraph;
use crate::plan;

/// Rings are looked at beside those within this many radii along the tree: where a dense tracing wanders,
/// a tube comes back to itself after some thirty.
const REACH: f32 = 40.0;
/// But beside no more of them than this, so that crowds cost no square.
const MAX_VISITED: usize = 400;
/// Cones steeper than this may fold: change of radius over length.
const STEEP: f32 = 1.0;
/// Cosine of the angle between a ring's neighbors from which on its tube may fold: a turn of 110°.
const TURN_BACK: f32 = 0.34;
/// Rings that are looked at by one task.
const CHUNK: usize = 512;

/// Suspect tracing points.
pub(super) struct Suspects {
    /// By tracing point.
    pub(super) rings: Vec<bool>,
    /// Rings that are in each other's way and do not follow one another.
    pub(super) pairs: Vec<[u32; 2]>,
}

impl Suspects {
    pub(super) fn new(mesh: &CoarseMesh, graph: &RingGraph) -> Self {
        let mut suspects = Self {
            rings: vec![false; mesh.tracing.len()],
            pairs: pairs(mesh, graph),
        };
        let steep = |ends: &&[u32; 2]| {
            let [a, b] = ends.map(|t| &mesh.tracing[t as usize]);
            follow_badly(a, b)
        };
        let rings = 0..mesh.tracing.len() as u32;
        let turned = rings.into_par_iter().with_min_len(CHUNK);
        let tubes = mesh.patches.par_iter().with_min_len(CHUNK);
        let tubes = tubes.filter(|p| matches!(p.kind, PatchKind::Lateral | PatchKind::Loft));
        let found: [Vec<u32>; 3] = [
            (graph.tubes().par_iter().with_min_len(CHUNK))
                .filter(steep)
                .flat_map_iter(|&ends| ends)
                .collect(),
            turned
                .filter(|&ring| turns_back(mesh, graph, ring))
                .collect(),
            tubes
                .filter(|patch| is_inside_out(mesh, patch.corners))
                .flat_map_iter(|patch| {
                    let [a, _, _, d] = patch.corners;
                    [a, d].map(|v| mesh.vertices[v as usize].tracing)
                })
                .collect(),
        ];
        suspects.add(found.into_iter().flatten());
        for number in 0..suspects.pairs.len() {
            suspects.add(suspects.pairs[number]);
        }
        suspects
    }

    pub(super) fn add(&mut self, rings: impl IntoIterator<Item = u32>) {
        for ring in rings {
            self.rings[ring as usize] = true;
        }
    }
}

/// Rings that are in each other's way, the thicker first, though they do not follow one another.
fn pairs(mesh: &CoarseMesh, graph: &RingGraph) -> Vec<[u32; 2]> {
    let margins = margins(mesh, graph);
    let disks: Vec<Disk> = mesh.tracing.iter().map(Disk::of).collect();
    let count = mesh.tracing.len() as u32;
    let chunks: Vec<u32> = (0..count).step_by(CHUNK).collect();
    let found: Vec<Vec<[u32; 2]>> = chunks
        .into_par_iter()
        .map(|first| {
            let mut walk = Walk {
                mesh,
                graph,
                disks: &disks,
                margins: &margins,
                queue: Vec::with_capacity(MAX_VISITED + 8),
                pairs: Vec::new(),
            };
            let end = (first + CHUNK as u32).min(count);
            (first..end).for_each(|ring| walk.from(ring));
            walk.pairs
        })
        .collect();
    found.into_iter().flatten().collect()
}

/// Walks from one ring after the other along the tree.
struct Walk<'a> {
    mesh: &'a CoarseMesh,
    graph: &'a RingGraph,
    disks: &'a [Disk],
    margins: &'a [f32],
    queue: Vec<Step>,
    pairs: Vec<[u32; 2]>,
}

/// Of a ring, what nearly all steps of a walk need: close together in memory, beside the rest in the mesh.
#[derive(Clone, Copy, Debug)]
struct Disk {
    center: Vec3,
    radius: f32,
}

impl Disk {
    fn of(ring: &TracingPoint) -> Self {
        Self {
            center: ring.center,
            radius: ring.radius,
        }
    }
}

/// A ring on a walk: where from, how far along the tree (µm), and in how many steps.
#[derive(Clone, Copy)]
struct Step {
    ring: u32,
    from: u32,
    way: f32,
    steps: u32,
}

impl Walk<'_> {
    fn from(&mut self, start: u32) {
        if self.mesh.tracing[start as usize].role == Role::Soma {
            return;
        }
        let disk = self.disks[start as usize];
        // Rings in each other's way are two radii apart at most.
        let farthest = (REACH + 2.0) * disk.radius;
        self.queue.clear();
        self.queue.push(Step {
            ring: start,
            from: start,
            way: 0.0,
            steps: 0,
        });
        let mut next = 0;
        while let Some(&Step {
            ring: here,
            from,
            way,
            steps,
        }) = self.queue.get(next)
        {
            next += 1;
            let other = self.disks[here as usize];
            let thinner = (other.radius, here) < (disk.radius, start);
            let apart = disk.center.distance_squared(other.center);
            let reach = disk.radius + other.radius;
            if steps > 1 && thinner && apart <= reach * reach && self.in_the_way(start, here) {
                self.pairs.push([start, here]);
            }
            // Beyond, the way back to here is too long.
            let left = farthest - way;
            if left < 0.0 || apart > left * left || self.queue.len() > MAX_VISITED {
                continue;
            }
            for (to, step) in self.graph.ways(here).filter(|&(to, _)| to != from) {
                self.queue.push(Step {
                    ring: to,
                    from: here,
                    way: way + step,
                    steps: steps + 1,
                });
            }
        }
    }

    /// Whether the disks of two rings whose bounding spheres overlap do so too, each as thick as its margin to either side.
    fn in_the_way(&self, start: u32, here: u32) -> bool {
        let [a, b] = [start, here].map(|t| &self.mesh.tracing[t as usize]);
        let way = b.center - a.center;
        let sin = a.tangent.cross(b.tangent).length();
        let beside = |ring: &TracingPoint, margin: f32, other: &TracingPoint| {
            let height = way.dot(ring.tangent).abs();
            ring.role == Role::Joint || height <= other.radius * sin + margin
        };
        let [margin_a, margin_b] = [start, here].map(|t| self.margins[t as usize]);
        beside(a, margin_a, b) && beside(b, margin_b, a)
    }
}

/// Half of what a ring's tubes reach beyond its disk (µm): half the way to its farther neighbor, at most
/// its radius; at an end, the cap.
fn margins(mesh: &CoarseMesh, graph: &RingGraph) -> Vec<f32> {
    let mut margins = vec![0.0_f32; mesh.tracing.len()];
    for &ends in graph.tubes() {
        let [a, b] = ends.map(|t| &mesh.tracing[t as usize]);
        let half = 0.5 * a.center.distance(b.center);
        for (t, ring) in ends.into_iter().zip([a, b]) {
            let margin = &mut margins[t as usize];
            *margin = match ring.role {
                Role::End => ring.radius,
                _ => margin.max(half.min(ring.radius)),
            };
        }
    }
    margins
}

/// Whether a ring's disk reaches into the next one's, or the cone between them is steep.
fn follow_badly(a: &TracingPoint, b: &TracingPoint) -> bool {
    let way = b.center - a.center;
    if (a.radius - b.radius).abs() > STEEP * way.length() {
        return true;
    }
    let has_disk = |ring: &TracingPoint| !matches!(ring.role, Role::Joint | Role::Inset);
    if !has_disk(a) || !has_disk(b) {
        return false;
    }
    let [a, b] = [a, b].map(|ring| plan::Disk {
        center: ring.center.as_dvec3(),
        normal: ring.tangent.as_dvec3(),
        radius: ring.radius.into(),
    });
    !a.is_clear_of(&b)
}

/// Whether a path turns so sharply at a ring that its tube may fold over.
fn turns_back(mesh: &CoarseMesh, graph: &RingGraph, ring: u32) -> bool {
    let &[before, after] = graph.neighbors(ring) else {
        return false;
    };
    let center = |ring: u32| mesh.tracing[ring as usize].center;
    let [a, b] = [before, after].map(|neighbor| center(neighbor) - center(ring));
    a.dot(b) > TURN_BACK * a.length() * b.length()
}

/// Whether a patch of a tube looks inwards at one of its corners.
fn is_inside_out(mesh: &CoarseMesh, corners: [u32; 4]) -> bool {
    let vertices = corners.map(|v| &mesh.vertices[v as usize]);
    let [a, b, c, d] = vertices.map(|v| v.position);
    let [from, to] = [0, 3].map(|k: usize| mesh.tracing[vertices[k].tracing as usize].center);
    let outwards = a + b + c + d - 2.0 * (from + to);
    let inwards =
        |before: Vec3, at: Vec3, after: Vec3| (at - before).cross(after - at).dot(outwards) <= 0.0;
    inwards(d, a, b) || inwards(a, b, c) || inwards(b, c, d) || inwards(c, d, a)
}
