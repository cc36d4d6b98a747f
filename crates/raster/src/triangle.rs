//! From triangles to samples.

use neurotess_picture::Watch;
use rayon::prelude::*;

use crate::bins::{Piece, Triangle, Vertex};
use crate::fragment::{Fragment, Paint, lines, mask_of};
use crate::grid::{Grid, IN_TILE, TILE};
use crate::projection::STEPS;
use crate::sample::Held;

/// Places of four samples in a sub-pixel (steps), those of GPUs; one sample is in the middle.
const FOUR: [[i32; 2]; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];
/// Largest side (steps) of a triangle whose edge functions fit 32 bits everywhere around it.
const SMALL: i32 = 64 * STEPS;

/// Nearness of nothing. Not 0: memory that is full of zeros is there only when it is written to, and being read before
/// takes the system twice as long.
const NOTHING: f32 = -1.0;

/// Samples of a tile, `S` of each sub-pixel.
pub(crate) struct Tile<H, const S: usize> {
    /// [`NOTHING`] where nothing is.
    pub(crate) nearness: Vec<[f32; S]>,
    pub(crate) held: Vec<[H; S]>,
}

impl<H: Held, const S: usize> Tile<H, S> {
    /// Whether nothing covers a sub-pixel.
    pub(crate) fn is_empty(&self, place: usize) -> bool {
        self.nearness[place].iter().all(|&near| near < 0.0)
    }

    /// The samples of a sub-pixel that something covers: how near it is, and what is held of it.
    pub(crate) fn covered(&self, place: usize) -> impl Iterator<Item = (f32, &H)> {
        let samples = self.nearness[place].iter().zip(&self.held[place]);
        let covered = samples.filter(|(near, _)| **near >= 0.0);
        covered.map(|(&near, held)| (near, held))
    }

    fn new() -> Self {
        Self {
            nearness: vec![[NOTHING; S]; IN_TILE],
            held: vec![[H::default(); S]; IN_TILE],
        }
    }
}

/// A surface on the grid.
pub(crate) struct Drawn<'a> {
    pub(crate) pieces: Vec<Piece>,
    pub(crate) paint: Paint<'a>,
    /// Whether what is linear in space is divided by depth on the grid.
    pub(crate) perspective: bool,
}

