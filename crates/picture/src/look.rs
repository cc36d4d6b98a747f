//! How surfaces look: light, widths, wireframe, cut, states.

use glam::{DVec3, Vec3};

use crate::color::{Rgb, is_dark, luminance};
use crate::least_width::{CROWD, usual_least_width};

/// How surfaces look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How surfaces are lit.
    pub light: Light,
    /// Width (pixels) of the wireframe's lines; 0: no wireframe.
    pub wire: f32,
    /// The plane behind which everything is cut away.
    pub clip: Option<Clip>,
    /// Color of [`HIGHLIGHTED`] instances, and its share, 0 to 1.
    pub highlighted: (Rgb, f32),
    /// Opacity of [`GHOSTED`] instances, 0 to 1.
    pub ghosted: f32,
    /// Background against which colors of the scale must stand out: colors about as light as the
    /// background have edges, dark ones on a light background and light ones on a dark one. None,
    /// or [`Light::Flat`]: no edges.
    pub contrast: Option<Rgb>,
    /// Least width (pixels) of neurites: thinner ones are drawn this wide, and no fainter. 0: as wide as
    /// they are, and from a pixel on fainter instead of thinner.
    pub least_width: f32,
}

/// A plane behind which everything is cut away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// A point of the plane (µm).
    pub point: DVec3,
    /// Unit normal, towards the side that is kept.
    pub normal: DVec3,
}

/// State of an instance: it has the color of [`Look::highlighted`].
pub const HIGHLIGHTED: u32 = 1;
/// State of an instance: it is transparent, see [`Look::ghosted`].
pub const GHOSTED: u32 = 2;
/// State of an instance: only its soma is drawn.
pub const WITHOUT_NEURITES: u32 = 4;
/// State of an instance: its soma is not drawn.
pub const WITHOUT_SOMA: u32 = 8;
/// State of an instance: drafts draw an outline around it, see
/// `ProgressiveRenderer::draft` of `neurotess-render`.
pub const OUTLINED: u32 = 16;

/// How surfaces are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Light {
    /// A soft key light from the upper left, a weak fill and the sky.
    #[default]
    Soft,
    /// The same with the key light from this direction, in the picture's coordinates: right, up,
    /// towards the viewer. Any length but 0.
    From(Vec3),
    /// No light: plain colors.
    Flat,
}

impl Look {
    /// [`usual_least_width`](crate::usual_least_width).
    pub fn usual_least_width(neurons: usize) -> f32 {
        usual_least_width(neurons)
    }

    /// The most neurons that [`Look::usual_least_width`] takes for single ones.
    pub const CROWD: usize = CROWD;

    /// The shorter side (pixels) of pictures that [`Look::width_at`] leaves widths as they are in.
    pub const REFERENCE_SIDE: f32 = 960.0;

    /// A width (pixels) that is meant for pictures of up to [`Look::REFERENCE_SIDE`] pixels, in a picture of this size: larger
    /// ones look the same from farther away. In smaller ones it stays, since less than a pixel would be fainter.
    pub fn width_at(width: f32, size: [u32; 2]) -> f32 {
        let shorter = size[0].min(size[1]) as f32;
        width * (shorter / Self::REFERENCE_SIDE).max(1.0)
    }

    /// The background against which colors of a scale have edges. Plain colors have none.
    pub fn edges_against(&self) -> Option<Rgb> {
        self.contrast.filter(|_| self.light != Light::Flat)
    }
}

impl Default for Look {
    fn default() -> Self {
        Self {
            light: Light::Soft,
            wire: 0.0,
            clip: None,
            highlighted: ([255, 160, 0], 0.0),
            ghosted: 0.25,
            contrast: None,
            least_width: 0.0,
        }
    }
}

/// Direction of [`Light::Soft`]'s key light.
pub const KEY: Vec3 = Vec3::new(-0.5, 0.62, 0.75);

/// Linear color of the edges of this look, and the background's luminance; one above 1 gives no
/// edges.
pub fn edge_color(look: &Look) -> [f32; 4] {
    let Some(background) = look.edges_against() else {
        return [0.0, 0.0, 0.0, 100.0];
    };
    let ink = if is_dark(background) { 0.6 } else { 0.05 };
    [ink, ink, ink, luminance(background)]
}

/// Half the width (pixels) of the thinnest line drawn: thinner ones would look dotted.
pub const HALF_WIDTH: f32 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_grow_with_pictures_and_never_shrink() {
        let widths = [
            [1280, 960],
            [3840, 2880],
            [2880, 3840],
            [4000, 500],
            [64, 48],
        ]
        .map(|size| Look::width_at(1.5, size));
        assert_eq!(widths, [1.5, 4.5, 4.5, 1.5, 1.5]);
    }
}
