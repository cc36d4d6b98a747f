//! What a picture shows, and what one step of it draws.

use crate::output::tiles::TileRenderer;
use crate::shading::finish::Finish;
use crate::shading::shade::Shade;
use neurotess_picture::Camera;
use neurotess_picture::Frame;
use neurotess_picture::Look;
use neurotess_picture::Occlusion;
use neurotess_picture::color::{Rgb, linear};

/// What a picture shows, and from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewParams {
    /// The camera.
    pub camera: Camera,
    /// Depth (µm) of the near plane: [`Camera::near`]'s, which without perspective is negative.
    pub near: f64,
    /// Width and height (pixels), from 1 on.
    pub size: [u32; 2],
    /// Light, wireframe, cut.
    pub look: Look,
    /// Ambient occlusion, which darkens corners.
    pub occlusion: Occlusion,
    /// Color behind everything.
    pub background: Rgb,
    /// Another camera and near plane, for which levels are selected and parts are culled.
    pub frozen: Option<(Camera, f64)>,
}

/// How a picture gets better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// Number of steps: 1, 4 or 16.
    pub steps: u32,
    /// Slices that a step is drawn in. One slice draws with one or more of the source's shaders;
    /// where a scene is too large for one batch, it draws a band of rows.
    pub slices: u32,
}

/// Offset of a step (pixels) from the pixel's center, and of its dither pattern: the column and row
/// of the step's sub-pixel.
pub(super) fn offset(step: u32, steps: u32) -> ([f32; 2], [f32; 2]) {
    let side = f64::from(steps).sqrt() as u32;
    if side <= 1 {
        return ([0.0; 2], [0.0; 2]);
    }
    let place = [step % side, step / side].map(|k| k as f32);
    (place.map(|k| (k + 0.5) / side as f32 - 0.5), place)
}

/// Rows above and below a band that are selected with it, since steps are offset by up to half a
/// pixel.
const SPARE_ROWS: u32 = 2;

/// The frame that the source selects for: a band of rows, or all; from the frozen camera if there
/// is one.
pub(super) fn selected(params: &ViewParams, band: Option<(u32, u32)>) -> Frame {
    let (camera, near) = params.frozen.unwrap_or((params.camera, params.near));
    let mut frame = Frame::whole(camera, near, params.size);
    let (top, bottom) = band.unwrap_or((0, params.size[1]));
    frame.tile.x -= SPARE_ROWS as i32;
    frame.tile.width += 2 * SPARE_ROWS;
    frame.tile.y = top as i32 - SPARE_ROWS as i32;
    frame.tile.height = bottom - top + 2 * SPARE_ROWS;
    frame
}

pub(super) fn shade(renderer: &TileRenderer, params: &ViewParams) -> Shade {
    let frame = Frame::whole(params.camera, params.near, params.size);
    let mut shade = Shade::new(&frame, &params.look, 1, &renderer.sizes);
    if let Some((frozen, _)) = params.frozen {
        shade.shift = (frozen.eye() - params.camera.eye()).as_vec3().to_array();
    }
    shade
}

pub(super) fn finish_uniform(params: &ViewParams, frame: &Frame, step: u32, steps: u32) -> Finish {
    let (radius, most) = params
        .occlusion
        .reach(&params.camera, params.size[1])
        .unwrap_or_default();
    let [r, g, b] = linear(params.background);
    let [red, green, blue] = params.background;
    Finish {
        radius,
        most,
        scale: 1,
        kept: params.size,
        spare: step,
        clear: u32::from(steps == 1),
        empty: u32::from_le_bytes([red, green, blue, 255]),
        background: [r, g, b, 1.0],
        ..Finish::of(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_spread_over_the_pixel() {
        for steps in [1, 4, 16] {
            let all: Vec<_> = (0..steps).map(|step| offset(step, steps).0).collect();
            for axis in 0..2 {
                let sum: f32 = all.iter().map(|place| place[axis]).sum();
                assert!(sum.abs() < 1e-6 && all.iter().all(|p| p[axis].abs() < 0.5));
            }
        }
        assert_eq!(offset(3, 4), ([0.25, 0.25], [1.0, 1.0]));
    }
}
