//! Pictures of any size, band by band.
//!
//! A **band** is as many rows of pixels as memory allows. What it is drawn of reaches beyond it as far as ambient
//! occlusion does, so that bands fit together; where nothing shows, there are no tiles.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use neurotess_mesh::Surface as _;
use neurotess_picture::color::{ColorTable, linear};
use neurotess_picture::{Image, LARGEST, PictureOptions, Viewpoint, Watch};
use neurotess_refine::{HIGHEST_LEVEL, Refinement};
use rayon::prelude::*;
use thiserror::Error;

use crate::bytes;
use crate::geometry::{self, Colors, Job, Painting, shared_colors};
use crate::grid::{Grid, IN_TILE, TILE};
use crate::light::Lights;
use crate::occlusion::{BLUR, LitTile, Occlusion, Shares};
use crate::projection::Projection;
use crate::sample::{Held, Surface};
use crate::scene::Scene;
use crate::triangle::{Drawn, Tile, rasterize};

/// Why a picture was not made.
#[derive(Debug, Error)]
pub enum PictureError<E> {
    /// The function that takes the bands returned an error.
    #[error("{0}")]
    Sink(E),
    /// It was stopped by a [`Watch`].
    #[error("stopped")]
    Stopped,
}

/// What a picture took, and what it shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cost {
    /// Milliseconds from the beginning to the last byte.
    pub cpu_ms: f64,
    /// Number of bands.
    pub bands: usize,
    /// Most bytes of samples at once.
    pub sample_bytes: u64,
    /// Patches that are drawn, and vertices and triangles that they are refined to; what several bands show counts in each.
    pub patches: u64,
    /// Vertices.
    pub vertices: u64,
    /// Triangles.
    pub triangles: u64,
    /// By level: sides of drawn patches.
    pub levels: BTreeMap<u32, u64>,
}

/// Counts what is drawn.
pub(crate) struct Counts {
    patches: AtomicU64,
    vertices: AtomicU64,
    triangles: AtomicU64,
    levels: [AtomicU64; HIGHEST_LEVEL as usize + 1],
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            patches: AtomicU64::default(),
            vertices: AtomicU64::default(),
            triangles: AtomicU64::default(),
            levels: [const { AtomicU64::new(0) }; HIGHEST_LEVEL as usize + 1],
        }
    }
}

impl Counts {
    pub(crate) fn add(&self, shown: &[bool], refinement: &Refinement<'_>) {
        let add = |to: &AtomicU64, count: usize| to.fetch_add(count as u64, Ordering::Relaxed);
        let shown = || shown.iter().enumerate().filter(|(_, shown)| **shown);
        add(&self.patches, shown().count());
        add(&self.vertices, refinement.vertex_count());
        add(&self.triangles, refinement.triangle_count());
        let mut levels = [0; HIGHEST_LEVEL as usize + 1];
        for (patch, _) in shown() {
            for level in refinement.patch_levels(patch) {
                levels[level as usize] += 1;
            }
        }
        for (to, count) in self.levels.iter().zip(levels) {
            add(to, count);
        }
    }

    /// Adds what was counted.
    pub(crate) fn add_to(self, cost: &mut Cost) {
        cost.patches = self.patches.into_inner();
        cost.vertices = self.vertices.into_inner();
        cost.triangles = self.triangles.into_inner();
        let levels = (0..).zip(self.levels.map(AtomicU64::into_inner));
        cost.levels = levels.filter(|(_, sides)| *sides > 0).collect();
    }
}

/// Most sub-pixels of a band, with what is around it: samples of all of them would take 800 MB, of a cell's a tenth.
const MAX_BAND: u64 = 1 << 24;
/// Patches of instances that are on the grid at once: their triangles take 100 MB or so.
const MAX_BATCH: usize = 1 << 17;

/// Rows of pixels that are drawn at once.
pub(crate) struct Band {
    /// Rows of pixels.
    pub(crate) rows: Range<u32>,
    pub(crate) grid: Grid,
}

