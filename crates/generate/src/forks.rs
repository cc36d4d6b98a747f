//! What becomes of each fork: an inset of some lift, or a joint. Each is tried and judged by its refined
//! patches, and the best is kept.
//!
//! No rule from angles and radii foretells which does best on a real tracing: points are too dense, bend
//! too tightly, or another branch is in the way. So forks whose patches cross or fold over get the next
//! choice, until all are sound or all choices were tried.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, SurfaceMesh, self_intersections};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

use crate::assemble::{Assembly, Somata};
use crate::inset::{self, ForkChoice};
use crate::skeleton::Skeleton;
use crate::warning::Warnings;
use crate::{crowd, fork, uncross};

/// What is tried, in this order. The lift decides most: 0.4 keeps the branch closest to the tracing,
/// higher ones cross the trunk's bends less.
const CHOICES: [ForkChoice; 4] = [
    ForkChoice::Inset { lift: 0.4 },
    ForkChoice::Inset { lift: 0.7 },
    ForkChoice::Inset { lift: 1.0 },
    ForkChoice::Joint,
];
const JOINT: usize = CHOICES.len() - 1;
/// Level at which patches are judged.
const LEVEL: u32 = 2;
/// Facets folded by more than this count: cosine of 120°.
const FOLDED: f32 = -0.5;

/// The mesh of a skeleton with the best choice for each fork.
pub(crate) fn mesh(skeleton: &Skeleton, somata: &Somata<'_>, warnings: &mut Warnings) -> CoarseMesh {
    let mut trials = ForkTrials::new(skeleton);
    loop {
        let mut found = Warnings::default();
        let mut layout = inset::lay_out(skeleton, trials.choices());
        for &twig in &layout.buried {
            buried(skeleton.node(twig).sample, &mut found);
        }
        crowd::split_crowded_forks(&mut layout.skeleton, &mut found);
        fork::clear_the_way(&mut layout.skeleton, &mut found);
        let orientations = uncross::uncross_rings(&mut layout, somata.soma_spheres, &mut found);
        let mut assembly = Assembly::new(&layout, &orientations);
        assembly.somata(somata);
        let (mesh, patches) = assembly.finish();
        if !trials.advance(&mesh, patches, &layout.refused) {
            warnings.extend(found);
            return mesh;
        }
    }
}

fn buried(sample: i64, warnings: &mut Warnings) {
    warnings.add(
        "buried_twig",
        Some(sample),
        "twig ends inside the neurite that it branches from: left out of the mesh",
    );
}

/// Choices as they are tried.
pub(crate) struct ForkTrials {
    choices: Vec<ForkChoice>,
    /// By fork.
    trials: BTreeMap<u32, Trial>,
}

#[derive(Clone, Copy, Debug)]
struct Trial {
    current: usize,
    /// Faults of each choice that was tried.
    faults: [Option<usize>; CHOICES.len()],
    settled: bool,
}

impl ForkTrials {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let children = skeleton.children();
        let nodes = 0..skeleton.nodes().len() as u32;
        let forks = nodes.filter(|&n| children.of(n).len() > 1);
        let trial = Trial {
            current: 0,
            faults: [None; CHOICES.len()],
            settled: false,
        };
        Self {
            choices: vec![CHOICES[0]; skeleton.nodes().len()],
            trials: forks.map(|fork| (fork, trial)).collect(),
        }
    }

    /// By node of the skeleton.
    pub(crate) fn choices(&self) -> &[ForkChoice] {
        &self.choices
    }

    /// Judges the forks that are not settled, and goes on to what is tried next. Whether anything is.
    /// `refused`: forks that became joints for lack of room.
    pub(crate) fn advance(
        &mut self,
        mesh: &CoarseMesh,
        patches: Vec<(u32, Range<u32>)>,
        refused: &[u32],
    ) -> bool {
        for fork in refused {
            if let Some(trial) = self.trials.get_mut(fork) {
                trial.refuse();
            }
        }
        let mut near: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (fork, range) in patches {
            let open = self.trials.get(&fork).is_some_and(|trial| !trial.settled);
            if open {
                near.entry(fork).or_default().extend(range);
            }
        }
        let mut changed = false;
        for (&fork, trial) in &mut self.trials {
            if trial.settled {
                continue;
            }
            let before = CHOICES[trial.current];
            let faults = near.get(&fork).map_or(0, |patches| faults(mesh, patches));
            trial.faults[trial.current] = Some(faults);
            trial.next();
            self.choices[fork as usize] = CHOICES[trial.current];
            changed |= CHOICES[trial.current] != before;
        }
        changed
    }
}

