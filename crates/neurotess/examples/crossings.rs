//! Counts pairs of triangles that cross, with branches as traced and moved apart.
//!
//! `cargo run --release -p neurotess --example crossings -- FILES…` prints two lines per file. A pair is
//! *near* if the way between its two along the tree is short: at forks and bends. All others are *apart*:
//! branches that were traced through one another, or through a soma that they do not belong to.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{Crossings, GenerateOptions, Generated, generate};
use neurotess::mesh::{SurfaceMesh, search_self_intersections};
use neurotess::morphology::{Attachment, Morphology};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

/// Level of the meshes that are judged.
const LEVEL: u32 = 2;
/// A way is short up to so many sums of radii.
const SHORT: f64 = 2.0;
/// A fork counts with so many of its radii.
const FORK: f64 = 1.5;

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() {
    for file in std::env::args().skip(1) {
        match judge(Path::new(&file)) {
            Ok(lines) => println!("{lines}"),
            Err(error) => println!("{file}: {error}"),
        }
    }
}

fn judge(file: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let morphology = read(file, &ReadOptions::default())?.morphology;
    let mut tree = Tree::new(&morphology);
    let mut lines = format!("{} ({} points)", morphology.name, morphology.points.len());
    for crossings in [Crossings::Keep, Crossings::Separate] {
        let options = GenerateOptions {
            crossings,
            ..GenerateOptions::default()
        };
        let clock = Instant::now();
        let generated = generate(&morphology, &options)?;
        let seconds = clock.elapsed().as_secs_f64();
        tree.measure_kept(&generated);
        let counts = tree.counts(&generated);
        lines += &format!("\n  {crossings:?}: {counts:?} {seconds:.3} s");
        if let Some(separation) = generated.separation {
            let left = separation.places.iter().filter(|p| p.after > 0.0).count();
            lines += &format!(
                "\n    places {} left {left}, moved {} points, median {:.3} µm {:.2} r, largest {:.2} µm {:.1} r, \
                 length {:+.3} %, complete {}",
                separation.places.len(),
                separation.moved,
                separation.median_move,
                separation.median_move_radii,
                separation.largest_move,
                separation.largest_move_radii,
                100.0 * separation.length_change,
                separation.complete,
            );
            for place in separation.places.iter().filter(|p| p.after > 0.0) {
                lines += &format!("\n      left: {place:?}");
            }
            if std::env::var_os("WARNINGS").is_some() {
                for warning in &generated.warnings {
                    lines += &format!("\n      {warning}");
                }
            }
        }
    }
    Ok(lines)
}

#[derive(Debug, Default)]
struct Counts {
    all: usize,
    near: usize,
    apart: usize,
    soma: usize,
    soma_apart: usize,
    /// Pairs apart, by samples: the most frequent.
    most: Vec<([i64; 2], usize)>,
    complete: bool,
}

/// The traced points with their ways.
struct Tree<'a> {
    morphology: &'a Morphology,
    number: BTreeMap<i64, usize>,
    parent: Vec<Option<usize>>,
    /// Way from the root, or from the sphere of its soma.
    arc: Vec<f64>,
    soma: Vec<Option<u32>>,
    length: Vec<f64>,
    /// Way to the point above that the mesh has.
    kept: Vec<f64>,
}

impl<'a> Tree<'a> {
    fn new(morphology: &'a Morphology) -> Self {
        let count = morphology.points.len();
        let ids = morphology.sample_ids.iter().enumerate();
        let mut tree = Self {
            morphology,
            number: ids.map(|(i, &id)| (id, i)).collect(),
            parent: vec![None; count],
            arc: vec![0.0; count],
            soma: vec![None; count],
            length: vec![0.0; count],
            kept: vec![0.0; count],
        };
        for section in &morphology.sections {
            let mut above = match section.attachment {
                Attachment::Section(id) => Some(morphology.sections[id.index()].end as usize - 1),
                _ => None,
            };
            for i in section.range() {
                let at = |i: usize| morphology.points[i].position.as_dvec3();
                tree.parent[i] = above;
                if let Some(above) = above {
                    tree.length[i] = at(i).distance(at(above));
                    tree.arc[i] = tree.arc[above] + tree.length[i];
                    tree.soma[i] = tree.soma[above];
                } else if let Attachment::Soma { soma, .. } = section.attachment {
                    let sphere = &morphology.somata[soma as usize];
                    let way = at(i).distance(sphere.center.as_dvec3()) - f64::from(sphere.radius);
                    tree.length[i] = way.max(0.0);
                    tree.arc[i] = way;
                    tree.soma[i] = Some(soma);
                }
                above = Some(i);
            }
        }
        tree
    }

