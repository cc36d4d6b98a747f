//! Ambient occlusion from depth and normals, and its blur. Twin of occlusion.wgsl and obscurance.wgsl.
//!
//! Theory: McGuire, Mara & Luebke, Scalable ambient obscurance, HPG 2012.

use glam::{Vec2, Vec3};
use neurotess_picture::Watch;
use rayon::prelude::*;

use crate::grid::{Grid, IN_TILE, TILE};
use crate::projection::Projection;

/// Number of samples that the occlusion of a sub-pixel takes around it.
const TAPS: usize = 14;
/// How dark corners are. Chosen by eye: it shows at forks and where neurites leave the soma, but not on tubes.
const STRENGTH: f32 = 3.0;
/// Sub-pixels that the occlusion is blurred over, to each side: its pattern of turns repeats after four.
pub(crate) const BLUR: i32 = 4;

/// A tile whose samples are lit: by sub-pixel.
pub(crate) struct LitTile {
    /// Linear light, premultiplied.
    pub(crate) colors: Vec<[f32; 4]>,
    /// Depth (µm) of what stands for it; 0: nothing does.
    pub(crate) depths: Vec<f32>,
    /// Its normal.
    pub(crate) normals: Vec<Vec3>,
}

impl LitTile {
    pub(crate) fn new() -> Self {
        Self {
            colors: vec![[0.0; 4]; IN_TILE],
            depths: vec![0.0; IN_TILE],
            normals: vec![Vec3::ZERO; IN_TILE],
        }
    }
}

/// By tile that holds anything: the share of light that reaches each of its sub-pixels.
pub(crate) type Shares = Vec<Option<Vec<f32>>>;

/// Occlusion within a radius (µm) and so many sub-pixels.
pub(crate) struct Occlusion<'a> {
    pub(crate) grid: &'a Grid,
    pub(crate) projection: &'a Projection,
    pub(crate) tiles: &'a [Option<LitTile>],
    pub(crate) radius: f32,
    pub(crate) most: f32,
    pub(crate) watch: &'a Watch,
}

