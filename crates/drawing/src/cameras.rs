//! The cameras that follow from the options.

use neurotess_options::Picture;
use neurotess_options::words::Fit;
use neurotess_picture::overlay::MARGIN;
use neurotess_picture::{BoundingSphere, Camera, CameraError, Lens};

use crate::error::{DrawError, together};

/// Cameras of all pictures, one or as many as there are frames.
///
/// # Errors
/// A camera that is not valid.
pub(crate) fn cameras(
    picture: &Picture,
    spheres: &[BoundingSphere],
) -> Result<Vec<Camera>, DrawError> {
    let first = match camera(picture, spheres, [MARGIN; 4]) {
        Ok(camera) => camera,
        Err(e) => return together(e.to_string()),
    };
    let frames = picture.camera.series()?.unwrap_or(1);
    let turn = match picture.camera.turntable {
        true => std::f64::consts::TAU / f64::from(frames),
        false => 0.0,
    };
    Ok((0..frames)
        .map(|frame| first.turned(turn * f64::from(frame)))
        .collect())
}

/// The camera with other margins (left, right, top, bottom); none if --eye, a height or the turntable sets it.
pub(crate) fn refitted(
    picture: &Picture,
    spheres: &[BoundingSphere],
    margins: [f64; 4],
) -> Option<Camera> {
    let asked = &picture.camera;
    let is_set = asked.eye.is_some() || matches!(asked.orthographic, Some(Fit::Length(_)));
    match is_set || asked.turntable {
        true => None,
        false => camera(picture, spheres, margins).ok(),
    }
}

fn camera(
    picture: &Picture,
    spheres: &[BoundingSphere],
    margins: [f64; 4],
) -> Result<Camera, CameraError> {
    let fov = picture.camera.fov.to_radians();
    match picture.camera.orthographic {
        None => fitted(picture, fov.into(), spheres, margins),
        Some(Fit::Auto) => fitted(picture, Lens::orthographic(fov), spheres, margins),
        Some(Fit::Length(height)) => {
            fitted(picture, Lens::orthographic(fov), spheres, margins)?.with_height(height)
        }
    }
}

fn fitted(
    picture: &Picture,
    lens: Lens,
    spheres: &[BoundingSphere],
    margins: [f64; 4],
) -> Result<Camera, CameraError> {
    let [width, height] = picture.look.size.0.map(f64::from);
    let aspect = width / height;
    let asked = &picture.camera;
    if let (Some(eye), Some(target)) = (asked.eye, asked.target) {
        return Camera::new(eye.0, target.0, asked.up.0, lens);
    }
    let side = asked.view.into();
    if asked.turntable {
        return Camera::fit_turning(side, lens, aspect, MARGIN, spheres);
    }
    Camera::fit_within(side, lens, aspect, margins, spheres)
}
