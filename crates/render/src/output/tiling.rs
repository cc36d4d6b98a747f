//! How a picture is divided into tiles.
//!
//! Only the rectangle in which anything shows is drawn. A tile has a margin as wide as ambient occlusion reaches
//! around what is kept of it: at 16 samples and the default size, 178 sub-pixels to each side, though not beyond
//! that rectangle. So tiles are as few and as square as memory allows: of all divisions whose tiles are small
//! enough, the one that draws the fewest sub-pixels.

use std::ops::Range;

use crate::gpu::device::Gpu;
use crate::output::extent::{Rectangle, extent};
use crate::output::tiles::{Finishing, KeptTile};
use crate::shading::finish::BLUR;
use crate::shading::shade::GUARD;
use crate::sources::VertexSource;
use neurotess_picture::{Frame, Tile};
use neurotess_picture::{PictureOptions, Viewpoint};

/// A picture's tiles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tiling {
    /// Sub-pixels per pixel along a side.
    scale: u32,
    /// The whole picture.
    frame: Frame,
    /// Across and down; none if nothing shows.
    sides: Option<[Side; 2]>,
    /// Radius of occlusion: µm, and most sub-pixels.
    occlusion: Option<(f32, f32)>,
}

impl Tiling {
    /// The tiles of a picture.
    pub(crate) fn new(
        gpu: &Gpu,
        source: &dyn VertexSource,
        view: &Viewpoint,
        options: &PictureOptions,
    ) -> Self {
        let scale = gpu.sub_pixels(options);
        let size = options.size.map(|n| n.max(1));
        let occlusion = options.occlusion.reach(&view.camera, size[1] * scale);
        let margin = occlusion.map_or(0, |(_, most)| most as u32 + BLUR + 2);
        let frame = Frame {
            around: margin,
            ..Frame::whole(view.camera, view.near, size.map(|n| n * scale))
        };
        let most = Most {
            side: gpu.largest_texture() - 2 * GUARD as u32,
            square: options.tile,
        };
        // Neurites may be drawn wider than they are.
        let widened = 0.5 * options.look.least_width.max(0.0) * scale as f32;
        let shown = extent(source, &frame, widened.ceil() as u32);
        let side = |k: usize, shown: Rectangle| Shown::new(size[k], scale, margin, shown[k]);
        let sides = shown.and_then(|shown| Some([side(0, shown)?, side(1, shown)?]));
        Self {
            scale,
            frame,
            sides: sides.map(|shown| divided(&shown, most)),
            occlusion,
        }
    }

    /// How its tiles are finished.
    pub(crate) fn finishing(&self, options: &PictureOptions) -> Finishing {
        Finishing {
            scale: self.scale,
            occlusion: self.occlusion,
            background: options.background,
        }
    }

    /// Number of tiles.
    pub(crate) fn len(&self) -> usize {
        let sides = self.sides.iter().flatten();
        sides.fold(usize::from(self.sides.is_some()), |tiles, side| {
            tiles * side.tiles as usize
        })
    }

    /// The picture's bands from above.
    pub(crate) fn bands(&self) -> Vec<Band> {
        let [width, height] = self.frame.size.map(|n| n / self.scale);
        let most = (MAX_BAND / width.max(1)).max(1);
        let down = self.sides.as_ref().map(|[_, down]| down);
        let mut bands = Vec::new();
        let mut below = 0;
        for row in 0..down.map_or(0, |down| down.tiles) {
            let kept = down.map_or(0..0, |down| down.kept(row));
            if kept.end - below > most {
                bands.extend(Band::empty(below..kept.start, most));
                below = kept.start;
            }
            bands.push(Band {
                rows: below..kept.end,
                tiles: Some(row),
            });
            below = kept.end;
        }
        match bands.last_mut() {
            Some(last) if height - last.rows.start <= most => last.rows.end = height,
            _ => bands.extend(Band::empty(below..height, most)),
        }
        bands
    }

    /// The tiles of a band from the left: the upper left pixel in the band of what they keep, and what they
    /// draw.
    pub(crate) fn tiles<'a>(
        &'a self,
        band: &'a Band,
    ) -> impl Iterator<Item = ([u32; 2], KeptTile)> + use<'a> {
        let (frame, scale) = (self.frame, self.scale);
        let sides = self.sides.as_ref().zip(band.tiles);
        sides.into_iter().flat_map(move |([across, down], row)| {
            (0..across.tiles).map(move |column| {
                let [x, y] = [across.window(column), down.window(row)];
                let kept = [across.kept(column), down.kept(row)];
                let tile = Tile {
                    x: x.start,
                    y: y.start,
                    width: x.len() as u32,
                    height: y.len() as u32,
                };
                let inset = [(&kept[0], x.start), (&kept[1], y.start)]
                    .map(|(kept, start)| ((kept.start * scale) as i32 - start) as u32);
                let place = [kept[0].start, kept[1].start - band.rows.start];
                let tile = KeptTile {
                    frame: Frame { tile, ..frame },
                    inset,
                    kept: kept.map(|kept| kept.len() as u32),
                };
                (place, tile)
            })
        })
    }
}

