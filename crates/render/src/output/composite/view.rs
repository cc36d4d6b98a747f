//! From where another program's pass is seen: its matrices as a camera of ours, and its depths.

use glam::{DMat3, DMat4, DVec3};
use thiserror::Error;

use neurotess_picture::{Camera, CameraError, DEFAULT_FOV, Frame, Lens};

/// From where another program's pass is seen, and where in its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostView {
    /// The view from the world of the cells (µm): x to the right, y up, z backward. Where the program measures in
    /// other units, or has moved the cells, that is part of it: it may turn, move, and scale alike in all directions.
    pub view: DMat4,
    /// Clip space, as wgpu has it, from the view: perspective or orthographic, with depth forward or reversed, with or
    /// without a far end.
    pub projection: DMat4,
    /// Upper left pixel of the viewport in the pass's target.
    pub origin: [u32; 2],
    /// Width and height (pixels) of the viewport.
    pub size: [u32; 2],
}

/// Why cells cannot be drawn into a view. Messages have the form `what: what to do`.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum HostViewError {
    /// A matrix holds infinity, or what is no number.
    #[error("the {0} matrix holds a number that is not finite: correct it")]
    NotFinite(&'static str),
    /// The view does more than turn, move, and scale alike.
    #[error(
        "the view matrix mirrors, shears, or scales by axis: leave that out, and let z point backward"
    )]
    View,
    /// The projection is none that a camera of ours has.
    #[error(
        "the projection matrix is neither a symmetric perspective with something before its eye nor symmetric and \
         orthographic: use one of wgpu's form, with y up and z from 0 to 1"
    )]
    Projection,
    /// Pixels would not be square.
    #[error(
        "the projection is {projection} times as wide as high, the viewport {viewport} times: make them equal"
    )]
    Aspect {
        /// Width by height of the projection.
        projection: f64,
        /// Width by height of the viewport.
        viewport: f64,
    },
    /// What follows is no camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// How a program's clip space measures our depths (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Depths {
    /// The clip position's z: factor and sum.
    pub(super) z: [f64; 2],
    /// The clip position's w.
    pub(super) w: [f64; 2],
    /// Whether what is nearer has the greater depth.
    pub(super) reversed: bool,
}

/// Share by which what must be equal may differ: programs compute with 32 bits and round sizes. Half a pixel in 500.
const TOLERANCE: f64 = 1e-3;

impl HostView {
    /// The frame that we draw, and how its depths are the program's.
    pub(super) fn frame(&self) -> Result<(Frame, Depths), HostViewError> {
        for (matrix, what) in [(&self.view, "view"), (&self.projection, "projection")] {
            if !matrix.is_finite() {
                return Err(HostViewError::NotFinite(what));
            }
        }
        let scale = self.scale()?;
        let turn = DMat3::from_mat4(self.view) * (1.0 / scale);
        let world = turn.transpose();
        let eye = world * -self.view.w_axis.truncate() / scale;
        let ([half_width, half_height], depths, near) = self.projected(scale)?;
        let [width, height] = self.size.map(f64::from);
        let aspects = [half_width / half_height, width / height];
        // An empty viewport has none, which compares as false.
        let square = (aspects[0] / aspects[1] - 1.0).abs() < TOLERANCE;
        if !square {
            let [projection, viewport] = aspects;
            return Err(HostViewError::Aspect {
                projection,
                viewport,
            });
        }
        // The distance of the target sets the height that an orthographic camera shows.
        let (lens, distance) = match near > 0.0 {
            true => (Lens::from(2.0 * half_height.atan()), 10.0 * near),
            false => {
                let lens = Lens::orthographic(DEFAULT_FOV);
                (lens, half_height / (0.5 * DEFAULT_FOV).tan())
            }
        };
        let camera = Camera::new(eye, eye - world.z_axis * distance, world.y_axis, lens)?;
        Ok((Frame::whole(camera, near, self.size), depths))
    }

    /// Units of the view in a µm.
    fn scale(&self) -> Result<f64, HostViewError> {
        let axes = DMat3::from_mat4(self.view);
        let scale = axes.determinant().cbrt();
        let last = self.view.row(3).truncate();
        let rest = axes.transpose() * axes - DMat3::from_diagonal(DVec3::splat(scale * scale));
        let off = rest
            .to_cols_array()
            .iter()
            .fold(0.0, |most: f64, &x| most.max(x.abs()));
        match scale > 0.0 && off < TOLERANCE * scale * scale && last == DVec3::ZERO {
            true => Ok(scale),
            false => Err(HostViewError::View),
        }
    }

