//! Pictures that are colored anew without being drawn anew. Twin of keyed.wgsl, collect.wgsl and recolor.wgsl; what they
//! hold is in `neurotess_picture::recolor`.

use neurotess_picture::color::{ColorTable, linear};
use neurotess_picture::recolor::{
    Collected, Contrast, Matrix, MatrixBuilder, Weighed, Weights, packed,
};
use neurotess_picture::{
    Image, KeyColors, Look, PictureOptions, Viewpoint, VisibleKey, Watch, edge_color,
};
use rayon::prelude::*;

use crate::bands::{Band, Setup};
use crate::bytes;
use crate::cost::{Cost, PictureError};
use crate::fragment::{Fragment, Held};
use crate::picture::{Painter, pixel_at};
use crate::sample::Surface;
use crate::scene::Scene;
use crate::triangle::Tile;

/// A picture whose colors can be changed.
pub struct StaticPicture {
    size: [u32; 2],
    matrix: Matrix,
    look: Look,
    background: Option<[u8; 3]>,
}

/// A sample with the keys of its color: up to three, each with its share (255ths).
#[derive(Clone, Copy, Debug, Default)]
struct Keyed {
    surface: Surface,
    instance: u32,
    keys: [u32; 3],
    shares: [u8; 3],
}

impl Held for Keyed {
    fn of(fragment: &Fragment<'_>) -> Self {
        let paint = fragment.paint;
        let mut keys = fragment
            .corners
            .map(|corner| paint.keys[corner.point as usize]);
        let mut shares = fragment.inner_shares();
        // Those of equal color keys together, the largest first.
        for k in 0..2 {
            for other in k + 1..3 {
                if keys[other] == keys[k] {
                    shares[k] += shares[other];
                    shares[other] = 0.0;
                }
            }
        }
        for k in 0..2 {
            for other in k + 1..3 {
                if shares[other] > shares[k] {
                    keys.swap(k, other);
                    shares.swap(k, other);
                }
            }
        }
        let [first, second, _] = shares.map(|share| (share * 255.0 + 0.5) as u8);
        let first = first.max(1);
        let second = second.min(255 - first);
        Self {
            surface: fragment.surface(),
            instance: paint.instance,
            keys,
            shares: [first, second, 255 - first - second],
        }
    }

    fn surface(&self) -> Surface {
        self.surface
    }
}

/// Draws a picture that can be colored anew, with the pixels that [`draw`](crate::draw) gives; a wireframe is left out.
/// `table`: colors, which do not matter.
///
/// # Errors
/// The watch has stopped it.
pub fn draw_static(
    scene: &Scene<'_>,
    view: &Viewpoint,
    table: &ColorTable,
    options: &PictureOptions,
    watch: &Watch,
) -> Result<(StaticPicture, Cost), PictureError<std::convert::Infallible>> {
    let painter = Painter::new(scene, view, table, options, watch);
    let mut matrix = MatrixBuilder::default();
    let cost = painter.by_bands(|band, _| {
        let weights = match painter.setup.many_samples {
            true => weights::<4>(&painter, band),
            false => weights::<1>(&painter, band),
        };
        matrix.add(&weights.ok_or(PictureError::Stopped)?, 1);
        Ok(())
    })?;
    let picture = StaticPicture {
        size: painter.setup.size,
        matrix: matrix.finish(),
        look: options.look,
        background: options.background,
    };
    Ok((picture, cost))
}

/// The weights of a band; none if it was stopped.
fn weights<const S: usize>(painter: &Painter<'_>, band: &Band) -> Option<Weights> {
    let grid = &band.grid;
    let tiles = painter.samples::<Keyed, S>(grid)?;
    let lit = painter.lit(grid, &tiles);
    let shares = painter.shares(grid, &lit);
    drop(lit);
    if painter.watch.is_stopped() {
        return None;
    }
    let width = painter.setup.size[0];
    let rows: Vec<Collected> = band
        .rows
        .clone()
        .into_par_iter()
        .map(|y| {
            let mut row = Collected {
                size: [width, 1],
                fixed: vec![[0.0; 2]; width as usize],
                weighed: Vec::new(),
            };
            for x in 0..width {
                let gathering = Gathering {
                    painter,
                    band,
                    tiles: &tiles,
                };
                row.fixed[x as usize] = gathering.pixel(
                    [x, y],
                    |tile, place| {
                        let shares = shares.as_ref().and_then(|shares| shares[tile].as_ref());
                        shares.map_or(1.0, |shares| shares[place])
                    },
                    &mut row.weighed,
                );
            }
            row
        })
        .collect();
    let mut weights = Weights::new([width, band.rows.len() as u32]);
    for (row, y) in rows.iter().zip(0..) {
        weights.add([0, y], row);
    }
    Some(weights)
}

/// Adds up the samples of a pixel.
struct Gathering<'a, const S: usize> {
    painter: &'a Painter<'a>,
    band: &'a Band,
    tiles: &'a [Option<Tile<Keyed, S>>],
}

