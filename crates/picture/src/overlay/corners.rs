//! Legend, scale bar and axes in the corners of a picture.

use crate::color::{Rgb, is_dark};
use crate::image::Image;
use crate::overlay::axes::axes;
use crate::overlay::legend::{Legend, nice_length, scale_bar};
use crate::view::camera::Camera;
use crate::view::frustum::BoundingSphere;

/// Images to be blended over a picture, with their positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    pieces: Vec<(i64, i64, Image)>,
    kept: Option<Kept>,
    /// Whether there is no room for the legend.
    pub legend_left_out: bool,
    /// Whether the scale bar would be longer than the picture is wide, or shorter than a pixel.
    pub bar_left_out: bool,
    /// If the legend covers a part of the scene: the share of the picture's width, on the left
    /// (negative) or on the right, that would have to be free for it.
    pub covering: Option<f64>,
}

/// What the pictures of a series have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kept {
    size: [u32; 2],
    line: f32,
    background: Option<Rgb>,
    /// Corner of the legend, and whether it covers something.
    legend: Option<(usize, bool)>,
    /// Corner of the scale bar, its length (µm; 0: as long as fits), and whether it covers
    /// something.
    bar: Option<(usize, f64, bool)>,
    /// Corner of the axes, and whether they cover something.
    axes: Option<(usize, bool)>,
}

/// What is drawn into the corners.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlayOptions {
    /// The legend.
    pub legend: Option<Legend>,
    /// A scale bar of this length (µm; 0: as long as fits).
    pub scale_bar: Option<f64>,
    /// Whether the directions of x, y and z are shown.
    pub axes: bool,
    /// Color behind everything; none: transparent.
    pub background: Option<Rgb>,
}

/// Share of the picture that stays free on each side.
pub const MARGIN: f64 = 0.04;
/// Greatest share of the width that is left free for a legend.
const MAX_BESIDE: f64 = 0.35;

/// Height of a line, as a share of the picture's.
const LINE: f32 = 0.023;

/// Height (pixels) of a line of text in a picture of this size.
pub(crate) fn line_height(size: [u32; 2]) -> f32 {
    let [width, height] = size.map(|n| n as f32);
    (LINE * height.min(width)).max(9.0)
}

impl Overlay {
    /// Selects the corners that cover least of the scene, for all cameras together.
    pub fn new(
        options: &OverlayOptions,
        size: [u32; 2],
        cameras: &[Camera],
        spheres: &[BoundingSphere],
    ) -> Self {
        let mut overlay = Self::default();
        let [width, height] = size.map(|n| n as f32);
        let line = line_height(size);
        let ink = ink(options.background);
        let seen = Seen::new(size, cameras, spheres);
        let mut kept = Kept {
            size,
            line,
            background: options.background,
            legend: None,
            bar: None,
            axes: None,
        };
        if let Some(legend) = &options.legend {
            let image = legend.draw(line, ink);
            let fits = (image.width as f32) < 0.7 * width && (image.height as f32) < 0.9 * height;
            if fits && image.width > 2 {
                let (corner, count) = seen.emptiest(&image, line, &[0, 1, 2, 3]);
                kept.legend = Some((corner, count > 0));
                if count > 0 {
                    let share = f64::from((image.width as f32 + 1.5 * line) / width);
                    overlay.covering = Some(if corner.is_multiple_of(2) {
                        -share
                    } else {
                        share
                    });
                }
            } else {
                overlay.legend_left_out = image.width > 2;
            }
        }
        if let (Some(length), Some(camera)) = (options.scale_bar, cameras.first()) {
            let taken = kept.legend.map(|(corner, _)| corner);
            match bar(camera, length, size, line, ink) {
                Some(image) => {
                    let corners = [3, 2].into_iter().filter(|&c| Some(c) != taken);
                    let corners: Vec<usize> = corners.collect();
                    let (corner, count) = seen.emptiest(&image, line, &corners);
                    kept.bar = Some((corner, length, count > 0));
                }
                None => overlay.bar_left_out = true,
            }
        }
        if let (true, Some(camera)) = (options.axes, cameras.first()) {
            let taken = [kept.legend.map(|l| l.0), kept.bar.map(|b| b.0)];
            let image = axes(camera, line);
            let corners = [2, 3, 0, 1]
                .into_iter()
                .filter(|&c| !taken.contains(&Some(c)));
            let (corner, count) = seen.emptiest(&image, line, &corners.collect::<Vec<_>>());
            // In tiny pictures there is no room for them.
            let fits = (image.width as f32) < 0.4 * width.min(height);
            kept.axes = fits.then_some((corner, count > 0));
        }
        overlay.kept = Some(kept);
        let camera = cameras.first();
        overlay.pieces = pieces(&kept, options.legend.as_ref(), camera);
        overlay
    }

    /// [`Overlay::new`], and as many cameras as were given. If the legend would cover something, the scene is fitted
    /// again beside it: `fit` gives the camera of all pictures with these margins (left, right, top, bottom), if it may be
    /// another one.
    pub fn with_room(
        options: &OverlayOptions,
        size: [u32; 2],
        cameras: Vec<Camera>,
        spheres: &[BoundingSphere],
        fit: impl FnOnce([f64; 4]) -> Option<Camera>,
    ) -> (Self, Vec<Camera>) {
        let overlay = Self::new(options, size, &cameras, spheres);
        let covered = overlay.covering.filter(|share| share.abs() <= MAX_BESIDE);
        let beside = covered.and_then(|share| {
            let free = share.abs() + MARGIN;
            let (left, right) = match share < 0.0 {
                true => (free, MARGIN),
                false => (MARGIN, free),
            };
            fit([left, right, MARGIN, MARGIN])
        });
        match beside {
            Some(camera) => {
                let all = vec![camera; cameras.len()];
                (Self::new(options, size, &all[..1], spheres), all)
            }
            None => (overlay, cameras),
        }
    }