/// Draws surfaces into the tiles of a grid, until it is stopped. Tiles get memory when a triangle first meets them.
pub(crate) fn rasterize<H: Held, const S: usize>(
    tiles: &mut [Option<Tile<H, S>>],
    grid: &Grid,
    surfaces: &[Drawn<'_>],
    watch: &Watch,
) {
    tiles.par_iter_mut().enumerate().for_each(|(index, slot)| {
        let corner = grid.corner(index);
        for surface in surfaces {
            if watch.is_stopped() {
                return;
            }
            for piece in &surface.pieces {
                for triangle in piece.of_tile(index as u32) {
                    let tile = slot.get_or_insert_with(Tile::new);
                    let corners = piece.corners(triangle);
                    Rasterizer {
                        corner,
                        grid,
                        surface,
                        triangle,
                        corners,
                    }
                    .draw(tile);
                }
            }
        }
    });
}

/// A triangle and the tile that it is drawn into.
struct Rasterizer<'a> {
    corner: [i32; 2],
    grid: &'a Grid,
    surface: &'a Drawn<'a>,
    triangle: &'a Triangle,
    corners: [&'a Vertex; 3],
}

/// Whole numbers in which edge functions are computed.
trait Whole: Copy {
    fn of(n: i32) -> Self;
    fn times(self, other: Self) -> Self;
    fn plus(self, other: Self) -> Self;
    fn is_negative(self) -> bool;
    fn float(self) -> f32;
}

macro_rules! whole {
    ($type:ty) => {
        impl Whole for $type {
            #[inline(always)]
            fn of(n: i32) -> Self {
                n as $type
            }
            #[inline(always)]
            fn times(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self + other
            }
            #[inline(always)]
            fn is_negative(self) -> bool {
                self < 0
            }
            #[inline(always)]
            fn float(self) -> f32 {
                self as f32
            }
        }
    };
}
whole!(i32);
whole!(i64);

impl Rasterizer<'_> {
    fn draw<H: Held, const S: usize>(&self, tile: &mut Tile<H, S>) {
        let x = self.corners.map(|corner| corner.place.x);
        let y = self.corners.map(|corner| corner.place.y);
        let (left, right) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        let (upper, lower) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        let range = |low: i32, high: i32, k: usize| {
            let low = low.div_euclid(STEPS).max(self.corner[k]);
            let last = (self.corner[k] + TILE).min(self.grid.drawn[k].end) - 1;
            [low, high.div_euclid(STEPS).min(last)]
        };
        let box_ = [range(left, right, 0), range(upper, lower, 1)];
        match right - left < SMALL && lower - upper < SMALL {
            true => self.scan::<H, S, i32>(tile, [x, y], box_),
            false => self.scan::<H, S, i64>(tile, [x, y], box_),
        }
    }

    /// Goes over the sub-pixels of a box. Edge i is across from corner i, and a sample is inside where all three edge
    /// functions are not negative; on an edge by the top-left rule. All is relative to corners, so that it is the same
    /// whatever the tile.
    #[inline(always)]
    fn scan<H: Held, const S: usize, W: Whole>(
        &self,
        tile: &mut Tile<H, S>,
        [x, y]: [[i32; 3]; 2],
        [across, down]: [[i32; 2]; 2],
    ) {
        let mut by_x = [W::of(0); 3];
        let mut by_y = [W::of(0); 3];
        let mut bias = [W::of(0); 3];
        let mut first = [W::of(0); 3];
        for i in 0..3 {
            let (p, q) = ((i + 1) % 3, (i + 2) % 3);
            let (dx, dy) = (x[q] - x[p], y[q] - y[p]);
            by_x[i] = W::of(-dy);
            by_y[i] = W::of(dx);
            let is_top_left = dy < 0 || (dy == 0 && dx > 0);
            bias[i] = W::of(if is_top_left { 0 } else { -1 });
            let along = W::of(down[0] * STEPS - y[p]).times(W::of(dx));
            first[i] = along.plus(W::of(across[0] * STEPS - x[p]).times(W::of(-dy)));
        }
        let [ax, ay] = [x[1] - x[0], y[1] - y[0]];
        let [bx, by] = [x[2] - x[0], y[2] - y[0]];
        let area = i64::from(ax) * i64::from(by) - i64::from(ay) * i64::from(bx);
        let inverse = 1.0 / area as f32;
        let near = self.corners.map(|corner| corner.place.nearness);
        // Nearness as a plane through corner 0.
        let slope = |k: [W; 3]| {
            ((near[1] - near[0]) * k[1].float() + (near[2] - near[0]) * k[2].float()) * inverse
        };
        let (near_x, near_y) = (slope(by_x), slope(by_y));
        let places: [[i32; 2]; S] = std::array::from_fn(|s| match S {
            4 => FOUR[s],
            _ => [STEPS / 2; 2],
        });
        let offsets = [0, 1, 2].map(|i| {
            places.map(|[sx, sy]| {
                let step = by_x[i].times(W::of(sx)).plus(by_y[i].times(W::of(sy)));
                step.plus(bias[i])
            })
        });
        let step = W::of(STEPS);
        for py in down[0]..=down[1] {
            let row = W::of((py - down[0]) * STEPS);
            let mut at = [0, 1, 2].map(|i| first[i].plus(by_y[i].times(row)));
            let away_y = py * STEPS - y[0];
            for px in across[0]..=across[1] {
                let away_x = px * STEPS - x[0];
                let place = ((py - self.corner[1]) * TILE + px - self.corner[0]) as usize;
                let held = &tile.nearness[place];
                let mut mask = 0_u32;
                let mut nearness = [0.0; S];
                for s in 0..S {
                    let [sx, sy] = places[s];
                    nearness[s] =
                        near[0] + near_x * (away_x + sx) as f32 + near_y * (away_y + sy) as f32;
                    let is_outside = at[0].plus(offsets[0][s]).is_negative()
                        | at[1].plus(offsets[1][s]).is_negative()
                        | at[2].plus(offsets[2][s]).is_negative();
                    mask |= u32::from(!is_outside & (nearness[s] > held[s])) << s;
                }
                if mask != 0 {
                    let middle = [0, 1, 2].map(|i| {
                        let half = W::of(STEPS / 2);
                        let at = at[i].plus(by_x[i].plus(by_y[i]).times(half));
                        at.float() * inverse
                    });
                    let widths = [0, 1, 2].map(|i| {
                        let sum = by_x[i].float().abs() + by_y[i].float().abs();
                        sum * STEPS as f32 * inverse
                    });
                    self.shade(tile, [px, py], place, (mask, nearness), (middle, widths));
                }
                at = [0, 1, 2].map(|i| at[i].plus(by_x[i].times(step)));
            }
        }
    }

    /// Keeps a fragment in the samples that it covers. `middle`: shares of the corners on the grid.
    #[inline(always)]
    fn shade<H: Held, const S: usize>(
        &self,
        tile: &mut Tile<H, S>,
        pixel: [i32; 2],
        place: usize,
        (mut mask, nearness): (u32, [f32; S]),
        (middle, widths): ([f32; 3], [f32; 3]),
    ) {
        let paint = &self.surface.paint;
        // With perspective, what is linear in space is divided by depth on the grid.
        let shares = match self.surface.perspective {
            true => {
                let near = [0, 1, 2].map(|i| middle[i] * self.corners[i].place.nearness);
                let scale = 1.0 / (near[0] + near[1] + near[2]);
                near.map(|n| n * scale)
            }
            false => middle,
        };
        let mut fragment = Fragment {
            paint,
            corners: self.corners,
            shares,
            is_front: self.triangle.is_front,
            line: 0.0,
        };
        let whole = |corner: &&Vertex| corner.coverage >= 1.0 && corner.kept >= 0.0;
        let coverage = match self.corners.iter().all(whole) {
            true => 1.0,
            false => fragment.coverage(),
        };
        let line = |half_width: f32| lines(middle, widths, self.triangle.is_half, half_width);
        mask &= match &paint.sheet {
            Some(sheet) => {
                let coverage = coverage * sheet.coverage(line);
                let depth = nearness.iter().copied().fold(0.0, f32::max);
                sheet.mask(coverage, S as u32, pixel, depth, self.triangle.is_front)
            }
            None => mask_of(coverage, S as u32, pixel),
        };
        if mask == 0 {
            return;
        }
        if paint.wire > 0.0 {
            fragment.line = line(paint.wire);
        }
        let held = H::of(&fragment);
        let kept = tile.nearness[place].iter_mut().zip(&mut tile.held[place]);
        for (s, ((near_to, held_to), near)) in kept.zip(nearness).enumerate() {
            if mask >> s & 1 == 1 {
                (*near_to, *held_to) = (near, held);
            }
        }
    }
}
