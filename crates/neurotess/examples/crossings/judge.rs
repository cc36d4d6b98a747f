//! Pairs of triangles that cross, by whether their points of the tracing belong together.

use std::collections::{BTreeMap, BTreeSet};

use neurotess::mesh::{
    CoarseMesh, SectionNumber, SurfaceMesh, SurfaceVertex, search_self_intersections,
};
use neurotess::morphology::{Attachment, Morphology, Section};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

/// Level of the meshes that are judged.
const LEVEL: u32 = 2;
/// The way between two points along the tree is short up to so many sums of their radii.
const SHORT: f64 = 2.0;
/// A fork counts with so many of its radii.
const FORK: f64 = 1.5;
/// A neurite is near its soma up to so many of its radii.
const SOMA: f64 = 4.0;

/// Pairs of triangles that cross.
#[derive(Debug, Default)]
pub(crate) struct Crossing {
    /// At forks and bends, and where a neurite leaves its soma.
    pub(crate) near: usize,
    /// Of branches that do not belong together, or of a branch and a soma that do not.
    pub(crate) apart: usize,
    /// Samples of those apart, −1 for a soma, the most frequent ones first.
    pub(crate) samples: Vec<([i64; 2], usize)>,
}

/// Counts the pairs of a refined mesh.
pub(crate) fn judge(morphology: &Morphology, mesh: &CoarseMesh) -> Crossing {
    let tree = Tree::new(morphology, mesh);
    let lod = LodCriterion::Homogeneous(LEVEL);
    let refinement = Refinement::new(mesh, lod, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refinement);
    let mut crossing = Crossing::default();
    let mut samples: BTreeMap<[i64; 2], usize> = BTreeMap::new();
    for pair in search_self_intersections(&surface.positions(), &surface.faces).pairs {
        let points = pair.map(|face| {
            let corners = surface.faces.triangles[face as usize];
            tree.point(&corners.map(|v| surface.vertices[v as usize]))
        });
        if tree.belong_together(points) {
            crossing.near += 1;
        } else {
            crossing.apart += 1;
            let mut pair = points.map(|p| p.map_or(-1, |i| morphology.sample_ids[i]));
            pair.sort_unstable();
            *samples.entry(pair).or_default() += 1;
        }
    }
    crossing.samples = samples.into_iter().collect();
    crossing.samples.sort_by_key(|s| std::cmp::Reverse(s.1));
    crossing
}

/// The traced points with the ways between them.
struct Tree<'a> {
    morphology: &'a Morphology,
    /// Number of a point by its sample.
    number: BTreeMap<i64, usize>,
    parent: Vec<Option<usize>>,
    /// Way (µm) from the root, or from the sphere of its soma.
    arc: Vec<f64>,
    soma: Vec<Option<u32>>,
    /// Way (µm) to the point above that the mesh has: a facet lies anywhere between the two.
    facet: Vec<f64>,
}

impl<'a> Tree<'a> {
    fn new(morphology: &'a Morphology, mesh: &CoarseMesh) -> Self {
        let count = morphology.points.len();
        let ids = morphology.sample_ids.iter().enumerate();
        let mut tree = Self {
            morphology,
            number: ids.map(|(i, &id)| (id, i)).collect(),
            parent: vec![None; count],
            arc: vec![0.0; count],
            soma: vec![None; count],
            facet: vec![0.0; count],
        };
        let neurites = mesh
            .tracing
            .iter()
            .filter(|t| t.section != SectionNumber::SOMA);
        let kept: BTreeSet<i64> = neurites.map(|t| i64::from(t.sample.0)).collect();
        for section in &morphology.sections {
            tree.add_section(section, &kept);
        }
        tree
    }

    fn add_section(&mut self, section: &Section, kept: &BTreeSet<i64>) {
        let points = &self.morphology.points;
        let at = |i: usize| points[i].position.as_dvec3();
        let mut above = match section.attachment {
            Attachment::Section(id) => Some(self.morphology.sections[id.index()].end as usize - 1),
            _ => None,
        };
        for i in section.range() {
            self.parent[i] = above;
            if let Some(above) = above {
                let length = at(i).distance(at(above));
                self.arc[i] = self.arc[above] + length;
                self.soma[i] = self.soma[above];
                let is_kept = kept.contains(&self.morphology.sample_ids[above]);
                self.facet[i] = length + if is_kept { 0.0 } else { self.facet[above] };
            } else if let Attachment::Soma { soma, .. } = section.attachment {
                let sphere = &self.morphology.somata[soma as usize];
                self.arc[i] = at(i).distance(sphere.center.as_dvec3()) - f64::from(sphere.radius);
                self.facet[i] = self.arc[i].max(0.0);
                self.soma[i] = Some(soma);
            }
            above = Some(i);
        }
    }

    /// The traced point of a triangle, the lowest of its corners; none on a soma.
    fn point(&self, corners: &[SurfaceVertex; 3]) -> Option<usize> {
        let neurites = corners.iter().filter(|v| v.section != 0);
        let numbers = neurites.filter_map(|v| self.number.get(&i64::from(v.point)));
        numbers.max().copied()
    }

    fn radius(&self, i: usize) -> f64 {
        f64::from(self.morphology.points[i].radius)
    }

    fn belong_together(&self, points: [Option<usize>; 2]) -> bool {
        match points {
            [Some(a), Some(b)] => self.near(a, b),
            [Some(a), None] | [None, Some(a)] => {
                self.soma[a].is_some() && self.arc[a] - self.facet[a] <= SOMA * self.radius(a)
            }
            [None, None] => true,
        }
    }

    fn near(&self, a: usize, b: usize) -> bool {
        let radii = self.radius(a) + self.radius(b);
        let least = self.facet[a] + self.facet[b];
        match self.parting(a, b) {
            None => {
                let same = self.soma[a].is_some() && self.soma[a] == self.soma[b];
                same && self.arc[a] + self.arc[b] <= SHORT * radii + least
            }
            Some(fork) => {
                let way = self.arc[a] + self.arc[b] - 2.0 * self.arc[fork];
                way <= SHORT * radii.max(FORK * self.radius(fork)) + least
            }
        }
    }

    /// The lowest point above both.
    fn parting(&self, a: usize, b: usize) -> Option<usize> {
        let (mut a, mut b) = (Some(a), Some(b));
        // Parents come first, and nothing before all of them.
        while a != b {
            let lower = if a > b { &mut a } else { &mut b };
            *lower = lower.and_then(|i| self.parent[i]);
        }
        a
    }
}