impl Trial {
    /// There is no room for an inset, whatever its lift.
    fn refuse(&mut self) {
        for faults in &mut self.faults[..JOINT] {
            faults.get_or_insert(usize::MAX);
        }
        self.current = JOINT;
    }

    /// Goes on to the first choice that was not tried, or back to the best if all were or one is sound.
    fn next(&mut self) {
        let sound = self.faults[self.current] == Some(0);
        let untried = self.faults.iter().position(Option::is_none);
        match untried.filter(|_| !sound) {
            Some(next) => self.current = next,
            None => {
                self.settled = true;
                let tried = self.faults.iter().enumerate();
                let best = tried.min_by_key(|(i, faults)| (faults.unwrap_or(usize::MAX), *i));
                self.current = best.map_or(self.current, |(i, _)| i);
            }
        }
    }
}

/// Crossing pairs and folded edges of some patches' refined surface.
fn faults(mesh: &CoarseMesh, patches: &[u32]) -> usize {
    let part = part(mesh, patches);
    let options = RefineOptions::default();
    let level = LodCriterion::Homogeneous(LEVEL);
    let surface = SurfaceMesh::collect(&Refinement::new(&part, level, &options));
    let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
    let crossing = self_intersections(&positions, &surface.faces).len();
    crossing + folds(&positions, &surface.faces.triangles)
}

/// A mesh of some patches only.
fn part(mesh: &CoarseMesh, patches: &[u32]) -> CoarseMesh {
    let mut patches = patches.to_vec();
    patches.sort_unstable();
    patches.dedup();
    let corners = |&patch: &u32| mesh.patches[patch as usize].corners;
    // In the mesh's order: edges run from the lower number.
    let mut vertices: Vec<u32> = patches.iter().flat_map(corners).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let tracing_of = |v: u32| mesh.vertices[v as usize].tracing;
    let mut tracing: Vec<u32> = vertices.iter().map(|&v| tracing_of(v)).collect();
    tracing.sort_unstable();
    tracing.dedup();
    let number = |list: &[u32], of: u32| list.partition_point(|&x| x < of) as u32;
    CoarseMesh {
        origin: mesh.origin,
        vertices: vertices
            .iter()
            .map(|&v| {
                let vertex = mesh.vertices[v as usize];
                let tracing = number(&tracing, vertex.tracing);
                neurotess_mesh::Vertex { tracing, ..vertex }
            })
            .collect(),
        tracing: tracing.iter().map(|&t| mesh.tracing[t as usize]).collect(),
        patches: patches
            .iter()
            .map(|&p| {
                let patch = mesh.patches[p as usize];
                let corners = patch.corners.map(|v| number(&vertices, v));
                neurotess_mesh::Patch { corners, ..patch }
            })
            .collect(),
    }
}

/// Edges between facets that are folded over.
fn folds(positions: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let normal = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| positions[v as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let normals: Vec<Vec3> = triangles.iter().map(normal).collect();
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * triangles.len());
    for (t, &[a, b, c]) in (0..).zip(triangles) {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), t));
        }
    }
    edges.sort_unstable();
    let folded = |pair: &&[(u32, u32, u32)]| {
        let [a, b] = [pair[0], pair[1]];
        let same = (a.0, a.1) == (b.0, b.1);
        same && normals[a.2 as usize].dot(normals[b.2 as usize]) < FOLDED
    };
    edges.windows(2).filter(folded).count()
}
