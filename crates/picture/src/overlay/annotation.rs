//! Lines with labels over a picture, such as dimensions.

use crate::color::Rgb;
use crate::image::Image;
use crate::overlay::corners::{ink, line_height};
use crate::overlay::stroke::stroke;
use crate::overlay::text::Text;

/// A line over a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct AnnotationLine {
    /// Its corners (pixels from the upper left corner of the picture).
    pub points: Vec<[f64; 2]>,
    /// Its width, as a share of the height of a line of text.
    pub width: f32,
}

/// Lines, and a label of one or several lines of text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Annotation {
    /// Its lines.
    pub lines: Vec<AnnotationLine>,
    /// The text.
    pub label: Vec<String>,
    /// Middle of the label (pixels from the upper left corner of the picture).
    pub label_at: [f64; 2],
}

/// Annotations of a picture, drawn in its ink, with a rim in its background's color, so that they
/// can be seen on all neurons.
#[derive(Clone, Debug, Default)]
pub struct Annotations {
    annotations: Vec<Annotation>,
    line: f32,
    ink: Rgb,
    /// Color of rims and behind labels; none: transparent.
    rim: Option<Rgb>,
}

/// How opaque rims, and what is behind labels, are.
const RIM: f32 = 0.75;
/// Width of a rim on each side, as a share of the height of a line of text.
const RIM_WIDTH: f32 = 0.1;

impl Annotations {
    /// Annotations of a picture of this size (pixels); `background`: the color behind everything,
    /// none if that is transparent.
    pub fn new(annotations: Vec<Annotation>, size: [u32; 2], background: Option<Rgb>) -> Self {
        Self {
            annotations,
            line: line_height(size),
            ink: ink(background),
            rim: background,
        }
    }

    /// Height (pixels) of a line of text in a picture of this size: that of legends.
    pub fn line_height(size: [u32; 2]) -> f32 {
        line_height(size)
    }

    /// Draws them over a band of the picture, whose first row is `top`.
    pub fn lay_on(&self, top: u32, band: &mut Image) {
        let lines = self.annotations.iter().flat_map(|a| &a.lines);
        for line in lines {
            let width = (line.width * self.line).max(1.0);
            if let Some(rim) = self.rim {
                let wide = width + 2.0 * RIM_WIDTH * self.line;
                stroke(band, top, &line.points, wide, rim, RIM);
            }
            stroke(band, top, &line.points, width, self.ink, 1.0);
        }
        // Labels are above all lines.
        for annotation in self.annotations.iter().filter(|a| !a.label.is_empty()) {
            let image = self.label(&annotation.label);
            let corner = |axis: usize, size: u32| {
                (annotation.label_at[axis] - f64::from(size) / 2.0).round() as i64
            };
            let (x, y) = (corner(0, image.width), corner(1, image.height));
            band.lay(x, y - i64::from(top), &image);
        }
    }

    fn label(&self, label: &[String]) -> Image {
        let (line, text) = (self.line, Text::new(self.line));
        let widest = label.iter().map(|row| text.width(row)).fold(0.0, f32::max);
        let (width, height) = (widest + 0.7 * line, (1.2 * label.len() as f32 + 0.3) * line);
        let mut image = Image::new(width.ceil() as u32, height.ceil() as u32);
        if let Some(rim) = self.rim {
            for y in 0..i64::from(image.height) {
                for x in 0..i64::from(image.width) {
                    image.blend(x, y, rim, RIM);
                }
            }
        }
        for (row, number) in label.iter().zip(0_u16..) {
            let x = (width - text.width(row)) / 2.0;
            let y = (0.15 + 1.2 * (f32::from(number) + 0.5)) * line;
            text.draw(&mut image, x, y, row, self.ink);
        }
        image
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn annotations() -> Annotations {
        let line = AnnotationLine {
            points: vec![[10.0, 50.5], [50.0, 50.5], [90.0, 90.0]],
            width: 0.2,
        };
        let annotation = Annotation {
            lines: vec![line],
            label: vec!["12 µm".into(), "path".into()],
            label_at: [50.0, 20.0],
        };
        Annotations::new(vec![annotation], [100, 100], Some([255; 3]))
    }

    #[test]
    fn lines_are_inked_and_labels_stand_out() {
        let mut image = Image::new(100, 100);
        image.pixels.fill(128);
        annotations().lay_on(0, &mut image);
        assert_eq!(image.at(30, 50), [20, 20, 20, 255]);
        assert_eq!(image.at(95, 30)[..3], [128; 3], "away from all");
        let rim = image.at(30, 48);
        assert!(rim[0] > 140, "{rim:?}");
        let dark = |y: u32| (20..80).filter(|&x| image.at(x, y)[0] < 150).count();
        assert!((14..20).any(|y| dark(y) > 2) && (24..30).any(|y| dark(y) > 2));
    }

    #[test]
    fn bands_are_parts_of_the_same_picture() {
        let all = annotations();
        let mut whole = Image::new(100, 100);
        all.lay_on(0, &mut whole);
        for top in [0, 40, 60] {
            let mut band = Image::new(100, 40);
            all.lay_on(top, &mut band);
            let rows = &whole.pixels[400 * top as usize..][..400 * 40];
            assert_eq!(band.pixels, rows, "{top}");
        }
    }

    #[test]
    fn what_is_outside_or_no_number_is_left_out() {
        let line = |points: Vec<[f64; 2]>| Annotation {
            lines: vec![AnnotationLine { points, width: 0.2 }],
            ..Annotation::default()
        };
        let lines = vec![
            line(vec![[f64::NAN, 2.0], [3.0, 4.0]]),
            line(vec![[-500.0, -1e12], [1e15, -20.0]]),
            line(vec![]),
        ];
        let mut image = Image::new(8, 8);
        Annotations::new(lines, [8, 8], None).lay_on(0, &mut image);
        assert!(image.pixels.iter().all(|&byte| byte == 0));
    }
}
