//! Pictures of any size, band by band. Where nothing shows, there are no tiles.

use neurotess_picture::color::{ColorTable, linear};
use neurotess_picture::{Image, PictureOptions, Viewpoint, Watch};
use rayon::prelude::*;

use crate::bands::{Band, Setup};
use crate::bytes;
use crate::cost::{Cost, Counts, PictureError};
use crate::fragment::Held;
use crate::geometry::{self, Job, shared_colors};
use crate::grid::{Grid, IN_TILE, TILE};
use crate::occlusion::{LitTile, Occlusion, Shares};
use crate::painting::{Colors, Painting};
use crate::sample::Surface;
use crate::scene::Scene;
use crate::triangle::{Drawn, Tile, rasterize};

/// Patches of instances that are on the grid at once: their triangles take 100 MB or so.
const MAX_BATCH: usize = 1 << 17;

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
    let painter = Painter::new(scene, view, table, options, watch);
    painter.by_bands(|band, cost| {
        let image = painter.drawn(band, cost).ok_or(PictureError::Stopped)?;
        take(band.rows.start, image).map_err(PictureError::Sink)
    })
}

/// Draws the bands of a picture.
pub(crate) struct Painter<'a> {
    pub(crate) scene: &'a Scene<'a>,
    pub(crate) view: &'a Viewpoint,
    pub(crate) table: &'a ColorTable,
    pub(crate) options: &'a PictureOptions,
    pub(crate) setup: Setup,
    pub(crate) watch: &'a Watch,
    counts: Counts,
}

impl<'a> Painter<'a> {
    pub(crate) fn new(
        scene: &'a Scene<'a>,
        view: &'a Viewpoint,
        table: &'a ColorTable,
        options: &'a PictureOptions,
        watch: &'a Watch,
    ) -> Self {
        Self {
            scene,
            view,
            table,
            options,
            setup: Setup::new(view, options),
            watch,
            counts: Counts::default(),
        }
    }

    /// Calls `each` with the bands from the top; returns what they took.
    pub(crate) fn by_bands<E>(
        &self,
        mut each: impl FnMut(&Band, &mut Cost) -> Result<(), PictureError<E>>,
    ) -> Result<Cost, PictureError<E>> {
        let mut cost = Cost::default();
        for band in self.setup.bands() {
            each(&band, &mut cost)?;
            self.watch.note_tile();
            cost.bands += 1;
        }
        self.counts.add_to(&mut cost);
        Ok(cost)
    }

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
            let drawn = batch
                .par_iter()
                .map(|job| geometry::drawn(scene, job, &painting, &self.counts));
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

    /// Samples, lit.
    pub(crate) fn lit<H: Held, const S: usize>(
        &self,
        grid: &Grid,
        tiles: &[Option<Tile<H, S>>],
    ) -> Vec<Option<LitTile>> {
        let Setup {
            projection, lights, ..
        } = &self.setup;
        let lit = |(index, tile): (usize, &Option<Tile<H, S>>)| {
            let tile = tile.as_ref().filter(|_| !self.watch.is_stopped())?;
            let corner = grid.corner(index);
            let mut made = LitTile::new();
            let is_kept = grid.is_kept(index);
            for place in 0..IN_TILE {
                if tile.is_empty(place) {
                    continue;
                }
                if !is_kept {
                    let solid = |&(_, held): &(f32, &H)| !held.surface().is_translucent();
                    if let Some((near, _)) = tile.covered(place).find(solid) {
                        made.depths[place] = kept_depth(projection.depth(near));
                    }
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
                            lights.colored(surface, &on, to_eye)
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
                    made.depths[place] = kept_depth(depth);
                    made.normals[place] = normal;
                }
            }
            Some(made)
        };
        tiles.par_iter().enumerate().map(lit).collect()
    }

    /// The pixels of a band; none if it was stopped. Not generic, so that it is compiled here, as this crate is.
    fn drawn(&self, band: &Band, cost: &mut Cost) -> Option<Image> {
        match self.setup.many_samples {
            true => self.image::<4>(band, cost),
            false => self.image::<1>(band, cost),
        }
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
        if self.watch.is_stopped() {
            return None;
        }
        let shares = self.shares(grid, &lit);
        if self.watch.is_stopped() {
            return None;
        }
        Some(self.gathered(band, &lit, shares.as_ref()))
    }

    /// Pixels of sub-pixels.
    fn gathered(&self, band: &Band, lit: &[Option<LitTile>], shares: Option<&Shares>) -> Image {
        let Setup { size, scale, .. } = self.setup;
        let background = self.options.background;
        let empty = background.map_or([0; 4], |[r, g, b]| [r, g, b, 255]);
        let behind = background.map(linear);
        let mut image = Image::filled(size[0], band.rows.len() as u32, empty);
        let row_bytes = 4 * size[0] as usize;
        let share = 1.0 / (scale * scale) as f32;
        let rows = image.pixels.par_chunks_mut(row_bytes);
        let gather = |(row, y): (&mut [u8], u32)| {
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

/// A depth that is not 0, which stands for nothing.
fn kept_depth(depth: f32) -> f32 {
    if depth == 0.0 { 1e-20 } else { depth }
}

/// The sub-pixel at a place of a tile.
pub(crate) fn pixel_at(corner: [i32; 2], place: usize) -> [i32; 2] {
    let place = place as i32;
    [corner[0] + place % TILE, corner[1] + place / TILE]
}