/// Rows of a picture that are there at once.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Band {
    /// Rows of pixels.
    pub(crate) rows: Range<u32>,
    /// The row of tiles in it; none if nothing shows.
    tiles: Option<u32>,
}

impl Band {
    /// Rows in which nothing shows, at most so many at once.
    fn empty(rows: Range<u32>, most: u32) -> impl Iterator<Item = Self> {
        let end = rows.end;
        rows.step_by(most as usize).map(move |top| Self {
            rows: top..end.min(top + most),
            tiles: None,
        })
    }
}

/// Most pixels of a band that has rows in which nothing shows.
const MAX_BAND: u32 = 1 << 22;

/// Number of tiles that a picture is drawn in.
pub fn tiles(
    gpu: &Gpu,
    source: &dyn VertexSource,
    view: &Viewpoint,
    options: &PictureOptions,
) -> usize {
    Tiling::new(gpu, source, view, options).len()
}

/// What shows along a side of a picture.
#[derive(Clone, Debug, PartialEq)]
struct Shown {
    /// Pixels of the picture.
    pixels: Range<u32>,
    /// Sub-pixels, also those around the picture that occlude what is inside.
    drawn: Range<i32>,
    /// Sub-pixels per pixel.
    scale: u32,
    /// Sub-pixels around what is kept of a tile.
    margin: u32,
}

impl Shown {
    /// `shown`: the sub-pixels in which anything shows. None if none of them is in the picture.
    fn new(size: u32, scale: u32, margin: u32, shown: [i32; 2]) -> Option<Self> {
        let inside = shown.map(|n| n.clamp(0, (size * scale) as i32) as u32);
        let pixels = inside[0] / scale..inside[1].div_ceil(scale);
        let whole = [pixels.start, pixels.end].map(|n| (n * scale) as i32);
        let around = [-(margin as i32), (size * scale + margin) as i32];
        (!pixels.is_empty()).then(|| Self {
            pixels,
            drawn: shown[0].clamp(around[0], whole[0])..shown[1].clamp(whole[1], around[1]),
            scale,
            margin,
        })
    }

    /// Divided into so many tiles.
    fn divided(&self, tiles: u32) -> Side {
        let step = (self.pixels.len() as u32).div_ceil(tiles);
        let mut side = Side {
            shown: self.clone(),
            step,
            tiles: (self.pixels.len() as u32).div_ceil(step),
            width: 0,
        };
        // The tiles between the first and the last are all alike.
        let some = [0, 1, side.tiles - 1].map(|tile| tile.min(side.tiles - 1));
        let widths = some.map(|tile| side.needed(tile).len() as u32);
        side.width = widths.into_iter().max().unwrap_or(0);
        side
    }
}

/// How a side of a picture is divided.
#[derive(Clone, Debug, PartialEq)]
struct Side {
    shown: Shown,
    /// Pixels kept of a tile; the last may have fewer.
    step: u32,
    /// Number of tiles.
    tiles: u32,
    /// Sub-pixels of each tile with its margins.
    width: u32,
}

impl Side {
    /// The pixels that are kept of a tile.
    fn kept(&self, tile: u32) -> Range<u32> {
        let start = self.shown.pixels.start + tile * self.step;
        start..(start + self.step).min(self.shown.pixels.end)
    }

    /// The sub-pixels that what is kept of a tile depends on.
    fn needed(&self, tile: u32) -> Range<i32> {
        let Shown {
            drawn,
            scale,
            margin,
            ..
        } = &self.shown;
        let kept = self.kept(tile);
        let [start, end] = [kept.start, kept.end].map(|n| (n * scale) as i32);
        let margin = *margin as i32;
        (start - margin).max(drawn.start)..(end + margin).min(drawn.end)
    }

    /// The sub-pixels that are drawn: as many for each tile, so that all have the same targets.
    fn window(&self, tile: u32) -> Range<i32> {
        let width = self.width as i32;
        let start = self.needed(tile).start.min(self.shown.drawn.end - width);
        start..start + width
    }
}

/// How large tiles may be (sub-pixels, with their margins).
#[derive(Clone, Copy, Debug)]
struct Most {
    side: u32,
    /// Side of a square of the greatest area.
    square: u32,
}

/// Fewest pixels kept of a tile along a side, however small tiles should be.
const MIN_STEP: u32 = 32;

