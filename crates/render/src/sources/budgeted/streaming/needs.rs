//! How large a template is in a picture.

use glam::{Mat3, Vec3};

use crate::sources::budgeted::proxy::Proxy;
use neurotess_picture::Frame;
use neurotess_picture::Instance;
use neurotess_picture::PixelSize;
use neurotess_picture::bounds::shows;

/// An instance this many times as far as it is large is asked as a whole, else chunk by chunk.
const FAR: f32 = 4.0;

/// A chunk that is near is asked segment by segment by the shader, with the errors of its polylines as a margin: it may be
/// nearer than its sphere by part of its radius.
const MARGIN: f32 = 1.25;

/// What a picture shows of a scene.
pub(super) struct View<'f> {
    frame: &'f Frame,
    planes: [glam::Vec4; 5],
    forward: Vec3,
    /// Size of a whole pixel.
    pixel: PixelSize,
}

impl<'f> View<'f> {
    pub(super) fn new(frame: &'f Frame, pixel: PixelSize) -> Self {
        Self {
            frame,
            planes: frame.frustum(),
            forward: (-frame.camera.axes()[2]).as_vec3(),
            pixel,
        }
    }

    /// Size (µm, in the template's coordinates) of a pixel where an instance is nearest; nothing if it does not show.
    pub(super) fn nearest_pixel(&self, instance: &Instance, proxy: &Proxy) -> Option<f32> {
        if instance.hidden {
            return None;
        }
        let at = instance.placement;
        let scale = at.scale as f32;
        let origin = at.world_from_cell(proxy.origin) - self.frame.camera.eye();
        let origin = origin.as_vec3();
        let turn = Mat3::from_quat(at.rotation.as_quat()) * scale;
        let whole = (origin + turn * proxy.center, proxy.reach * scale);
        let nearest = self.sees(whole)?;
        let depth = self.forward.dot(whole.0);
        let nearest = match depth > FAR * whole.1 {
            true => nearest,
            false => {
                let chunks = proxy.chunks.iter();
                let spheres = chunks.map(|chunk| {
                    let center = Vec3::from_array(chunk.center);
                    (origin + turn * center, chunk.reach * scale)
                });
                spheres
                    .filter_map(|sphere| self.sees(sphere))
                    .min_by(f32::total_cmp)?
            }
        };
        Some(nearest / scale)
    }

    /// Size of a pixel where a sphere, relative to the eye, is nearest; nothing if it does not show.
    fn sees(&self, (center, reach): (Vec3, f32)) -> Option<f32> {
        let pixel = |depth: f32| self.pixel.at(f64::from(depth).max(self.frame.near)) as f32;
        let depth = self.forward.dot(center);
        let margin = reach + pixel(depth + reach);
        shows(&self.planes, center, margin).then(|| pixel(depth - MARGIN * reach))
    }
}
