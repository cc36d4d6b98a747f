//! How a picture is drawn: its view, size, samples, light and occlusion.

use crate::color::Rgb;
use crate::look::Look;
use crate::view::camera::Camera;

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureOptions {
    /// Width and height (pixels), from 1 on.
    pub size: [u32; 2],
    /// Samples of a pixel: 1, 4, 16, 36 or 64.
    pub samples: u32,
    /// Color behind everything; none: transparent.
    pub background: Option<Rgb>,
    /// Light and wireframe.
    pub look: Look,
    /// Ambient occlusion, which darkens corners.
    pub occlusion: Occlusion,
    /// Side (sub-pixels) of a square as large as the largest tile; tiles are rectangles.
    pub tile: u32,
}

/// The view that a picture is drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// The camera.
    pub camera: Camera,
    /// Depth (µm) of the near plane: [`Camera::near`]'s, which without perspective is negative.
    pub near: f64,
}

/// Ambient occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Occlusion {
    /// Within 8 % of the picture's height, at the distance of the camera's target.
    #[default]
    Fit,
    /// Within this distance (µm), at most 9 % of the picture's height and 360 sub-pixels.
    Within(f32),
    /// None.
    Off,
}

impl Occlusion {
    /// Radius of occlusion in a picture of this height (sub-pixels): µm, and the most sub-pixels.
    /// It does not depend on tiles, so that they fit together.
    pub fn reach(self, camera: &Camera, height: u32) -> Option<(f32, f32)> {
        let height = f64::from(height);
        let sub_pixel = camera.pixel_at_target(height);
        let most = (0.09 * height).min(MAX_MARGIN).ceil();
        let radius = match self {
            Self::Fit => 0.08 * height * sub_pixel,
            Self::Within(radius) => f64::from(radius),
            Self::Off => 0.0,
        };
        (radius > 0.0).then_some((radius as f32, most as f32))
    }
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            size: [1280, 960],
            samples: 16,
            background: Some([255, 255, 255]),
            look: Look::default(),
            occlusion: Occlusion::Fit,
            tile: TILE,
        }
    }
}

/// Side of a square as large as the largest tile by default: with four samples of a sub-pixel, which take 108
/// bytes, 243 MiB.
const TILE: u32 = 1536;
/// Greatest reach (sub-pixels) of ambient occlusion: with more, margins would take up most of a
/// tile.
const MAX_MARGIN: f64 = 360.0;
/// Numbers of samples that a pixel can have.
pub const SAMPLES: [u32; 5] = [1, 4, 16, 36, 64];
/// Greatest width or height of a picture: positions are f32 and keep 1/256 of a sub-pixel.
pub const LARGEST: u32 = 32_768;

impl PictureOptions {
    /// Number of samples that a pixel gets: the greatest possible number that is not above
    /// `samples`.
    pub fn samples_taken(&self) -> u32 {
        let most = SAMPLES.into_iter().rfind(|&n| n <= self.samples);
        most.unwrap_or(1)
    }

    /// Number of sub-pixels along a pixel's side, of which each has so many samples.
    pub fn sub_pixels(&self, in_each: u32) -> u32 {
        let sub_pixels = f64::from(self.samples_taken()) / f64::from(in_each);
        (sub_pixels.sqrt() as u32).max(1)
    }

    /// Number of samples of a sub-pixel: four, or one if a pixel has only one sample.
    pub fn samples_in_sub_pixel(&self) -> u32 {
        if self.samples_taken() == 1 { 1 } else { 4 }
    }
}