    /// Half the width and height, at depth 1 with perspective; how depths (µm) are measured; and the near plane of ours
    /// (µm), negative without perspective.
    fn projected(&self, scale: f64) -> Result<([f64; 2], Depths, f64), HostViewError> {
        let [x, y, z, w] = self.projection.to_cols_array_2d();
        let zeros = [x[1], x[2], x[3], y[0], y[2], y[3], z[0], z[1], w[0], w[1]];
        if zeros != [0.0; 10] || x[0] <= 0.0 || y[1] <= 0.0 {
            return Err(HostViewError::Projection);
        }
        // At a depth of 1 µm the view's z is minus the scale.
        let (zs, ws) = ([-scale * z[2], w[2]], [-scale * z[3], w[3]]);
        // Where the program's depth is 0, and where it is 1.
        let ends = [-zs[1] / zs[0], (ws[1] - zs[1]) / (zs[0] - ws[0])];
        let perspective = ws[0] > 0.0 && ws[1] == 0.0;
        let orthographic = ws[0] == 0.0 && ws[1] > 0.0;
        let (halves, near, nearer) = if perspective {
            let seen = |end: &f64| end.is_finite() && *end > 0.0;
            let near = ends.into_iter().filter(seen).fold(f64::MAX, f64::min);
            let unit = z[3].abs();
            ([unit / x[0], unit / y[1]], near, near == ends[1])
        } else {
            let reach = ends[0].abs().max(ends[1].abs());
            let unit = ws[1] / scale;
            ([unit / x[0], unit / y[1]], -reach, ends[1] < ends[0])
        };
        if !(perspective || orthographic) || !near.is_finite() || near == f64::MAX || near == 0.0 {
            return Err(HostViewError::Projection);
        }
        let depths = Depths {
            z: zs,
            w: ws,
            reversed: nearer,
        };
        Ok((halves, depths, near))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dcamera::rh::proj::directx::{
        orthographic, perspective, perspective_infinite_reverse,
    };
    use glam::dcamera::rh::view::look_at_mat4;

    const SIZE: [u32; 2] = [400, 300];
    const ASPECT: f64 = 4.0 / 3.0;

    fn of(projection: DMat4, moved: DMat4) -> HostView {
        let eye = DVec3::new(30.0, 20.0, 90.0);
        HostView {
            view: look_at_mat4(eye, DVec3::new(1.0, 2.0, 3.0), DVec3::Y) * moved,
            projection,
            origin: [0, 0],
            size: SIZE,
        }
    }

    /// Depth 1 is near, as in reversed infinite perspective.
    fn reversed() -> DMat4 {
        DMat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0, 1.0],
        ])
    }

    #[test]
    fn our_camera_puts_points_where_the_program_does() {
        let flat = orthographic(-40.0, 40.0, -30.0, 30.0, 5.0, 300.0);
        // Millimeters, turned and moved.
        let turned = DMat4::from_scale_rotation_translation(
            DVec3::splat(1e-3),
            glam::DQuat::from_rotation_x(0.4),
            DVec3::new(2.0, -3.0, 5.0),
        );
        let fine = orthographic(-0.04, 0.04, -0.03, 0.03, -1.0, 200.0);
        for (projection, moved, is_reversed) in [
            (perspective(0.7, ASPECT, 0.5, 300.0), DMat4::IDENTITY, false),
            (
                reversed() * perspective(0.7, ASPECT, 0.5, 300.0),
                turned,
                true,
            ),
            (perspective_infinite_reverse(0.7, ASPECT, 0.5), turned, true),
            (flat, DMat4::IDENTITY, false),
            (reversed() * flat, DMat4::IDENTITY, true),
            (fine, turned, false),
        ] {
            let host = of(projection, moved);
            let (frame, depths) = host.frame().expect("a camera");
            assert_eq!(depths.reversed, is_reversed);
            let camera = frame.camera;
            let [right, up, backward] = camera.axes();
            // In the picture, at several depths.
            for (x, y, depth) in [(0.0, 0.0, 10.0), (0.2, -0.1, 50.0), (-0.3, 0.2, 120.0)] {
                let unit = camera.pixel_size(300.0).at(depth) * 300.0;
                let p = camera.eye() + (right * x + up * y) * unit - backward * depth;
                let clip = projection * host.view * p.extend(1.0);
                let ndc = clip.truncate() / clip.w;
                let [px, py] = camera.pixel_of(p, SIZE).expect("seen");
                let theirs = [(ndc.x + 1.0) * 200.0, (1.0 - ndc.y) * 150.0];
                let off = (px - theirs[0]).hypot(py - theirs[1]);
                assert!(off < 1e-6, "{off}");
                let [z, w] = [depths.z, depths.w].map(|[f, s]| f * depth + s);
                assert!((z / w - ndc.z).abs() < 1e-9, "{} {}", z / w, ndc.z);
            }
        }
    }

    #[test]
    fn the_near_plane_is_the_programs() {
        let near = |projection| {
            of(projection, DMat4::IDENTITY)
                .frame()
                .expect("a camera")
                .0
                .near
        };
        assert!((near(perspective(0.7, ASPECT, 0.5, 300.0)) - 0.5).abs() < 1e-9);
        let back = reversed() * perspective(0.7, ASPECT, 0.5, 300.0);
        assert!((near(back) - 0.5).abs() < 1e-9);
        // As far behind the eye as the far plane lies before it.
        let flat = orthographic(-40.0, 40.0, -30.0, 30.0, 5.0, 300.0);
        assert!((near(flat) + 300.0).abs() < 1e-9);
    }

    #[test]
    fn views_that_no_camera_has_are_errors() {
        let good = perspective(0.7, ASPECT, 0.5, 300.0);
        let error = |projection, moved| of(projection, moved).frame().expect_err("no camera");
        let by_axis = DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0));
        let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        for moved in [by_axis, mirror, DMat4::ZERO] {
            assert_eq!(error(good, moved), HostViewError::View);
        }
        let mut skewed = good;
        skewed.z_axis.x = 0.1;
        for projection in [skewed, DMat4::IDENTITY, DMat4::ZERO, -good] {
            let error = error(projection, DMat4::IDENTITY);
            assert!(
                matches!(
                    error,
                    HostViewError::Projection | HostViewError::Aspect { .. }
                ),
                "{error}"
            );
        }
        let wide = perspective(0.7, 2.0, 0.5, 300.0);
        assert!(matches!(
            error(wide, DMat4::IDENTITY),
            HostViewError::Aspect { .. }
        ));
        let nan = DMat4::from_cols_array(&[f64::NAN; 16]);
        assert_eq!(
            error(nan, DMat4::IDENTITY),
            HostViewError::NotFinite("projection")
        );
        let mut empty = of(good, DMat4::IDENTITY);
        empty.size = [0, 0];
        assert!(matches!(empty.frame(), Err(HostViewError::Aspect { .. })));
    }
}
