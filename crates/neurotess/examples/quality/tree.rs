//! The traced tree, point by point.

use glam::Vec3;
use neurotess::morphology::{Attachment, Morphology};

/// Points with their parents and children. Points that hang on a soma have no parent.
pub(crate) struct Tree {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) radii: Vec<f32>,
    pub(crate) parents: Vec<Option<usize>>,
    pub(crate) children: Vec<Vec<usize>>,
}

impl Tree {
    pub(crate) fn new(morphology: &Morphology) -> Self {
        let points = &morphology.points;
        let mut parents = vec![None; points.len()];
        for section in &morphology.sections {
            if let Attachment::Section(parent) = section.attachment {
                let last = morphology.sections[parent.index()].end as usize - 1;
                parents[section.first as usize] = Some(last);
            }
            for point in section.range().skip(1) {
                parents[point] = Some(point - 1);
            }
        }
        let mut children = vec![Vec::new(); points.len()];
        for (point, parent) in parents.iter().enumerate() {
            if let Some(parent) = *parent {
                children[parent].push(point);
            }
        }
        Self {
            positions: points.iter().map(|point| point.position).collect(),
            radii: points.iter().map(|point| point.radius).collect(),
            parents,
            children,
        }
    }

    /// Points with several children.
    pub(crate) fn forks(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.children.len()).filter(|&point| self.children[point].len() > 1)
    }

    /// The thickest radius (µm) at a fork.
    pub(crate) fn radius(&self, fork: usize) -> f32 {
        let children = self.children[fork].iter();
        children.fold(self.radii[fork], |most, &child| most.max(self.radii[child]))
    }

    /// The ways from a fork, so far (µm): to its parents, then along each child and the thickest of its children.
    pub(crate) fn branches(&self, fork: usize, length: f32) -> Vec<Vec<[usize; 2]>> {
        let up = self.follow(fork, self.parents[fork], length, |point| {
            self.parents[point]
        });
        let mut branches = vec![up];
        for &child in &self.children[fork] {
            let thickest = |point: usize| {
                let by_radius = |&a: &usize, &b: &usize| self.radii[a].total_cmp(&self.radii[b]);
                self.children[point].iter().copied().max_by(by_radius)
            };
            branches.push(self.follow(fork, Some(child), length, thickest));
        }
        branches.retain(|branch| !branch.is_empty());
        branches
    }

    fn follow(
        &self,
        from: usize,
        to: Option<usize>,
        length: f32,
        onward: impl Fn(usize) -> Option<usize>,
    ) -> Vec<[usize; 2]> {
        let (mut before, mut here, mut left) = (from, to, length);
        let mut cones = Vec::new();
        while let Some(point) = here.filter(|_| left > 0.0) {
            cones.push([before, point]);
            left -= self.positions[point].distance(self.positions[before]);
            (before, here) = (point, onward(point));
        }
        cones
    }

    /// Distance (µm) of a place from a round cone.
    pub(crate) fn distance(&self, place: Vec3, [a, b]: [usize; 2]) -> f32 {
        let [from, to] = [a, b].map(|point| self.positions[point]);
        let way = to - from;
        let t = ((place - from).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
        let radius = self.radii[a] + (self.radii[b] - self.radii[a]) * t;
        place.distance(from + way * t) - radius
    }
}