/// How a picture is divided and finished.
pub(crate) struct Setup {
    pub(crate) size: [u32; 2],
    /// Sub-pixels per pixel, along one side.
    pub(crate) scale: u32,
    pub(crate) many_samples: bool,
    /// Radius of occlusion: µm, and most sub-pixels.
    pub(crate) occlusion: Option<(f32, f32)>,
    pub(crate) projection: Projection,
    pub(crate) lights: Lights,
}

impl Setup {
    pub(crate) fn new(view: &Viewpoint, options: &PictureOptions) -> Self {
        let many_samples = options.samples_in_sub_pixel() > 1;
        let scale = options.sub_pixels(options.samples_in_sub_pixel());
        let size = options.size.map(|n| n.clamp(1, LARGEST));
        Self {
            size,
            scale,
            many_samples,
            occlusion: options.occlusion.reach(&view.camera, size[1] * scale),
            projection: Projection::new(view, options, scale),
            lights: Lights::new(&options.look),
        }
    }

    /// Sub-pixels around a band that what is in it depends on.
    fn margin(&self) -> i32 {
        self.occlusion.map_or(0, |(_, most)| most as i32 + BLUR + 2)
    }

    /// The bands from above.
    pub(crate) fn bands(&self) -> Vec<Band> {
        let margin = self.margin();
        let [width, height] = self.size;
        let scale = self.scale as i32;
        let across = -margin..width as i32 * scale + margin;
        let rows = (MAX_BAND / across.len() as u64) as i64 - 2 * i64::from(margin);
        // At least a row of tiles, lest most of what is drawn is around.
        let step = (rows / i64::from(scale))
            .max(i64::from(TILE / scale))
            .max(1) as usize;
        (0..height)
            .step_by(step)
            .map(|top| {
                let rows = top..height.min(top + step as u32);
                let down = rows.start as i32 * scale - margin..rows.end as i32 * scale + margin;
                Band {
                    rows,
                    grid: Grid::new([across.clone(), down], self.many_samples),
                }
            })
            .collect()
    }
}

/// Number of bands of a picture.
pub fn bands(view: &Viewpoint, options: &PictureOptions) -> usize {
    Setup::new(view, options).bands().len()
}

/// Draws a picture and calls `take` with its bands from the top: the first row of each, and its pixels.
///
/// The bytes are the same on every machine and with any number of threads.
///
/// # Errors
/// `take` returns an error, or the watch has stopped the picture.
pub fn draw<E>(
    scene: &Scene<'_>,
    view: &Viewpoint,
    table: &ColorTable,
    options: &PictureOptions,
    watch: &Watch,
    mut take: impl FnMut(u32, Image) -> Result<(), E>,
) -> Result<Cost, PictureError<E>> {
    let clock = Instant::now();
    let setup = Setup::new(view, options);
    let mut cost = Cost::default();
    let counts = Counts::default();
    for band in setup.bands() {
        let painter = Painter {
            scene,
            view,
            table,
            options,
            setup: &setup,
            watch,
            counts: &counts,
        };
        let image = match setup.many_samples {
            true => painter.image::<4>(&band, &mut cost),
            false => painter.image::<1>(&band, &mut cost),
        };
        let image = image.ok_or(PictureError::Stopped)?;
        watch.note_tile();
        cost.bands += 1;
        take(band.rows.start, image).map_err(PictureError::Sink)?;
    }
    cost.cpu_ms = clock.elapsed().as_secs_f64() * 1e3;
    counts.add_to(&mut cost);
    Ok(cost)
}

/// Draws a band.
pub(crate) struct Painter<'a> {
    pub(crate) scene: &'a Scene<'a>,
    pub(crate) view: &'a Viewpoint,
    pub(crate) table: &'a ColorTable,
    pub(crate) options: &'a PictureOptions,
    pub(crate) setup: &'a Setup,
    pub(crate) watch: &'a Watch,
    pub(crate) counts: &'a Counts,
}

