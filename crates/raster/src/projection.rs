//! From positions relative to the eye to places on the grid of sub-pixels. Twin of the vertex stage of shade.wgsl.

use glam::{DVec3, Vec3};
use neurotess_picture::{Frame, HALF_WIDTH, PictureOptions, Viewpoint};

/// Steps of a sub-pixel that positions are rounded to, as rasterizers of GPUs do.
pub(crate) const STEPS: i32 = 256;
/// Farthest (steps) that a place may be: products of two distances then fit 64 bits. A million sub-pixels beyond the border,
/// nobody sees that what is farther has moved.
const FARTHEST: f32 = (1 << 28) as f32;

/// A picture's view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    pub(crate) eye: DVec3,
    /// Right, up, backward.
    pub(crate) axes: [Vec3; 3],
    /// Size (µm) of a sub-pixel: what each µm of depth adds, and what it is at every depth.
    pub(crate) slope: f32,
    pub(crate) flat: f32,
    /// Half the picture (sub-pixels).
    pub(crate) half: [f32; 2],
    /// Depth (µm) of the near plane.
    pub(crate) near: f32,
    /// Half the width of the thinnest line, and half the least width of neurites (sub-pixels).
    narrowest: f32,
    least: f32,
    /// The plane behind which everything is cut away, relative to the eye.
    cut: Option<(Vec3, f32)>,
}

/// Where something is on the grid, in steps of sub-pixels from the upper left corner of the picture, and how near.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place {
    pub(crate) x: i32,
    pub(crate) y: i32,
    /// Larger where nearer, linear on the grid; above 0.
    pub(crate) nearness: f32,
}

/// A thin tube, as wide as it is drawn.
pub(crate) struct Widened {
    /// Position relative to the eye (µm).
    pub(crate) position: Vec3,
    pub(crate) coverage: f32,
    /// From 0 for tubes at least two pixels wide to 1 for width 0.
    pub(crate) thin: f32,
}

impl Projection {
    pub(crate) fn new(view: &Viewpoint, options: &PictureOptions, scale: u32) -> Self {
        let size = options.size.map(|n| n.max(1) * scale);
        let frame = Frame::whole(view.camera, view.near, size);
        let cut = options.look.clip.map(|clip| {
            let away = clip.normal.dot(view.camera.eye() - clip.point);
            (clip.normal.as_vec3(), away as f32)
        });
        Self {
            eye: view.camera.eye(),
            axes: view.camera.view_rotation(),
            slope: frame.pixel().slope as f32,
            flat: frame.pixel().flat as f32,
            half: size.map(|n| n as f32 / 2.0),
            near: view.near as f32,
            narrowest: HALF_WIDTH * scale as f32,
            least: 0.5 * options.look.least_width.max(0.0) * scale as f32,
            cut,
        }
    }

    /// Half the width (sub-pixels) of lines.
    pub(crate) fn half_line(&self) -> f32 {
        self.narrowest
    }

    /// Half the width (sub-pixels) that the thinnest tubes are widened to.
    pub(crate) fn widest(&self) -> f32 {
        self.narrowest.max(self.least)
    }

    /// Whether there is perspective.
    pub(crate) fn is_perspective(&self) -> bool {
        self.flat == 0.0
    }

    /// The axes' coordinates of a vector: right, up, backward.
    pub(crate) fn in_view(&self, v: Vec3) -> Vec3 {
        let [right, up, backward] = self.axes;
        Vec3::new(right.dot(v), up.dot(v), backward.dot(v))
    }

    /// Size (µm) of a sub-pixel at this depth.
    pub(crate) fn sub_pixel(&self, depth: f32) -> f32 {
        self.slope * depth + self.flat
    }

    /// Distance (µm) to the plane that cuts, positive on the side that is kept.
    pub(crate) fn kept(&self, position: Vec3) -> f32 {
        self.cut
            .map_or(1.0, |(normal, away)| normal.dot(position) + away)
    }

