//! Closed bodies that are merged into a surface, where it lacks something.

use glam::DVec3;
use neurotess_mesh::{SurfaceVertex, Topology, Watch, self_intersections_of};

use crate::options::{UnionError, UnionOptions};
use crate::report::UnionReport;
use crate::rounds::{MAX_GROWTH, merge};
use crate::surface::work::Work;

/// A closed body whose faces look outwards.
pub(crate) struct Body {
    pub(crate) points: Vec<DVec3>,
    pub(crate) faces: Vec<[u32; 3]>,
}

impl Body {
    /// Adds the body to the surface. Its labels and radii are those of the nearest of `names`; the first of them tells
    /// the component that it is of, too. Returns its faces.
    pub(crate) fn add(&self, work: &mut Work, names: &[SurfaceVertex], part: u32) -> Vec<u32> {
        let numbers: Vec<u32> = self
            .points
            .iter()
            .map(|&point| {
                let distance = |name: &&SurfaceVertex| name.position.as_dvec3().distance(point);
                let nearest = names
                    .iter()
                    .min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let vertex = SurfaceVertex {
                    position: point.as_vec3(),
                    ..nearest.copied().unwrap_or_default()
                };
                work.push(vertex, true)
            })
            .collect();
        let first = work.triangles.len() as u32;
        for face in &self.faces {
            work.triangles
                .push(face.map(|corner| numbers[corner as usize]));
            work.parts.push(part);
            work.changed.push(true);
        }
        (first..work.triangles.len() as u32).collect()
    }

    /// The surface with the body merged into it; none if it then crosses itself, or nothing comes of it.
    pub(crate) fn merged(
        &self,
        work: &Work,
        names: &[SurfaceVertex],
        part: u32,
        options: &UnionOptions,
        watch: &Watch<'_>,
    ) -> Result<Option<Work>, UnionError> {
        let mut tried = work.clone();
        let faces = self.add(&mut tried, names, part);
        let pairs = self_intersections_of(&tried.positions(), &tried.faces(), &faces);
        if pairs.is_empty() {
            return Ok(None);
        }
        // Tidied in a crack, faces cross, and the next cut opens the hole again.
        let options = UnionOptions {
            needles: 0.0,
            ..*options
        };
        let mut report = UnionReport::default();
        // There are other bodies to try.
        let most = MAX_GROWTH * pairs.len();
        let insists = false;
        match merge(
            &mut tried,
            pairs,
            most,
            insists,
            &options,
            &mut report,
            watch,
        ) {
            Ok(left) => Ok(left.is_empty().then_some(tried)),
            Err(UnionError::Failed(_)) => Ok(None),
            Err(other) => Err(other),
        }
    }
}

/// Handles of all components; none are counted where the surface is no manifold.
pub(crate) fn handles(shape: &Topology) -> i64 {
    shape.genus.unwrap_or_default()
}

/// Whether a surface is a closed manifold.
pub(crate) fn is_sound(shape: &Topology) -> bool {
    shape.closed && shape.oriented && shape.vertex_manifold
}