impl Painter<'_> {
    /// The samples of a band; none if it was stopped.
    pub(crate) fn samples<H: Held, const S: usize>(
        &self,
        grid: &Grid,
    ) -> Option<Vec<Option<Tile<H, S>>>> {
        let Self { scene, setup, .. } = self;
        let look = &self.options.look;
        let colors = Colors::new(self.table, look);
        let painting = Painting {
            view: *self.view,
            size: setup.size.map(|n| n * setup.scale),
            scale: setup.scale,
            grid,
            projection: &setup.projection,
            look,
            colors: &colors,
            wire: 0.5 * look.wire * setup.scale as f32,
            watch: self.watch,
        };
        let mut tiles: Vec<Option<Tile<H, S>>> = (0..grid.len()).map(|_| None).collect();
        let shared = shared_colors(scene, &colors);
        let shown = scene.instances.iter().zip(0..).filter(|(i, _)| !i.hidden);
        let jobs: Vec<Job<'_>> = shown
            .map(|(instance, number)| Job {
                number,
                instance,
                shared: shared[instance.template.0 as usize].as_deref(),
            })
            .collect();
        let mut rest = &jobs[..];
        while !rest.is_empty() {
            let mut patches = 0;
            let together = rest.iter().take_while(|job| {
                let before = patches;
                patches += scene.patches_of(job.instance);
                before < MAX_BATCH
            });
            let (batch, others) = rest.split_at(together.count());
            rest = others;
            let drawn = batch.par_iter().map(|job| {
                (!self.watch.is_stopped())
                    .then(|| geometry::drawn(scene, job, &painting, self.counts))
                    .flatten()
            });
            let drawn: Vec<Drawn<'_>> = drawn.flatten().collect();
            if self.watch.is_stopped() {
                return None;
            }
            rasterize(&mut tiles, grid, &drawn, self.watch);
        }
        if let Some(markers) = scene.markers {
            rasterize(&mut tiles, grid, &markers.drawn(&painting), self.watch);
        }
        for (mesh, number) in scene.meshes.iter().zip(0..) {
            if self.watch.is_stopped() {
                return None;
            }
            let drawn: Vec<Drawn<'_>> = mesh.drawn(number, &painting).into_iter().collect();
            rasterize(&mut tiles, grid, &drawn, self.watch);
        }
        (!self.watch.is_stopped()).then_some(tiles)
    }

    /// The share of light that reaches each sub-pixel of tiles; none without occlusion.
    pub(crate) fn shares(&self, grid: &Grid, lit: &[Option<LitTile>]) -> Option<Shares> {
        let (radius, most) = self.setup.occlusion?;
        let occlusion = Occlusion {
            grid,
            projection: &self.setup.projection,
            tiles: lit,
            radius,
            most,
            watch: self.watch,
        };
        Some(occlusion.shares())
    }

    /// Samples, lit; if it is stopped, not of all tiles.
    pub(crate) fn lit<H: Held, const S: usize>(
        &self,
        grid: &Grid,
        tiles: &[Option<Tile<H, S>>],
    ) -> Vec<Option<LitTile>> {
        let Setup {
            projection, lights, ..
        } = self.setup;
        let lit = |(index, tile): (usize, &Option<Tile<H, S>>)| {
            let tile = tile.as_ref().filter(|_| !self.watch.is_stopped())?;
            let corner = grid.corner(index);
            let mut made = LitTile::new();
            for place in 0..IN_TILE {
                if tile.is_empty(place) {
                    continue;
                }
                let to_eye = projection.eye_from(pixel_at(corner, place));
                let mut sum = [0.0; 4];
                let mut solid = None;
                // Samples of one sub-pixel are mostly of one triangle.
                let mut last: Option<(Surface, [f32; 3])> = None;
                for (near, held) in tile.covered(place) {
                    let surface = held.surface();
                    let known = last.filter(|(same, _)| *same == surface);
                    let light = match known {
                        Some((_, light)) => light,
                        None => {
                            let on = lights.on(surface, to_eye);
                            // The first sample that something solid covers stands for its sub-pixel.
                            if solid.is_none() && !surface.is_translucent() {
                                solid = Some((projection.depth(near), on.normal));
                            }
                            lights.colored(surface, &on)
                        }
                    };
                    last = Some((surface, light));
                    for k in 0..3 {
                        sum[k] += light[k] * (1.0 / S as f32);
                    }
                    sum[3] += 1.0 / S as f32;
                }
                made.colors[place] = sum;
                if let Some((depth, normal)) = solid {
                    made.depths[place] = if depth == 0.0 { 1e-20 } else { depth };
                    made.normals[place] = normal;
                }
            }
            Some(made)
        };
        tiles.par_iter().enumerate().map(lit).collect()
    }

    /// The pixels of a band; none if it was stopped.
    fn image<const S: usize>(&self, band: &Band, cost: &mut Cost) -> Option<Image> {
        let grid = &band.grid;
        let tiles = self.samples::<Surface, S>(grid)?;
        let held = tiles.iter().flatten().count() as u64;
        let bytes = IN_TILE * S * (size_of::<f32>() + size_of::<Surface>());
        cost.sample_bytes = cost.sample_bytes.max(held * bytes as u64);
        let lit = self.lit(grid, &tiles);
        drop(tiles);
        let shares = self.shares(grid, &lit);
        if self.watch.is_stopped() {
            return None;
        }
        let image = self.gathered(band, &lit, shares.as_ref());
        (!self.watch.is_stopped()).then_some(image)
    }

    /// Pixels of sub-pixels; if it is stopped, not of all.
    fn gathered(&self, band: &Band, lit: &[Option<LitTile>], shares: Option<&Shares>) -> Image {
        let Setup { size, scale, .. } = *self.setup;
        let background = self.options.background;
        let empty = background.map_or([0; 4], |[r, g, b]| [r, g, b, 255]);
        let behind = background.map(linear);
        let mut image = Image::filled(size[0], band.rows.len() as u32, empty);
        let row_bytes = 4 * size[0] as usize;
        let share = 1.0 / (scale * scale) as f32;
        let rows = image.pixels.par_chunks_mut(row_bytes);
        let gather = |(row, y): (&mut [u8], u32)| {
            if self.watch.is_stopped() {
                return;
            }
            let mut sums = vec![[0.0_f32; 4]; size[0] as usize];
            for sub_y in y * scale..(y + 1) * scale {
                band.grid
                    .along_row(sub_y as i32, size[0] * scale, |tile, first, places| {
                        let Some(lit) = &lit[tile] else { return };
                        let shares = shares.and_then(|shares| shares[tile].as_ref());
                        for (sub_x, place) in (first..).zip(places) {
                            let color = lit.colors[place];
                            if color[3] == 0.0 {
                                continue;
                            }
                            let light = shares.map_or(1.0, |shares| shares[place]);
                            let sum = &mut sums[(sub_x / scale) as usize];
                            for k in 0..3 {
                                sum[k] += color[k] * light;
                            }
                            sum[3] += color[3];
                        }
                    });
            }
            for (out, sum) in row.chunks_exact_mut(4).zip(sums) {
                if sum[3] > 0.0 {
                    out.copy_from_slice(&bytes::pixel(sum.map(|n| n * share), behind));
                }
            }
        };
        rows.zip(band.rows.clone().into_par_iter()).for_each(gather);
        image
    }
}

/// The sub-pixel at a place of a tile.
pub(crate) fn pixel_at(corner: [i32; 2], place: usize) -> [i32; 2] {
    let place = place as i32;
    [corner[0] + place % TILE, corner[1] + place / TILE]
}
