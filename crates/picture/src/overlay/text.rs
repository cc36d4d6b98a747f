//! Text in pictures.

use ab_glyph::{Font, FontRef, Glyph, ScaleFont, point};

use crate::color::Rgb;
use crate::image::Image;

/// A font at a size.
pub(crate) struct Text {
    font: FontRef<'static>,
    /// Height of a line (pixels).
    pub(crate) size: f32,
}

impl Text {
    /// Ubuntu Light with lines of this height (pixels).
    pub(crate) fn new(size: f32) -> Self {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT);
        Self {
            font: font.expect("a font that is part of this program can be read"),
            size,
        }
    }

    /// Width (pixels) of a line.
    pub(crate) fn width(&self, line: &str) -> f32 {
        self.glyphs(line).1
    }

    /// Draws a line of text. (x, y) is its left end, at half the height of its capital letters.
    pub(crate) fn draw(&self, image: &mut Image, x: f32, y: f32, line: &str, ink: Rgb) {
        // The font's capitals are 0.69 of the em, which is 0.87 of a line: half of that is 0.3.
        let base = y + 0.3 * self.size;
        for mut glyph in self.glyphs(line).0 {
            glyph.position.x += x;
            glyph.position.y = base;
            if let Some(outline) = self.font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|column, row, coverage| {
                    let (x, y) = (corner.x as i64, corner.y as i64);
                    // The font is light: a little darker it reads better.
                    let alpha = coverage.powf(0.75);
                    image.blend(x + i64::from(column), y + i64::from(row), ink, alpha);
                });
            }
        }
    }

    fn glyphs(&self, line: &str) -> (Vec<Glyph>, f32) {
        let font = self.font.as_scaled(self.size);
        let mut x = 0.0;
        let mut glyphs = Vec::new();
        let mut last = None;
        for letter in line.chars() {
            let id = font.glyph_id(letter);
            x += last.map_or(0.0, |last| font.kern(last, id));
            glyphs.push(id.with_scale_and_position(self.size, point(x, 0.0)));
            x += font.h_advance(id);
            last = Some(id);
        }
        (glyphs, x)
    }
}