    fn radius(&self, i: usize) -> f64 {
        f64::from(self.morphology.points[i].radius)
    }

    /// A facet lies anywhere between its sample and the one above it that the mesh has.
    fn measure_kept(&mut self, generated: &Generated) {
        let samples: std::collections::BTreeSet<i64> = generated
            .mesh
            .tracing
            .iter()
            .filter(|t| t.section != 0)
            .map(|t| i64::from(t.sample))
            .collect();
        for i in 0..self.kept.len() {
            let above = self.parent[i].map_or(0.0, |above| {
                match samples.contains(&self.morphology.sample_ids[above]) {
                    true => 0.0,
                    false => self.kept[above],
                }
            });
            self.kept[i] = self.length[i] + above;
        }
    }

    fn near(&self, a: usize, b: usize) -> bool {
        let (mut i, mut j) = (Some(a), Some(b));
        let slack = self.kept[a] + self.kept[b];
        let radii = self.radius(a) + self.radius(b);
        while i != j {
            if i > j {
                i = self.parent[i.expect("Some is more than None")];
            } else {
                j = self.parent[j.expect("Some is more than None")];
            }
        }
        match i {
            None => {
                let same = self.soma[a].is_some() && self.soma[a] == self.soma[b];
                same && self.arc[a] + self.arc[b] <= SHORT * radii + slack
            }
            Some(fork) => {
                let way = self.arc[a] + self.arc[b] - 2.0 * self.arc[fork];
                way <= SHORT * radii.max(FORK * self.radius(fork)) + slack
            }
        }
    }

    fn counts(&self, generated: &Generated) -> Counts {
        let refinement = Refinement::new(
            &generated.mesh,
            LodCriterion::Homogeneous(LEVEL),
            &RefineOptions::default(),
        );
        let surface = SurfaceMesh::collect(&refinement);
        let search = search_self_intersections(&surface.positions(), &surface.faces);
        let point = |face: u32| {
            let corners = surface.faces.triangles[face as usize];
            let vertices = corners.map(|v| surface.vertices[v as usize]);
            let numbers = vertices
                .iter()
                .filter(|v| v.section != 0)
                .filter_map(|v| self.number.get(&i64::from(v.point)));
            numbers.max().copied()
        };
        let mut counts = Counts {
            all: search.pairs.len(),
            complete: search.complete,
            ..Counts::default()
        };
        let mut places: BTreeMap<[i64; 2], usize> = BTreeMap::new();
        for [a, b] in search.pairs {
            let id = |i: usize| self.morphology.sample_ids[i];
            match (point(a), point(b)) {
                (Some(a), Some(b)) if self.near(a, b) => counts.near += 1,
                (Some(a), Some(b)) => {
                    counts.apart += 1;
                    *places.entry([id(a.min(b)), id(a.max(b))]).or_default() += 1;
                }
                (Some(a), None) | (None, Some(a)) => {
                    let own = self.soma[a].is_some()
                        && self.arc[a] - self.length[a] <= 4.0 * self.radius(a);
                    match own {
                        true => counts.soma += 1,
                        false => {
                            counts.soma_apart += 1;
                            *places.entry([-1, id(a)]).or_default() += 1;
                        }
                    }
                }
                (None, None) => counts.soma += 1,
            }
        }
        counts.most = places.into_iter().collect();
        counts.most.sort_by_key(|m| std::cmp::Reverse(m.1));
        counts.most.truncate(8);
        counts
    }
}
