//! Levels of detail of a tracing, as all cells that have it share them.
//!
//! They come from refinement, so each is a closed surface of its own: nothing is decimated. The finest is within an error of
//! the smooth surface, each next one within four times as much, and the coarsest is the coarse mesh.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::{DAffine3, DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Surface, SurfaceMesh, Watch};
use neurotess_morphology::Morphology;
use neurotess_recipe::{MeshError, MeshOptions, memory, mesh_watched};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use rayon::prelude::*;

use crate::multilod::PlacedLevel;
use crate::skeleton::NM;

/// From one level to the next.
const COARSER: f32 = 4.0;

/// What a triangle takes until it is encoded. Measured: 180 bytes, on a cell of 5,000 points.
const BYTES: u64 = 180;

/// Which levels cells have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelOptions {
    /// How far (µm) the finest level may be from the smooth surface.
    pub max_error: f32,
    /// Most levels, 1 or more. With 1 there is the finest only; of simple cells there are fewer.
    pub count: usize,
}

impl Default for LevelOptions {
    /// Four levels from 40 nm on: two steps of the grid of a cell of 1.4 mm, below which errors would be the grid's.
    fn default() -> Self {
        Self {
            max_error: 0.04,
            count: 4,
        }
    }
}

/// A tracing and its levels of detail, finest first.
pub struct TemplateMesh {
    /// The tracing.
    pub morphology: Arc<Morphology>,
    origin: DVec3,
    levels: Vec<Level>,
}

struct Level {
    /// µm, relative to the origin.
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// µm.
    error: f32,
}

impl TemplateMesh {
    /// Meshes a tracing.
    ///
    /// # Errors
    /// It cannot be meshed, or another thread has set `stopped`.
    pub fn new(
        morphology: Arc<Morphology>,
        options: LevelOptions,
        stopped: &AtomicBool,
    ) -> Result<Self, MeshError> {
        let watch = Watch::stopped_by(stopped);
        let cell = mesh_watched(Arc::clone(&morphology), &MeshOptions::default(), &watch)?;
        let coarse = &cell.generated.mesh;
        let refined = |criterion| Refinement::new(coarse, criterion, &RefineOptions::default());
        let coarsest = refined(LodCriterion::Homogeneous(1));
        let mut planned = vec![(
            refined(LodCriterion::MaxError(options.max_error)),
            options.max_error,
        )];
        while planned.len() < options.count {
            let (finer, error) = &planned[planned.len() - 1];
            if finer.triangle_count() == coarsest.triangle_count() {
                break;
            }
            let error = COARSER * error;
            let next = refined(LodCriterion::MaxError(error));
            let is_coarsest = next.triangle_count() == coarsest.triangle_count();
            if is_coarsest || planned.len() + 1 == options.count {
                let error = coarse_error(coarse).max(error / COARSER);
                planned.push((refined(LodCriterion::Homogeneous(1)), error));
                break;
            }
            planned.push((next, error));
        }
        let origin = coarsest.origin();
        let triangles: usize = planned
            .iter()
            .map(|(level, _)| level.triangle_count())
            .sum();
        memory::check((triangles as u64).saturating_mul(BYTES))?;
        let made = planned.par_iter().map(|(surface, error)| {
            let mesh = SurfaceMesh::collect_watched(surface, &watch)
                .map_err(|_stopped| MeshError::Stopped)?;
            Ok(Level {
                corners: mesh.vertices.iter().map(|vertex| vertex.position).collect(),
                triangles: mesh.faces.triangles,
                error: *error,
            })
        });
        Ok(Self {
            morphology,
            origin,
            levels: made.collect::<Result<_, MeshError>>()?,
        })
    }

    /// The levels at a place.
    pub fn placed(&self, world_from_cell: DAffine3) -> Vec<PlacedLevel<'_>> {
        let scale = world_from_cell.matrix3.determinant().cbrt();
        let levels = self.levels.par_iter().map(|level| PlacedLevel {
            corners: {
                let place = |corner: &Vec3| {
                    world_from_cell.transform_point3(self.origin + corner.as_dvec3()) * NM
                };
                level.corners.iter().map(place).collect()
            },
            triangles: &level.triangles,
            error: f64::from(level.error) * scale * NM,
        });
        levels.collect()
    }

    /// Bytes that it takes in memory, about.
    pub(crate) fn bytes(&self) -> usize {
        let of_level =
            |level: &Level| size_of_val(&level.corners[..]) + size_of_val(&level.triangles[..]);
        let tracing = size_of_val(&self.morphology.points[..]);
        self.levels.iter().map(of_level).sum::<usize>() + 2 * tracing
    }
}

/// How far (µm) the coarse mesh is from the smooth surface: in the middles of patches and their sides.
fn coarse_error(coarse: &CoarseMesh) -> f32 {
    let halved = Refinement::new(
        coarse,
        LodCriterion::Homogeneous(2),
        &RefineOptions::default(),
    );
    let of_patch = |patch: usize| {
        let at = |[i, j]: [u32; 2]| halved.grid_vertex(patch, i, j).position;
        let off = |middle, ends: &[[u32; 2]]| {
            let straight: Vec3 = ends.iter().map(|&end| at(end)).sum::<Vec3>() / ends.len() as f32;
            at(middle).distance(straight)
        };
        let [a, b, c, d] = [[0, 0], [2, 0], [2, 2], [0, 2]];
        off([1, 0], &[a, b])
            .max(off([2, 1], &[b, c]))
            .max(off([1, 2], &[c, d]))
            .max(off([0, 1], &[d, a]))
            .max(off([1, 1], &[a, b, c, d]))
    };
    let errors = (0..coarse.patches.len()).into_par_iter().map(of_patch);
    errors.reduce(|| 0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use neurotess_formats::{ReadOptions, swc};

    use super::*;

    fn cell(options: LevelOptions) -> TemplateMesh {
        let text = b"1 1 0 0 0 8 -1\n2 3 0 12 0 1 1\n3 3 3 50 0 0.8 2\n4 3 30 90 0 0.5 3\n5 3 -20 80 9 0.5 3\n";
        let read = swc::read_bytes(text, "a.swc", &ReadOptions::default()).expect("read");
        TemplateMesh::new(Arc::new(read.morphology), options, &AtomicBool::new(false))
            .expect("meshed")
    }

    #[test]
    fn levels_grow_coarser_and_end_with_the_coarse_mesh() {
        let cell = cell(LevelOptions::default());
        let triangles: Vec<usize> = cell.levels.iter().map(|l| l.triangles.len()).collect();
        assert_eq!(triangles.len(), 4);
        assert!(triangles.is_sorted_by(|a, b| a > b), "{triangles:?}");
        let errors: Vec<f32> = cell.levels.iter().map(|level| level.error).collect();
        assert!(errors.is_sorted() && errors[0] == 0.04, "{errors:?}");
        let placed = cell.placed(DAffine3::from_scale(DVec3::splat(2.0)));
        assert!((placed[0].error - 80.0).abs() < 1e-3);
    }

    #[test]
    fn one_level_is_the_finest() {
        let one = LevelOptions {
            count: 1,
            ..LevelOptions::default()
        };
        let (one, four) = (cell(one), cell(LevelOptions::default()));
        assert_eq!(one.levels.len(), 1);
        assert_eq!(one.levels[0].triangles, four.levels[0].triangles);
    }
}
