//! Instances on the grid: levels, refined vertices, projection, triangles by tile.

use std::borrow::Cow;

use neurotess_mesh::{Role, SurfaceVertex, TracingPoint};
use neurotess_picture::Instance;
use neurotess_picture::state::{GHOSTED, HIGHLIGHTED, WITHOUT_NEURITES, WITHOUT_SOMA};
use neurotess_refine::{PatchBlock, PointNumbers, RefineOptions, Refinement};
use rayon::prelude::*;

use crate::bins::{Bins, Projected, Triangle, Vertices};
use crate::cost::Counts;
use crate::fragment::Paint;
use crate::painting::{Colors, Painting, Shown, placed_vertex};
use crate::projection::Projection;
use crate::scene::{Scene, SceneTemplate};
use crate::select::{Placed, shown};
use crate::triangle::Drawn;

/// Blocks of a refinement, of some hundred patches each, that a task makes.
const TOGETHER: usize = 32;

/// An instance with its number and the colors that its template has, if they are shared.
pub(crate) struct Job<'a> {
    pub(crate) number: u32,
    pub(crate) instance: &'a Instance,
    pub(crate) shared: Option<&'a [[f32; 4]]>,
}

/// Colors of templates that all their instances share; none where they differ.
pub(crate) fn shared_colors(scene: &Scene<'_>, colors: &Colors<'_>) -> Vec<Option<Vec<[f32; 4]>>> {
    let of = |template: &SceneTemplate<'_>| {
        let keys = keys_of(template);
        (!colors.differ()).then(|| colors.of_keys(&keys, 0, 0))
    };
    scene.templates.par_iter().map(of).collect()
}

/// A color key for each tracing point: missing ones are 0.
fn keys_of<'a>(template: &SceneTemplate<'a>) -> Cow<'a, [u32]> {
    let (keys, points) = (
        template.template.color_keys,
        template.template.mesh.tracing.len(),
    );
    match keys.len() >= points {
        true => Cow::Borrowed(keys),
        false => {
            let mut all = keys.to_vec();
            all.resize(points, 0);
            Cow::Owned(all)
        }
    }
}

/// An instance on the grid; none if nothing of it shows, less of it if the picture is stopped.
pub(crate) fn drawn<'a>(
    scene: &'a Scene<'a>,
    job: &Job<'a>,
    painting: &Painting<'a>,
    counts: &Counts,
) -> Option<Drawn<'a>> {
    if painting.watch.is_stopped() {
        return None;
    }
    let template = &scene.templates[job.instance.template.0 as usize];
    let placed = Placed::new(painting, job.instance, template.template.mesh);
    let shown = shown(template, &placed, painting)?;
    let mesh = template.template.mesh;
    let options = RefineOptions {
        numbers: PointNumbers::OfTracing,
        ..scene.settings.options()
    };
    let lod = placed.lod(&scene.settings, template);
    let refinement = Refinement::of_patches(mesh, lod, &options, &shown);
    counts.add(&shown, &refinement);
    let projection = painting.projection;
    let keys = keys_of(template);
    let colors: Cow<'a, [[f32; 4]]> = match (job.shared, job.instance.state & HIGHLIGHTED) {
        (Some(shared), 0) => Cow::Borrowed(shared),
        _ => Cow::Owned(
            painting
                .colors
                .of_keys(&keys, job.number, job.instance.state),
        ),
    };
    let paint = Paint {
        colors,
        keys,
        instance: job.number,
        sheet: None,
        filled: projection
            .cut_normal()
            .map(|normal| -projection.in_view(normal) * 32767.0),
        wire: painting.wire,
    };
    let making = Making {
        scene,
        keys: &paint.keys,
        placed: &placed,
        projection,
        ghosted: painting.look.ghosted,
        state: job.instance.state,
        tracing: &mesh.tracing,
    };
    let blocks: Vec<usize> = (0..refinement.patch_blocks()).collect();
    let pieces = blocks.par_chunks(TOGETHER).map(|blocks| {
        let mut vertices = Vertices::default();
        let mut bins = Bins::default();
        let mut refined = PatchBlock::default();
        for &block in blocks.iter().filter(|_| !painting.watch.is_stopped()) {
            refinement.patch_block(block, &mut refined);
            let first = vertices.vertices.len() as u32;
            let made = refined.vertices.iter();
            made.for_each(|vertex| vertices.push(making.vertex(vertex)));
            for corners in &refined.faces.triangles {
                let triangle = Triangle {
                    corners: corners.map(|corner| first + corner),
                    is_front: true,
                    is_half: false,
                };
                bins.add(
                    (painting.grid, projection),
                    &vertices,
                    triangle,
                    paint.is_two_sided(),
                );
            }
        }
        bins.finished(vertices, painting.grid.len())
    });
    Some(Drawn {
        pieces: pieces.collect(),
        paint,
        perspective: projection.is_perspective(),
    })
}

/// Makes vertices of an instance.
struct Making<'a> {
    scene: &'a Scene<'a>,
    keys: &'a [u32],
    placed: &'a Placed,
    projection: &'a Projection,
    ghosted: f32,
    state: u32,
    tracing: &'a [TracingPoint],
}

impl Making<'_> {
    fn vertex(&self, refined: &SurfaceVertex) -> Projected {
        let point = refined.point as u32;
        let is_soma = self.tracing[point as usize].role == Role::Soma;
        let radius = if is_soma {
            0.0
        } else {
            refined.radius * self.placed.scale
        };
        let position = self.placed.relative(refined.position);
        let normal = self.placed.turned(refined.normal);
        let widened = self.projection.widened(position, normal, radius);
        let mut coverage = widened.coverage;
        if self.state & GHOSTED != 0 {
            coverage *= self.ghosted;
        }
        // Coverage is interpolated: values far outside 0 to 1 move the border to the ring itself.
        if self.state & WITHOUT_NEURITES != 0 {
            coverage = if is_soma { 1000.0 } else { 0.0 };
        } else if self.state & WITHOUT_SOMA != 0 && is_soma {
            coverage = -1000.0;
        }
        if self.scene.hides(self.keys[point as usize]) {
            coverage = -1000.0;
        }
        let shown = Shown {
            coverage,
            thin: widened.thin,
            point,
        };
        placed_vertex(self.projection, widened.position, normal, shown)
    }
}