    /// The plane's normal, if something is cut.
    pub(crate) fn cut_normal(&self) -> Option<Vec3> {
        self.cut.map(|(normal, _)| normal)
    }

    /// Where a point of the view is; none if it is not before the near plane.
    pub(crate) fn place(&self, view: Vec3) -> Option<Place> {
        let depth = -view.z;
        if depth <= self.near {
            return None;
        }
        let scale = 1.0 / self.sub_pixel(depth);
        let steps = |half: f32, along: f32| {
            let place = (half + along * scale) * STEPS as f32;
            let place = place.clamp(-FARTHEST, FARTHEST);
            let towards_zero = place as i32;
            towards_zero - i32::from((towards_zero as f32) > place)
        };
        Some(Place {
            x: steps(self.half[0], view.x),
            y: steps(self.half[1], -view.y),
            nearness: self.nearness(depth),
        })
    }

    /// Linear on the grid, above 0 and the larger the nearer. Without perspective depths reach from `near` to `-near`.
    fn nearness(&self, depth: f32) -> f32 {
        match self.is_perspective() {
            true => 1.0 / depth,
            false => (0.5 - 0.5 * depth / -self.near).max(f32::MIN_POSITIVE),
        }
    }

    /// The depth (µm) of what is so near.
    pub(crate) fn depth(&self, nearness: f32) -> f32 {
        match self.is_perspective() {
            true => 1.0 / nearness,
            false => (0.5 - nearness) * 2.0 * -self.near,
        }
    }

    /// A point of the view at a place.
    pub(crate) fn view_at(&self, place: Place) -> Vec3 {
        let depth = self.depth(place.nearness);
        let sub_pixel = self.sub_pixel(depth);
        let along = |steps: i32, half: f32| (steps as f32 / STEPS as f32 - half) * sub_pixel;
        let [x, y] = [along(place.x, self.half[0]), -along(place.y, self.half[1])];
        Vec3::new(x, y, -depth)
    }

    /// The middle of a sub-pixel at this depth, in the view.
    pub(crate) fn middle(&self, [x, y]: [i32; 2], depth: f32) -> Vec3 {
        let across = [
            x as f32 + 0.5 - self.half[0],
            -(y as f32 + 0.5 - self.half[1]),
        ];
        let [x, y] = across.map(|a| a * self.slope * depth + a * self.flat);
        Vec3::new(x, y, -depth)
    }

    /// The direction to the eye from the middle of a sub-pixel, in the view.
    pub(crate) fn eye_from(&self, pixel: [i32; 2]) -> Vec3 {
        match self.is_perspective() {
            true => -self.middle(pixel, 1.0).normalize_or(Vec3::NEG_Z),
            false => Vec3::Z,
        }
    }

    /// A tube thinner than a pixel is widened to a pixel and made fainter. `radius`: 0 on somata, which are never widened.
    pub(crate) fn widened(&self, position: Vec3, normal: Vec3, radius: f32) -> Widened {
        if radius <= 0.0 {
            return Widened {
                position,
                coverage: 1.0,
                thin: 0.0,
            };
        }
        let axis = position - normal * radius;
        let depth = (-axis.dot(self.axes[2])).max(self.near);
        let sub_pixel = self.sub_pixel(depth);
        let narrowest = self.narrowest * sub_pixel;
        let thin = (1.0 - 0.5 * radius / narrowest).max(0.0);
        let widened = narrowest.max(self.least * sub_pixel);
        if radius >= widened {
            return Widened {
                position,
                coverage: 1.0,
                thin,
            };
        }
        Widened {
            position: position + normal * (widened - radius),
            coverage: match self.least > 0.0 {
                true => 1.0,
                false => ink_of(radius / narrowest),
            },
            thin,
        }
    }
}

/// Coverage of a line by the share of a pixel that it fills: see lighting.wgsl.
fn ink_of(share: f32) -> f32 {
    let rest = 1.0 - share.sqrt();
    1.0 - rest * rest * rest
}
