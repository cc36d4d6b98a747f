//! From where: the camera that the options ask for, and its frames.

use neurotess::render::{Ball, Camera, Side};

use super::args::{RenderArgs, ViewArg};
use crate::report::usage;

/// Share of the picture that stays free on each side.
const MARGIN: f64 = 0.04;

/// Cameras of all pictures, one or as many as there are frames.
///
/// # Errors
/// Wrong usage: a camera that sees nothing.
pub(crate) fn cameras(args: &RenderArgs, balls: &[Ball]) -> anyhow::Result<Vec<Camera>> {
    let first = match camera(args, balls) {
        Ok(camera) => camera,
        Err(e) => return usage(e.to_string()),
    };
    let frames = args.frames.unwrap_or(1);
    let turn = std::f64::consts::TAU / f64::from(frames);
    Ok((0..frames)
        .map(|frame| first.turned(turn * f64::from(frame)))
        .collect())
}

fn camera(args: &RenderArgs, balls: &[Ball]) -> Result<Camera, neurotess::render::CameraError> {
    let fov = args.fov.to_radians();
    let [width, height] = args.size.0.map(f64::from);
    let aspect = width / height;
    if let (Some(eye), Some(target)) = (args.eye, args.target) {
        return Camera::new(eye.0, target.0, args.up.0, fov);
    }
    let side = match args.view {
        ViewArg::Front => Side::Front,
        ViewArg::Back => Side::Back,
        ViewArg::Left => Side::Left,
        ViewArg::Right => Side::Right,
        ViewArg::Top => Side::Top,
        ViewArg::Bottom => Side::Bottom,
        ViewArg::Iso => Side::Iso,
    };
    if args.turntable {
        return Camera::fit_turning(side, fov, aspect, MARGIN, balls);
    }
    Camera::fit(side, fov, aspect, MARGIN, balls)
}
