//! Options of a picture.

use neurotess_color::{ColorBy, ColorScheme, OwnColors};
use neurotess_picture::color::{ColorMap, Palette, Rgb};
use neurotess_picture::{Look, PictureOptions, Side};

/// What a picture of cells shows, and how. The default is that of `neurotess render`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DrawOptions {
    /// Width and height (pixels), up to 32768.
    pub size: [u32; 2],
    /// Samples of a pixel: 1, 4, 16, 36 or 64.
    pub samples: u32,
    /// Color behind everything; none: transparent.
    pub background: Option<Rgb>,
    /// From where one looks at the cells, which fill the picture.
    pub side: Side,
    /// Without perspective: lengths are true at all depths.
    pub orthographic: bool,
    /// What colors tell.
    pub color_by: ColorBy,
    /// Colors of types and of things told apart.
    pub palette: Palette,
    /// Colors of one's own, before those of the palette.
    pub own_colors: OwnColors,
    /// Colors of numbers.
    pub color_map: ColorMap,
    /// Numbers at both ends of the color map; none: the least and the greatest.
    pub range: Option<[f32; 2]>,
    /// Whether there is a legend.
    pub legend: bool,
    /// A scale bar of this length (µm; 0: one that fits).
    pub scale_bar: Option<f64>,
    /// Whether the directions of x, y and z are shown.
    pub axes: bool,
    /// Least width of neurites (pixels of pictures whose shorter side has up to 960; more in larger ones); none: 1.5, and
    /// of more than 50 cells 0.
    pub least_width: Option<f32>,
    /// Farthest that the surface may be from the level-64 one (pixels).
    pub pixels: f32,
}

impl Default for DrawOptions {
    fn default() -> Self {
        let picture = PictureOptions::default();
        Self {
            size: picture.size,
            samples: picture.samples,
            background: picture.background,
            side: Side::Front,
            orthographic: false,
            color_by: ColorBy::default(),
            palette: Palette::default(),
            own_colors: OwnColors::default(),
            color_map: ColorMap::default(),
            range: None,
            legend: true,
            scale_bar: None,
            axes: false,
            least_width: None,
            pixels: 0.25,
        }
    }
}

impl DrawOptions {
    /// The same in another size (pixels).
    #[must_use]
    pub fn with_size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// The same with colors that tell something else.
    #[must_use]
    pub fn with_color_by(self, color_by: ColorBy) -> Self {
        Self { color_by, ..self }
    }

    /// The same from another side.
    #[must_use]
    pub fn with_side(self, side: Side) -> Self {
        Self { side, ..self }
    }

    /// The same before another color, or transparent.
    #[must_use]
    pub fn with_background(self, background: Option<Rgb>) -> Self {
        Self { background, ..self }
    }

    /// The same with a scale bar of this length (µm; 0: one that fits).
    #[must_use]
    pub fn with_scale_bar(self, length: f64) -> Self {
        Self {
            scale_bar: Some(length),
            ..self
        }
    }

    pub(super) fn scheme(&self) -> ColorScheme {
        ColorScheme {
            palette: self.palette,
            own_colors: self.own_colors.clone(),
            background: self.background,
            scale: self.color_map.scale(),
            range: self.range,
        }
    }

    /// Least width (pixels of this picture) of neurites.
    pub(super) fn width(&self, cells: usize) -> f32 {
        let width = self.least_width;
        let width = width.unwrap_or_else(|| Look::usual_least_width(cells));
        Look::width_at(width, self.size)
    }

    pub(super) fn picture(&self, cells: usize) -> PictureOptions {
        PictureOptions {
            size: self.size,
            samples: self.samples,
            background: self.background,
            look: Look {
                contrast: self.background,
                least_width: self.width(cells),
                ..Look::default()
            },
            ..PictureOptions::default()
        }
    }
}