    /// The overlay of another picture of the series: with its legend, scale bar and axes, in the
    /// same corners.
    #[must_use]
    pub fn again(&self, legend: Option<&Legend>, camera: &Camera) -> Self {
        let mut overlay = self.clone();
        if let Some(kept) = &self.kept {
            overlay.pieces = pieces(kept, legend, Some(camera));
        }
        overlay
    }

    /// Blends the images over a band of the picture, whose first row is `top`.
    pub fn lay_on(&self, top: u32, band: &mut Image) {
        for (x, y, image) in &self.pieces {
            band.lay(*x, y - i64::from(top), image);
        }
    }
}

fn pieces(kept: &Kept, legend: Option<&Legend>, camera: Option<&Camera>) -> Vec<(i64, i64, Image)> {
    let Kept {
        size,
        line,
        background,
        ..
    } = *kept;
    let ink = ink(background);
    let mut pieces = Vec::new();
    let mut lay = |corner: usize, covers: bool, image: Image| {
        let [x, y] = place(corner, size, &image, line);
        if let Some(background) = background.filter(|_| covers) {
            pieces.push((x, y, panel(&image, background)));
        }
        pieces.push((x, y, image));
    };
    if let (Some((corner, covers)), Some(legend)) = (kept.legend, legend) {
        lay(corner, covers, legend.draw(line, ink));
    }
    if let (Some((corner, length, covers)), Some(camera)) = (kept.bar, camera)
        && let Some(image) = bar(camera, length, size, line, ink)
    {
        lay(corner, covers, image);
    }
    if let (Some((corner, covers)), Some(camera)) = (kept.axes, camera) {
        lay(corner, covers, axes(camera, line));
    }
    pieces
}

/// A scale bar of this length (µm; 0: as long as fits); none that is longer than the picture is wide, or shorter than a
/// pixel.
fn bar(camera: &Camera, length: f64, size: [u32; 2], line: f32, ink: Rgb) -> Option<Image> {
    let pixel = camera.pixel_at_target(f64::from(size[1]));
    let length = match length {
        0.0 => nice_length(0.2 * f64::from(size[0]) * pixel),
        length => length,
    };
    let pixels = length / pixel;
    let fits = (1.0..=f64::from(size[0]) - 2.0 * f64::from(line)).contains(&pixels);
    fits.then(|| scale_bar(length, pixels as f32, line, ink))
}

/// Color of text: black on a light or transparent background, white on a dark one.
pub(crate) fn ink(background: Option<Rgb>) -> Rgb {
    if background.is_some_and(is_dark) {
        [240; 3]
    } else {
        [20; 3]
    }
}

/// Position of an image in a corner: 0 upper left, 1 upper right, 2 lower left, 3 lower right.
fn place(corner: usize, size: [u32; 2], image: &Image, line: f32) -> [i64; 2] {
    let gap = line.ceil() as i64;
    let far = [
        i64::from(size[0]) - i64::from(image.width) - gap,
        i64::from(size[1]) - i64::from(image.height) - gap,
    ];
    [
        if corner.is_multiple_of(2) {
            gap
        } else {
            far[0]
        },
        if corner < 2 { gap } else { far[1] },
    ]
}

fn panel(image: &Image, background: Rgb) -> Image {
    let mut panel = Image::new(image.width, image.height);
    for y in 0..i64::from(panel.height) {
        for x in 0..i64::from(panel.width) {
            panel.blend(x, y, background, 0.7);
        }
    }
    panel
}

/// Spheres in the picture (pixels).
struct Seen {
    size: [u32; 2],
    /// Center and radius of each.
    places: Vec<([f64; 2], f64)>,
}

/// Most spheres that are considered: enough to see which corners are empty.
const MAX_PLACES: usize = 200_000;

impl Seen {
    fn new(size: [u32; 2], cameras: &[Camera], spheres: &[BoundingSphere]) -> Self {
        let step = (cameras.len() * spheres.len() / MAX_PLACES).max(1);
        let pairs = cameras
            .iter()
            .flat_map(|c| spheres.iter().map(move |b| (c, b)));
        let places = pairs.step_by(step);
        let places = places.filter_map(|(camera, &(center, radius))| {
            let pixel = camera
                .pixel_size(f64::from(size[1]))
                .at(camera.depth(center));
            Some((camera.pixel_of(center, size)?, radius / pixel))
        });
        Self {
            size,
            places: places.collect(),
        }
    }

    /// The one of these corners where an image covers fewest spheres, and how many it covers.
    fn emptiest(&self, image: &Image, line: f32, corners: &[usize]) -> (usize, usize) {
        let count = |corner: usize| {
            let [x, y] = place(corner, self.size, image, line).map(|n| n as f64);
            let (w, h) = (f64::from(image.width), f64::from(image.height));
            let under = |(p, radius): &&([f64; 2], f64)| {
                let gap = f64::from(line) / 2.0 + radius;
                (x - gap..x + w + gap).contains(&p[0]) && (y - gap..y + h + gap).contains(&p[1])
            };
            self.places.iter().filter(under).count()
        };
        let counts = corners.iter().map(|&corner| (corner, count(corner)));
        counts.min_by_key(|&(_, count)| count).unwrap_or((3, 0))
    }
}
