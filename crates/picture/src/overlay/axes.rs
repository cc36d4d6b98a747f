//! The directions of x, y and z as three arms with their names.

use glam::DVec3;

use crate::color::Rgb;
use crate::image::Image;
use crate::overlay::stroke::stroke;
use crate::overlay::text::Text;
use crate::view::camera::Camera;

/// The axes and their colors, which the window's have, too.
const AXES: [(DVec3, &str, Rgb); 3] = [
    (DVec3::X, "x", [214, 60, 60]),
    (DVec3::Y, "y", [70, 160, 70]),
    (DVec3::Z, "z", [60, 110, 220]),
];
/// Side of the image, in heights of a line of text.
const SIDE: f32 = 6.0;
/// Length of an arm.
const ARM: f32 = 1.9;
/// Distance of a name from the middle.
const NAME: f32 = 2.5;

/// The axes as a camera sees them, on a transparent image; `line`: height (pixels) of a line of text.
pub(crate) fn axes(camera: &Camera, line: f32) -> Image {
    let [right, up, backward] = camera.axes();
    let side = (SIDE * line).ceil() as u32;
    let mut image = Image::new(side, side);
    let middle = f64::from(side) / 2.0;
    let text = Text::new(line);
    let mut arms = AXES;
    // The farthest first.
    arms.sort_by(|a, b| a.0.dot(backward).total_cmp(&b.0.dot(backward)));
    for (axis, name, color) in arms {
        let direction = [axis.dot(right), -axis.dot(up)];
        let at = |length: f32| direction.map(|d| middle + d * f64::from(length * line));
        let arm = [[middle; 2], at(ARM)];
        stroke(&mut image, 0, &arm, (0.14 * line).max(1.0), color, 1.0);
        let [x, y] = at(NAME).map(|n| n as f32);
        text.draw(&mut image, x - text.width(name) / 2.0, y, name, color);
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::framing::Side;

    /// Where a color is in the image, from the middle.
    fn direction(image: &Image, color: Rgb) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for y in 0..image.height {
            for x in 0..image.width {
                if image.at(x, y)[..3] == color {
                    let middle = f64::from(image.width) / 2.0;
                    sum[0] += f64::from(x) + 0.5 - middle;
                    sum[1] += f64::from(y) + 0.5 - middle;
                }
            }
        }
        sum
    }

    #[test]
    fn arms_point_where_the_axes_do() {
        let camera = Camera::fit(Side::Front, 0.3, 1.0, 0.1, &[]).expect("a camera");
        let image = axes(&camera, 20.0);
        let [x, y] = [0, 1].map(|k: usize| direction(&image, AXES[k].2));
        assert!(x[0] > 100.0 && x[0] > 10.0 * x[1].abs(), "{x:?}");
        assert!(y[1] < -100.0 && -y[1] > 10.0 * y[0].abs(), "{y:?}");
    }
}
