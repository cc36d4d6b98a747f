//! Instances on the grid: levels, refined vertices, projection, triangles by tile.

use std::borrow::Cow;

use glam::Vec3;
use neurotess_mesh::{Role, SurfaceVertex, TracingPoint};
use neurotess_picture::color::ColorTable;
use neurotess_picture::state::{GHOSTED, HIGHLIGHTED, WITHOUT_NEURITES, WITHOUT_SOMA};
use neurotess_picture::{Frame, Instance, Look, Tile, Viewpoint, Watch};
use neurotess_refine::{PatchBlock, PointNumbers, RefineOptions, Refinement};
use rayon::prelude::*;

use crate::bins::{Bins, Projected, Triangle, Vertex, Vertices};
use crate::fragment::Paint;
use crate::grid::Grid;
use crate::picture::Counts;
use crate::projection::Projection;
use crate::scene::{Scene, SceneTemplate};
use crate::select::{Placed, shown};
use crate::triangle::Drawn;

/// Instance of what is no neuron: beyond all instances, so it has neither values nor a state.
pub(crate) const NO_INSTANCE: u32 = u32::MAX - 1;
/// Blocks of a refinement, of some hundred patches each, that a task makes.
const TOGETHER: usize = 32;

/// How a band is drawn.
pub(crate) struct Painting<'a> {
    pub(crate) view: Viewpoint,
    /// Width and height (sub-pixels) of the whole picture.
    pub(crate) size: [u32; 2],
    /// Sub-pixels per pixel, along one side.
    pub(crate) scale: u32,
    pub(crate) grid: &'a Grid,
    pub(crate) projection: &'a Projection,
    pub(crate) look: &'a Look,
    pub(crate) colors: &'a Colors<'a>,
    /// Half the width (sub-pixels) of the wireframe's lines; 0: none.
    pub(crate) wire: f32,
    /// What can stop it.
    pub(crate) watch: &'a Watch,
}

impl Painting<'_> {
    /// What is drawn, as a tile of the whole picture.
    pub(crate) fn frame(&self) -> Frame {
        let [across, down] = &self.grid.drawn;
        Frame {
            tile: Tile {
                x: across.start,
                y: down.start,
                width: across.len() as u32,
                height: down.len() as u32,
            },
            ..Frame::whole(self.view.camera, self.view.near, self.size)
        }
    }
}

/// Linear colors of color keys.
pub(crate) struct Colors<'a> {
    table: &'a ColorTable,
    linear: Vec<[f32; 4]>,
    highlighted: [f32; 4],
}

impl<'a> Colors<'a> {
    pub(crate) fn new(table: &'a ColorTable, look: &Look) -> Self {
        let [r, g, b] = neurotess_picture::color::linear(look.highlighted.0);
        Self {
            table,
            linear: table.linear(),
            highlighted: [r, g, b, look.highlighted.1],
        }
    }

    /// Whether instances of one template have other colors.
    fn differ(&self) -> bool {
        self.table.values.instances() > 0
    }

    /// Of these keys of an instance in a state; in the last place 1 for colors of the scale.
    pub(crate) fn of_keys(&self, keys: &[u32], instance: u32, state: u32) -> Vec<[f32; 4]> {
        let color = |&key: &u32| {
            let (color, of_scale) = self.table.color(&self.linear, key, instance, None);
            let [r, g, b] = match state & HIGHLIGHTED {
                0 => color,
                _ => {
                    let [x, y, z, share] = self.highlighted;
                    let to = [x, y, z];
                    [0, 1, 2].map(|k| color[k] + (to[k] - color[k]) * share)
                }
            };
            [r, g, b, if of_scale { 1.0 } else { 0.0 }]
        };
        keys.iter().map(color).collect()
    }
}

/// A vertex of something that is never widened.
pub(crate) fn vertex(
    projection: &Projection,
    position: Vec3,
    normal: Vec3,
    point: u32,
) -> Projected {
    let look = Shown {
        coverage: 1.0,
        thin: 0.0,
        point,
    };
    placed_vertex(projection, position, normal, look)
}

#[derive(Clone, Copy)]
struct Shown {
    coverage: f32,
    thin: f32,
    point: u32,
}

fn placed_vertex(projection: &Projection, position: Vec3, normal: Vec3, shown: Shown) -> Projected {
    let at = projection.in_view(position);
    let [x, y, z] = (projection.in_view(normal) * 32767.0).to_array();
    let mut vertex = Vertex {
        coverage: shown.coverage,
        kept: projection.kept(position),
        normal: [x, y, z].map(|n| n as i16),
        thin: (shown.thin * 255.0) as u8,
        point: shown.point,
        ..Vertex::default()
    };
    match projection.place(at) {
        Some(place) => {
            vertex.place = place;
            Projected::Before(vertex)
        }
        None => Projected::Behind(at, vertex),
    }
}

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

/// An instance on the grid; none if nothing of it shows.
pub(crate) fn drawn<'a>(
    scene: &'a Scene<'a>,
    job: &Job<'a>,
    painting: &Painting<'a>,
    counts: &Counts,
) -> Option<Drawn<'a>> {
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
    let making = Making {
        placed: &placed,
        projection,
        ghosted: painting.look.ghosted,
        state: job.instance.state,
        tracing: &mesh.tracing,
    };
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
    let blocks: Vec<usize> = (0..refinement.patch_blocks()).collect();
    let pieces = blocks.par_chunks(TOGETHER).map(|blocks| {
        let mut vertices = Vertices::default();
        let mut bins = Bins::default();
        let mut refined = PatchBlock::default();
        for &block in blocks {
            if painting.watch.is_stopped() {
                break;
            }
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
        let shown = Shown {
            coverage,
            thin: widened.thin,
            point,
        };
        placed_vertex(self.projection, widened.position, normal, shown)
    }
}