/// The division that draws the fewest sub-pixels, of those whose tiles are small enough.
fn divided(shown: &[Shown; 2], most: Most) -> [Side; 2] {
    let least = MIN_STEP * shown[0].scale + 2 * shown[0].margin;
    let area = u64::from(most.square.max(least)).pow(2);
    let longest = most.side.max(least);
    let finest = |k: usize| (shown[k].pixels.len() as u32).div_ceil(MIN_STEP);
    let pixels = |across: &Side, down: &Side| u64::from(across.width) * u64::from(down.width);
    let with_rows = |across: u32| {
        let across = shown[0].divided(across);
        let fits =
            |down: &Side| across.width.max(down.width) <= longest && pixels(&across, down) <= area;
        // With more rows of tiles there are more margins.
        let mut rows = (1..=finest(1)).map(|down| shown[1].divided(down));
        let down = rows.find(fits)?;
        Some([across, down])
    };
    let all = (1..=finest(0)).filter_map(with_rows);
    let drawn = |[across, down]: &[Side; 2]| {
        u64::from(across.tiles) * u64::from(down.tiles) * pixels(across, down)
    };
    all.min_by_key(drawn)
        .unwrap_or_else(|| [0, 1].map(|k| shown[k].divided(finest(k))))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use neurotess_picture::Camera;

    const ROOMY: Most = Most {
        side: 16_000,
        square: 1536,
    };

    fn sides(size: [u32; 2], scale: u32, margin: u32, most: Most) -> [Side; 2] {
        let far = [-1_000_000, 1_000_000];
        let shown = size.map(|n| Shown::new(n, scale, margin, far).expect("it shows"));
        divided(&shown, most)
    }

    #[test]
    fn tiles_cover_a_picture_within_their_bounds() {
        for size in [
            [1, 1],
            [31, 2000],
            [300, 260],
            [1280, 960],
            [7919, 31],
            [32_768, 32_768],
        ] {
            for (scale, margin) in [(1, 0), (2, 54), (2, 178), (4, 366)] {
                for square in [97, 333, 1536] {
                    let most = Most { square, ..ROOMY };
                    let [across, down] = sides(size, scale, margin, most);
                    let least = u64::from(MIN_STEP * scale + 2 * margin);
                    let area = u64::from(square).max(least).pow(2);
                    assert!(
                        u64::from(across.width) * u64::from(down.width) <= area,
                        "{size:?} {scale} {margin}"
                    );
                    let longest = u64::from(across.width.max(down.width));
                    assert!(longest <= u64::from(ROOMY.side).max(least));
                    for (side, pixels) in [across, down].iter().zip(size) {
                        assert_eq!(side.kept(0).start, 0);
                        assert_eq!(side.kept(side.tiles - 1).end, pixels);
                        for tile in 0..side.tiles {
                            assert!(!side.kept(tile).is_empty());
                            let (needed, window) = (side.needed(tile), side.window(tile));
                            assert!(window.start <= needed.start && needed.end <= window.end);
                        }
                    }
                }
            }
        }
    }

    fn bands_of(size: [u32; 2], down: [i32; 2]) -> Vec<(Range<u32>, Option<u32>)> {
        let camera = Camera::new(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
        let shown = [
            Shown::new(size[0], 1, 0, [0, 10]),
            Shown::new(size[1], 1, 0, down),
        ];
        let shown = shown.map(|shown| shown.expect("it shows"));
        let tiling = Tiling {
            scale: 1,
            frame: Frame::whole(camera, 0.1, size),
            sides: Some(divided(
                &shown,
                Most {
                    square: 97,
                    ..ROOMY
                },
            )),
            occlusion: None,
        };
        let bands = tiling.bands().into_iter();
        bands.map(|band| (band.rows, band.tiles)).collect()
    }

    #[test]
    fn bands_are_as_few_as_memory_allows_and_have_all_rows() {
        assert_eq!(bands_of([100, 300], [120, 180]), [(0..300, Some(0))]);
        // A million rows of 100 pixels are too many for one band.
        let bands = bands_of([100, 1_000_000], [500_000, 500_090]);
        let tiles: Vec<_> = bands.iter().filter(|(_, tiles)| tiles.is_some()).collect();
        assert_eq!(tiles.len(), 1);
        assert!(bands.iter().all(|(rows, _)| rows.len() <= (1 << 22) / 100));
        let ends = bands.iter().map(|(rows, _)| rows.end);
        let starts = bands.iter().map(|(rows, _)| rows.start);
        assert!(std::iter::once(0).chain(ends).eq(starts.chain([1_000_000])));
    }

    #[test]
    fn a_full_picture_draws_fewer_than_twice_its_sub_pixels() {
        let [across, down] = sides([1280, 960], 2, 180, ROOMY);
        assert_eq!((across.tiles, down.tiles), (2, 2));
        let drawn = 4 * across.width * down.width;
        assert!(f64::from(drawn) < 2.0 * 2560.0 * 1920.0);
    }

    #[test]
    fn what_is_empty_is_not_drawn() {
        let across = Shown::new(1280, 2, 180, [301, 1502]).expect("it shows");
        assert_eq!(
            (across.pixels.clone(), across.drawn.clone()),
            (150..751, 300..1502)
        );
        let two = across.divided(2);
        assert_eq!((two.window(0), two.window(1)), (300..1082, 720..1502));
        // Around the picture it is drawn as far as it occludes what is inside.
        let across = Shown::new(1280, 2, 180, [-500, -3]);
        assert_eq!(across, None);
        let across = Shown::new(1280, 2, 180, [-500, 20]).expect("it shows");
        assert_eq!((across.pixels, across.drawn), (0..10, -180..20));
    }
}