impl<const S: usize> Gathering<'_, S> {
    /// What does not depend on colors: white, and coverage. `light`: the share that reaches a sub-pixel.
    fn pixel(
        &self,
        [x, y]: [u32; 2],
        light: impl Fn(usize, usize) -> f32,
        weighed: &mut Vec<Weighed>,
    ) -> [f32; 2] {
        let Setup {
            scale,
            projection,
            lights,
            ..
        } = &self.painter.setup;
        let share = 1.0 / (scale * scale * S as u32) as f32;
        let mut fixed = [0.0; 2];
        // Sums of this pixel by key, in the order of first use: mostly one or two.
        let mut sums: Vec<(VisibleKey, [f32; 4])> = Vec::new();
        for sub_y in y * scale..(y + 1) * scale {
            for sub_x in x * scale..(x + 1) * scale {
                let at = self.band.grid.place([sub_x as i32, sub_y as i32]);
                let Some((tile, place)) = at else { continue };
                let Some(samples) = &self.tiles[tile] else {
                    continue;
                };
                if samples.is_empty(place) {
                    continue;
                }
                let reaching = share * light(tile, place);
                let to_eye = projection.eye_from(pixel_at(self.band.grid.corner(tile), place));
                let mut last = None;
                for (_, held) in samples.covered(place) {
                    let (lit, edge) = match last {
                        Some((surface, lit)) if surface == held.surface => lit,
                        _ => {
                            let lit = lights.on(held.surface, to_eye);
                            (lit, lights.edge(held.surface, to_eye))
                        }
                    };
                    last = Some((held.surface, (lit, edge)));
                    fixed[0] += lit.white * reaching;
                    fixed[1] += share;
                    let sum = [lit.factor, lit.factor * edge, lit.white * edge, edge];
                    for (key, part) in held.keys.iter().zip(held.shares) {
                        if part == 0 {
                            continue;
                        }
                        let key = VisibleKey {
                            instance: held.instance,
                            color_key: *key,
                        };
                        let part = reaching * f32::from(part) / 255.0;
                        let known = sums.iter_mut().rev().find(|(known, _)| *known == key);
                        match known {
                            Some((_, to)) => {
                                to.iter_mut().zip(sum).for_each(|(to, n)| *to += n * part);
                            }
                            None => sums.push((key, sum.map(|n| n * part))),
                        }
                    }
                }
            }
        }
        weighed.extend(sums.into_iter().map(|(key, [a, b, c, d])| Weighed {
            pixel: x,
            color_key: key.color_key,
            instance: key.instance,
            low: packed([a, b]),
            high: packed([c, d]),
        }));
        fixed
    }
}

impl StaticPicture {
    /// What shows: each color key of each instance once, in order.
    pub fn keys(&self) -> &[VisibleKey] {
        &self.matrix.keys
    }

    /// The key that most of what shows in a pixel has its color of; none where nothing shows.
    pub fn key_at(&self, [x, y]: [u32; 2]) -> Option<VisibleKey> {
        let [width, height] = self.size;
        if x >= width || y >= height {
            return None;
        }
        let pixel = (y * width + x) as usize;
        let [first, end] = [0, 1].map(|k| self.matrix.rows[pixel + k][0] as usize);
        let weights = self.matrix.weights[first..end].iter();
        let most = weights.max_by_key(|weight| weight.low & 0xffff)?;
        Some(self.matrix.keys[most.color as usize])
    }

    /// Number of weights: of all pixels' color keys.
    pub fn weights(&self) -> usize {
        self.matrix.weights.len()
    }

    /// Bytes of the weights.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.matrix.rows[..]) + size_of_val(&self.matrix.weights[..])) as u64
    }

    /// The picture in these colors.
    ///
    /// # Panics
    /// If there are values, but not one for each key.
    pub fn image(&self, colors: &KeyColors<'_>) -> Image {
        let keys = &self.matrix.keys;
        let values = colors.values;
        assert!(
            values.is_none_or(|values| values.len() == keys.len()),
            "a value for each key"
        );
        let contrast = Contrast::new(&self.look);
        let table = colors.table.linear();
        let color = |(index, key): (usize, &VisibleKey)| {
            let value = values.map(|values| values[index]);
            let color = contrast.key_color(colors.table, &table, key, value);
            let state = colors.states.get(key.instance as usize).copied();
            contrast.in_state(color, state.unwrap_or_default())
        };
        let colored: Vec<[f32; 4]> = keys.par_iter().enumerate().map(color).collect();
        let behind = self.background.map(linear);
        let empty = self.background.map_or([0; 4], |[r, g, b]| [r, g, b, 255]);
        let edge = edge_color(&self.look);
        let [width, height] = self.size;
        let mut image = Image::filled(width, height, empty);
        let pixels = image.pixels.par_chunks_exact_mut(4).with_min_len(4096);
        let rows = self.matrix.rows.par_windows(2).with_min_len(4096);
        pixels.zip(rows).for_each(|(pixel, rows)| {
            let [white, coverage] = unpacked(rows[0][1]);
            if coverage == 0.0 {
                return;
            }
            let mut sum = [white; 3];
            for weight in &self.matrix.weights[rows[0][0] as usize..rows[1][0] as usize] {
                let [r, g, b, lacks] = colored[weight.color as usize];
                let (low, high) = (unpacked(weight.low), unpacked(weight.high));
                let factor = low[0] - lacks * low[1];
                for (k, color) in [r, g, b].into_iter().enumerate() {
                    sum[k] += color * factor + lacks * (edge[k] * high[1] - high[0]);
                }
            }
            let [r, g, b] = sum;
            pixel.copy_from_slice(&bytes::pixel([r, g, b, coverage], behind));
        });
        image
    }
}

/// Two numbers from 0 to 2: see `packed`.
fn unpacked(bits: u32) -> [f32; 2] {
    [bits & 0xffff, bits >> 16].map(|half| half as f32 * (2.0 / 65535.0))
}
