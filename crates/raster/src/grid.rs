//! The grid of sub-pixels of a band, in tiles.

use std::ops::Range;

/// Side (sub-pixels) of a tile.
pub(crate) const TILE: i32 = 32;
/// Sub-pixels of a tile.
pub(crate) const IN_TILE: usize = (TILE * TILE) as usize;

/// Tiles that cover a rectangle of sub-pixels. Coordinates are those of the picture, negative beyond its left and upper
/// border.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Grid {
    /// Sub-pixels that are drawn, across and down.
    pub(crate) drawn: [Range<i32>; 2],
    /// Those whose light matters; the others are drawn for what they occlude.
    kept: [Range<i32>; 2],
    /// Number of tiles across and down.
    pub(crate) tiles: [i32; 2],
    /// Whether a sub-pixel has four samples; else one, in its middle.
    pub(crate) many_samples: bool,
}

impl Grid {
    pub(crate) fn new(drawn: [Range<i32>; 2], kept: [Range<i32>; 2], many_samples: bool) -> Self {
        let tiles = [0, 1].map(|k| (drawn[k].len() as i32 + TILE - 1) / TILE);
        Self {
            drawn,
            kept,
            tiles,
            many_samples,
        }
    }

    /// Number of tiles.
    pub(crate) fn len(&self) -> usize {
        self.tiles[0] as usize * self.tiles[1] as usize
    }

    /// Whether the light of anything in a tile matters.
    pub(crate) fn is_kept(&self, tile: usize) -> bool {
        let corner = self.corner(tile);
        (0..2).all(|k| corner[k] < self.kept[k].end && corner[k] + TILE > self.kept[k].start)
    }

    /// The upper left sub-pixel of a tile.
    pub(crate) fn corner(&self, tile: usize) -> [i32; 2] {
        let across = self.tiles[0] as usize;
        [
            self.drawn[0].start + (tile % across) as i32 * TILE,
            self.drawn[1].start + (tile / across) as i32 * TILE,
        ]
    }

    /// The tiles of a row of sub-pixels from column 0 to `end`: each with the first column that it has of them, and their
    /// places.
    pub(crate) fn along_row(
        &self,
        y: i32,
        end: u32,
        mut tile_at: impl FnMut(usize, u32, Range<usize>),
    ) {
        let start = self.drawn[0].start;
        let down = y - self.drawn[1].start;
        let mut x = 0;
        while x < end as i32 {
            let within = (x - start) % TILE;
            let count = (TILE - within).min(end as i32 - x);
            let tile = (down / TILE) * self.tiles[0] + (x - start) / TILE;
            let place = ((down % TILE) * TILE + within) as usize;
            tile_at(tile as usize, x as u32, place..place + count as usize);
            x += count;
        }
    }

    /// The tile that holds a sub-pixel, and its index there; none outside.
    pub(crate) fn place(&self, [x, y]: [i32; 2]) -> Option<(usize, usize)> {
        if !self.drawn[0].contains(&x) || !self.drawn[1].contains(&y) {
            return None;
        }
        let (x, y) = (x - self.drawn[0].start, y - self.drawn[1].start);
        let tile = (y / TILE) * self.tiles[0] + x / TILE;
        Some((tile as usize, ((y % TILE) * TILE + x % TILE) as usize))
    }
}
