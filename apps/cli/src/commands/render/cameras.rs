//! The cameras that follow from the options.

use neurotess::picture::overlay::MARGIN;
use neurotess::picture::{BoundingSphere, Camera, CameraError, Lens, Side};

use super::args::{RenderArgs, ViewSide};
use super::values::Fit;
use crate::report::usage;

/// Cameras of all pictures, one or as many as there are frames.
///
/// # Errors
/// Wrong usage: a camera that is not valid.
pub(crate) fn cameras(
    args: &RenderArgs,
    spheres: &[BoundingSphere],
) -> anyhow::Result<Vec<Camera>> {
    let first = match camera(args, spheres, [MARGIN; 4]) {
        Ok(camera) => camera,
        Err(e) => return usage(e.to_string()),
    };
    let frames = args.series()?.unwrap_or(1);
    let turn = match args.turntable {
        true => std::f64::consts::TAU / f64::from(frames),
        false => 0.0,
    };
    Ok((0..frames)
        .map(|frame| first.turned(turn * f64::from(frame)))
        .collect())
}

/// The camera with other margins (left, right, top, bottom); none if --eye, a height or the turntable sets it.
pub(crate) fn refitted(
    args: &RenderArgs,
    spheres: &[BoundingSphere],
    margins: [f64; 4],
) -> Option<Camera> {
    let is_set = args.eye.is_some() || matches!(args.orthographic, Some(Fit::Length(_)));
    match is_set || args.turntable {
        true => None,
        false => camera(args, spheres, margins).ok(),
    }
}

fn camera(
    args: &RenderArgs,
    spheres: &[BoundingSphere],
    margins: [f64; 4],
) -> Result<Camera, CameraError> {
    let fov = args.fov.to_radians();
    match args.orthographic {
        None => fitted(args, fov.into(), spheres, margins),
        Some(Fit::Auto) => fitted(args, Lens::orthographic(fov), spheres, margins),
        Some(Fit::Length(height)) => {
            fitted(args, Lens::orthographic(fov), spheres, margins)?.with_height(height)
        }
    }
}

fn fitted(
    args: &RenderArgs,
    lens: Lens,
    spheres: &[BoundingSphere],
    margins: [f64; 4],
) -> Result<Camera, CameraError> {
    let [width, height] = args.size.0.map(f64::from);
    let aspect = width / height;
    if let (Some(eye), Some(target)) = (args.eye, args.target) {
        return Camera::new(eye.0, target.0, args.up.0, lens);
    }
    let side = match args.view {
        ViewSide::Front => Side::Front,
        ViewSide::Back => Side::Back,
        ViewSide::Left => Side::Left,
        ViewSide::Right => Side::Right,
        ViewSide::Top => Side::Top,
        ViewSide::Bottom => Side::Bottom,
        ViewSide::Iso => Side::Iso,
    };
    if args.turntable {
        return Camera::fit_turning(side, lens, aspect, MARGIN, spheres);
    }
    Camera::fit_within(side, lens, aspect, margins, spheres)
}