impl Occlusion<'_> {
    /// Shares of light; if it is stopped, not of all tiles.
    pub(crate) fn shares(&self) -> Shares {
        // Where samples are taken, by the turn of the spiral.
        let taps: Vec<[Vec2; TAPS]> = (0..16)
            .map(|turn| {
                let turn = turn as f32 / 16.0;
                std::array::from_fn(|i| {
                    let share = (i as f32 + 0.5 + turn * 0.5) / TAPS as f32;
                    let angle = (i as f32 * 0.618_034 + turn) * 6.283_185_5;
                    Vec2::new(libm::cosf(angle), libm::sinf(angle)) * share
                })
            })
            .collect();
        let raw = self.by_tile(|tile, lit| self.reaching(tile, lit, &taps));
        let rows = self.by_tile(|tile, lit| self.blurred(tile, lit, &raw, true));
        self.by_tile(|tile, lit| self.blurred(tile, lit, &rows, false))
    }

    fn by_tile(&self, of: impl Fn(usize, &LitTile) -> Vec<f32> + Sync) -> Shares {
        let tiles = self.tiles.par_iter().enumerate();
        tiles
            .map(|(tile, lit)| {
                let lit = lit.as_ref().filter(|_| !self.watch.is_stopped());
                lit.map(|lit| of(tile, lit))
            })
            .collect()
    }

    fn depth(&self, pixel: [i32; 2]) -> f32 {
        let Some((tile, place)) = self.grid.place(pixel) else {
            return 0.0;
        };
        match &self.tiles[tile] {
            Some(lit) => lit.depths[place],
            None => 0.0,
        }
    }

    fn reaching(&self, tile: usize, lit: &LitTile, taps: &[[Vec2; TAPS]]) -> Vec<f32> {
        let corner = self.grid.corner(tile);
        let mut shares = vec![1.0; IN_TILE];
        for (place, (&depth, &normal)) in lit.depths.iter().zip(&lit.normals).enumerate() {
            if depth == 0.0 {
                continue;
            }
            let place_in_tile = [place as i32 % TILE, place as i32 / TILE];
            let pixel = [0, 1].map(|k| corner[k] + place_in_tile[k]);
            let center = self.projection.middle(pixel, depth);
            let sub_pixel = self.projection.sub_pixel(depth);
            let reach = (self.radius / sub_pixel).min(self.most);
            let radius = reach * sub_pixel;
            // One of 16 turns of the spiral, so that neighboring sub-pixels, which the blur averages, sample different
            // directions.
            let [x, y] = pixel.map(|n| (n + 65536) as u32);
            let turn = (x & 3) + 4 * ((y & 3) ^ ((x & 1) << 1));
            let mut sum = 0.0;
            for tap in &taps[turn as usize] {
                let offset = *tap * reach;
                let other = [pixel[0] + rounded(offset.x), pixel[1] + rounded(offset.y)];
                let there = self.depth(other);
                if there == 0.0 {
                    continue;
                }
                let away = self.projection.middle(other, there) - center;
                let distance = away.length();
                let rise = (away.dot(normal) / distance.max(1e-20) - 0.12).max(0.0);
                // Up to twice the radius, since things that are closer to the eye also occlude.
                let far = (distance / (2.0 * radius)).min(1.0);
                sum += rise * (1.0 - far * far);
            }
            shares[place] = (1.0 - STRENGTH * sum / TAPS as f32).max(0.0);
        }
        shares
    }

    /// Blurs along rows or columns; stops where the depth jumps.
    fn blurred(&self, tile: usize, lit: &LitTile, from: &Shares, along_rows: bool) -> Vec<f32> {
        const AROUND: usize = (TILE + 2 * BLUR) as usize;
        let corner = self.grid.corner(tile);
        let mut out = vec![1.0; IN_TILE];
        // Depth and share along a line of the tile and a little beyond.
        let mut line = [(0.0_f32, 1.0_f32); AROUND];
        for row in 0..TILE {
            let place = |along: i32| match along_rows {
                true => (row * TILE + along) as usize,
                false => (along * TILE + row) as usize,
            };
            if (0..TILE).all(|along| lit.depths[place(along)] == 0.0) {
                continue;
            }
            for (k, entry) in (-BLUR..).zip(&mut line) {
                let pixel = match along_rows {
                    true => [corner[0] + k, corner[1] + row],
                    false => [corner[0] + row, corner[1] + k],
                };
                *entry = match self.grid.place(pixel) {
                    Some((tile, place)) => match (&self.tiles[tile], &from[tile]) {
                        (Some(lit), Some(shares)) => (lit.depths[place], shares[place]),
                        _ => (0.0, 1.0),
                    },
                    None => (0.0, 1.0),
                };
            }
            for along in 0..TILE {
                let (depth, _) = line[(along + BLUR) as usize];
                if depth == 0.0 {
                    continue;
                }
                let farthest = self.most * self.projection.sub_pixel(depth);
                let inverse = 1.0 / (0.3 * self.radius.min(farthest));
                let (mut sum, mut weights) = (0.0, 0.0);
                for k in 0..=2 * BLUR {
                    let (other, share) = line[(along + k) as usize];
                    let alike = match other == 0.0 {
                        true => 0.0,
                        false => (1.0 - (other - depth).abs() * inverse).max(0.0),
                    };
                    let weight = alike * (BLUR + 1 - (k - BLUR).abs()) as f32;
                    sum += weight * share;
                    weights += weight;
                }
                out[place(along)] = sum / weights;
            }
        }
        out
    }
}

/// The nearest whole number, the even one of two, of numbers below 2²²: what is added leaves no room for fractions.
fn rounded(x: f32) -> i32 {
    const SHIFT: f32 = 12_582_912.0;
    ((x + SHIFT) - SHIFT) as i32
}
