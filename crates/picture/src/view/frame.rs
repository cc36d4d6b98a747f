//! What is drawn at once: a camera, a picture's size and the tile of it.

use glam::{DVec3, Mat4, Vec4};

use crate::view::camera::Camera;
use crate::view::lens::PixelSize;

/// A rectangle of a picture in sub-pixels, from its upper left corner. It may reach over the
/// border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tile {
    /// Left side.
    pub x: i32,
    /// Upper side.
    pub y: i32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

/// A tile of a picture.
///
/// A **sub-pixel** is a pixel of what is drawn; a pixel of the finished picture is the mean of one
/// or more. Whatever decides how finely something is drawn takes the size of the whole picture, not
/// that of the tile, so that tiles fit together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The camera.
    pub camera: Camera,
    /// Depth (µm) of the near plane: [`Camera::near`]'s.
    pub near: f64,
    /// Width and height of the whole picture (sub-pixels).
    pub size: [u32; 2],
    /// The part of the picture that is drawn.
    pub tile: Tile,
    /// Sub-pixels around the whole picture that tiles may hold, too: what is there occludes what is inside.
    pub around: u32,
}

impl Frame {
    /// A picture of this size (sub-pixels) in one tile.
    pub fn whole(camera: Camera, near: f64, size: [u32; 2]) -> Self {
        Self {
            camera,
            near,
            size,
            tile: Tile {
                x: 0,
                y: 0,
                width: size[0],
                height: size[1],
            },
            around: 0,
        }
    }

    /// Width by height of the whole picture.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// Size (µm) of a sub-pixel by depth.
    pub fn pixel(&self) -> PixelSize {
        self.camera.pixel_size(f64::from(self.size[1]))
    }

    /// Clip space of the whole picture, from positions relative to the eye.
    pub fn clip_from_relative(&self) -> Mat4 {
        self.camera.clip_from_relative(self.aspect(), self.near)
    }

    /// Planes around what the tile shows, relative to the eye, as [`Camera::frustum`]'s.
    pub fn frustum(&self) -> [Vec4; 5] {
        let [right, up, backward] = self.camera.axes();
        // Tangents with perspective, else lengths.
        let unit = self.pixel().at(1.0);
        let orthographic = self.camera.is_orthographic();
        let [w, h] = self.size.map(f64::from);
        let Tile { x, y, .. } = self.tile;
        // Of the tile's sides; y runs down in a picture, up in the view.
        let left = (f64::from(x) - w / 2.0) * unit;
        let top = (h / 2.0 - f64::from(y)) * unit;
        let (width, height) = (f64::from(self.tile.width), f64::from(self.tile.height));
        let side = |axis: DVec3, tan: f64, sign: f64| {
            if orthographic {
                return (axis * sign).as_vec3().extend((-sign * tan) as f32);
            }
            let normal = (axis + backward * tan) * (sign / tan.hypot(1.0));
            normal.as_vec3().extend(0.0)
        };
        [
            side(right, left, 1.0),
            side(right, left + width * unit, -1.0),
            side(up, top - height * unit, 1.0),
            side(up, top, -1.0),
            (-backward).as_vec3().extend(-self.near as f32),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::frustum::shows;
    use crate::view::lens::Lens;
    use glam::Vec3;

    #[test]
    fn tiles_part_the_frustum_of_the_picture() {
        let eye = DVec3::new(1.0, 2.0, 30.0);
        for lens in [Lens::from(0.7), Lens::orthographic(0.7)] {
            let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, lens).expect("a camera");
            parts(camera);
        }
    }

    fn parts(camera: Camera) {
        let near = if camera.is_orthographic() { -90.0 } else { 0.1 };
        let frame = |x: i32, y: i32, width: u32, height: u32| Frame {
            camera,
            near,
            size: [200, 100],
            tile: Tile {
                x,
                y,
                width,
                height,
            },
            around: 0,
        };
        let whole = frame(0, 0, 200, 100).frustum();
        for (a, b) in whole.iter().zip(camera.frustum(2.0, near)) {
            assert!((*a - b).length() < 1e-6, "{a} {b}");
        }
        let quarters = [(0, 0), (100, 0), (0, 50), (100, 50)];
        for i in 0..400 {
            let t = i as f32;
            let p = Vec3::new((t * 1.3).sin() * 15.0, (t * 0.7).cos() * 9.0, -20.0);
            let seen = quarters.map(|(x, y)| shows(&frame(x, y, 100, 50).frustum(), p, 0.0));
            let count = seen.iter().filter(|&&s| s).count();
            assert_eq!(count, usize::from(shows(&whole, p, 0.0)), "{p}");
        }
    }
}
