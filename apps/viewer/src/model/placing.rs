//! Moving and turning cells by handles in the picture: what a drag of the mouse means. Lengths are µm, angles
//! radians, places of the mouse points of the window from the picture's upper left corner.

use std::f64::consts::PI;
use std::fmt;

use glam::{DQuat, DVec3, EulerRot};
use neurotess::render::Placement;

use crate::model::view::View;

/// Length (points) of the arrows that move.
pub(crate) const ARROW: f64 = 92.0;
/// Radius (points) of the rings that turn.
pub(crate) const RING: f64 = 66.0;
/// Least cosine between an axis and the view at which the mouse follows a ring in its own plane. Others are seen
/// nearly from the side: there it moves along their front.
const FACING: f64 = 0.3;
/// Least sine between an axis and the view at which an arrow can be dragged.
const APART: f64 = 0.12;
/// Steps of a drag that snaps: µm, and fifteen degrees.
const STEPS: (f64, f64) = (10.0, PI / 12.0);
const AXES: [&str; 3] = ["x", "y", "z"];

/// The handles at the selected cells, while they show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placing {
    /// The handle under the cursor.
    pub under: Option<Handle>,
    /// The drag of a handle.
    pub drag: Option<Drag>,
}

/// Where the selected cells are, in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceNumbers {
    /// The middle of their somata (µm).
    pub position: DVec3,
    /// Angles (degrees) of the first of them about x, y and z: R = Rx Ry Rz.
    pub rotation: DVec3,
}

/// A handle. Axes are those of the world: 0 is x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// Moves along an axis.
    Move(usize),
    /// Moves in the plane of the picture.
    Slide,
    /// Turns about an axis.
    Turn(usize),
}

/// A drag of a handle, as it began.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    /// The handle.
    pub handle: Handle,
    /// Where the mouse was.
    pub from: [f64; 2],
    /// Size of the picture.
    pub size: [f64; 2],
    /// The view.
    pub view: View,
    /// Where the handles were, which cells turn about.
    pub pivot: DVec3,
    /// The cells that are dragged: their indices and where they were.
    pub before: Vec<(usize, Placement)>,
}

/// How cells are moved or turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// By this way.
    Moved(DVec3),
    /// About an axis by this angle.
    Turned(usize, f64),
}

/// As the window says it.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Moved(way) => {
                let DVec3 { x, y, z } = way;
                write!(f, "Moved by {x:.1}, {y:.1}, {z:.1} µm")
            }
            Self::Turned(axis, angle) => {
                let degrees = angle.to_degrees();
                write!(f, "Turned by {degrees:.1}° about {}", AXES[axis])
            }
        }
    }
}

/// Where something is after a turn about a place.
pub(crate) fn turned(before: &Placement, pivot: DVec3, turn: DQuat) -> Placement {
    Placement {
        // Many turns in a row must not make it a scale.
        rotation: (turn * before.rotation).normalize(),
        translation: pivot + turn * (before.translation - pivot),
        ..*before
    }
}

/// The rotation of angles (degrees) about x, y and z, as circuits and scenes have it: R = Rx Ry Rz.
pub(crate) fn rotation(degrees: DVec3) -> DQuat {
    let [x, y, z] = degrees.to_array().map(f64::to_radians);
    DQuat::from_euler(EulerRot::XYZ, x, y, z)
}

/// Angles (degrees) of a rotation.
pub(crate) fn degrees(rotation: DQuat) -> DVec3 {
    let (x, y, z) = rotation.to_euler(EulerRot::XYZ);
    // Rounding leaves no -0.
    DVec3::new(x, y, z).map(|angle| angle.to_degrees() + 0.0)
}

/// The direction of an axis.
pub(crate) fn axis(index: usize) -> DVec3 {
    DVec3::AXES[index.min(2)]
}

impl Handle {
    /// What it does.
    pub(crate) fn says(self) -> String {
        match self {
            Self::Move(index) => format!("Move along {} (Ctrl: steps of 10 µm)", AXES[index]),
            Self::Slide => "Move in the plane of the picture".into(),
            Self::Turn(index) => format!("Turn about {} (Ctrl: steps of 15°)", AXES[index]),
        }
    }
}

/// Whether an arrow along an axis can be seen from the side, so that the mouse can follow it.
pub(crate) fn can_follow(view: &View, pivot: DVec3, index: usize) -> bool {
    axis(index).cross(ray_to(view, pivot)).length() > APART
}

/// The direction in which the camera sees a place.
pub(crate) fn ray_to(view: &View, place: DVec3) -> DVec3 {
    let camera = view.camera();
    let forward = -camera.axes()[2];
    match view.orthographic {
        true => forward,
        false => (place - camera.eye()).try_normalize().unwrap_or(forward),
    }
}

/// Length (µm) of a point of the window at a place.
pub(crate) fn pixel(view: &View, place: DVec3, height: f64) -> f64 {
    let camera = view.camera();
    camera.pixel_size(height).at(view.depth_in_front(place))
}

impl Drag {
    /// What the mouse at `to` means. `snaps`: in whole steps.
    pub fn step(&self, to: [f64; 2], snaps: bool) -> Step {
        let snapped = |value: f64, step: f64| match snaps {
            true => (value / step).round() * step,
            false => value,
        };
        match self.handle {
            Handle::Move(index) => {
                let [from, to] = [self.from, to].map(|at| self.along(index, at));
                Step::Moved(axis(index) * snapped(to - from, STEPS.0))
            }
            Handle::Slide => Step::Moved(self.under(to) - self.under(self.from)),
            Handle::Turn(index) => Step::Turned(index, snapped(self.angle(index, to), STEPS.1)),
        }
    }

    /// Where the cells are after a step.
    pub fn placements(&self, step: Step) -> Vec<(usize, Placement)> {
        let moved = |before: &Placement| match step {
            Step::Moved(way) => Placement {
                translation: before.translation + way,
                ..*before
            },
            Step::Turned(index, angle) => {
                let turn = DQuat::from_axis_angle(axis(index), angle);
                turned(before, self.pivot, turn)
            }
        };
        let before = self.before.iter();
        before
            .map(|(index, place)| (*index, moved(place)))
            .collect()
    }

    /// The place under the mouse at the pivot's depth.
    fn under(&self, at: [f64; 2]) -> DVec3 {
        let depth = self.view.depth_in_front(self.pivot);
        self.view.at_depth(at, self.size, depth)
    }

    /// The length along an axis at which it is closest to what is under the mouse: the shortest way between two
    /// lines.
    fn along(&self, index: usize, at: [f64; 2]) -> f64 {
        let place = self.under(at);
        let way = ray_to(&self.view, place);
        let (axis, apart) = (axis(index), self.pivot - place);
        let slanted = axis.dot(way);
        let sine = 1.0 - slanted * slanted;
        (slanted * way.dot(apart) - axis.dot(apart)) / sine.max(APART * APART)
    }

    /// The angle about an axis from where the drag began.
    fn angle(&self, index: usize, to: [f64; 2]) -> f64 {
        let axis = axis(index);
        let ray = ray_to(&self.view, self.pivot);
        if axis.dot(ray).abs() < FACING {
            return self.along_the_front(axis, ray, to);
        }
        let [from, to] = [self.from, to].map(|at| {
            let place = self.under(at);
            let way = ray_to(&self.view, place);
            // Where the line of sight meets the ring's plane.
            place + way * (self.pivot - place).dot(axis) / way.dot(axis) - self.pivot
        });
        let angle = axis.dot(from.cross(to)).atan2(from.dot(to));
        if angle.is_finite() { angle } else { 0.0 }
    }

    /// The angle of a ring that is seen from the side: as far as its front goes with the mouse.
    fn along_the_front(&self, axis: DVec3, ray: DVec3, to: [f64; 2]) -> f64 {
        let front = -(ray - axis * ray.dot(axis));
        let along = axis.cross(front.try_normalize().unwrap_or(DVec3::ZERO)) * RING;
        let [right, up, _] = self.view.camera().axes();
        let (x, y) = (along.dot(right), -along.dot(up));
        let (dx, dy) = (to[0] - self.from[0], to[1] - self.from[1]);
        (dx * x + dy * y) / (x * x + y * y).max(1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [f64; 2] = [400.0, 300.0];

    fn drag(handle: Handle, view: View) -> Drag {
        Drag {
            handle,
            from: pixel_of(&view, DVec3::new(1.0, 2.0, 3.0) + ahead(handle)),
            size: SIZE,
            view,
            pivot: DVec3::new(1.0, 2.0, 3.0),
            before: vec![(4, Placement::default())],
        }
    }

    /// A place of the handle, from the pivot.
    fn ahead(handle: Handle) -> DVec3 {
        match handle {
            Handle::Move(index) => axis(index) * 20.0,
            Handle::Slide => DVec3::ZERO,
            Handle::Turn(index) => axis(index + 1) * 20.0,
        }
    }

    fn pixel_of(view: &View, place: DVec3) -> [f64; 2] {
        let pixel = view.camera().pixel_of(place, [400, 300]);
        pixel.expect("in front")
    }

    /// From the front, from a corner, and without perspective.
    fn views() -> [View; 3] {
        let corner = View::default().orbited(0.7, 0.5, DVec3::Y);
        let orthographic = View {
            orthographic: true,
            ..corner
        };
        [View::default(), corner, orthographic]
    }

    #[test]
    fn an_arrow_follows_the_mouse_along_its_axis() {
        for view in views() {
            for index in [0, 1] {
                let drag = drag(Handle::Move(index), view);
                let to = pixel_of(&view, drag.pivot + axis(index) * 57.0);
                let Step::Moved(way) = drag.step(to, false) else {
                    panic!("an arrow moves");
                };
                assert!(way.distance(axis(index) * 37.0) < 1e-6, "{way}");
                let Step::Moved(way) = drag.step(to, true) else {
                    panic!("an arrow moves");
                };
                assert!(way.distance(axis(index) * 40.0) < 1e-6, "{way}");
                let [(of, place)] = drag.placements(Step::Moved(way))[..] else {
                    panic!("one cell");
                };
                assert_eq!((of, place.translation), (4, way));
            }
        }
        // From the front, the mouse cannot follow z.
        assert!(!can_follow(&View::default(), DVec3::ZERO, 2));
        assert!(can_follow(&views()[1], DVec3::ZERO, 2));
    }

    #[test]
    fn a_ring_follows_the_mouse_around_its_axis() {
        for view in views() {
            // About z, from x to y.
            let mut drag = drag(Handle::Turn(2), view);
            drag.from = pixel_of(&view, drag.pivot + DVec3::X * 20.0);
            let to = pixel_of(&view, drag.pivot + DVec3::Y * 20.0);
            let Step::Turned(2, angle) = drag.step(to, false) else {
                panic!("a ring turns");
            };
            assert!((angle - PI / 2.0).abs() < 1e-6, "{angle}");
            let [(_, place)] = drag.placements(Step::Turned(2, angle))[..] else {
                panic!("one cell");
            };
            // The pivot stays, and what was beside it goes around.
            assert!(place.world_from_cell(drag.pivot).distance(drag.pivot) < 1e-9);
            let beside = place.world_from_cell(drag.pivot + DVec3::X);
            assert!(beside.distance(drag.pivot + DVec3::Y) < 1e-9);
        }
    }

    #[test]
    fn angles_are_those_of_scenes() {
        let angles = DVec3::new(10.0, -20.0, 130.0);
        let [x, y, z] = angles.to_array().map(f64::to_radians);
        let all = DQuat::from_rotation_x(x) * DQuat::from_rotation_y(y) * DQuat::from_rotation_z(z);
        assert!(rotation(angles).angle_between(all) < 1e-6);
        assert!(degrees(all).distance(angles) < 1e-9);
    }

    #[test]
    fn a_ring_seen_from_the_side_turns_with_its_front() {
        // About y, from the front: to the right is a turn of what is in front to the right.
        let view = View::default();
        let drag = drag(Handle::Turn(1), view);
        let to = [drag.from[0] + RING / 2.0, drag.from[1]];
        let Step::Turned(1, angle) = drag.step(to, false) else {
            panic!("a ring turns");
        };
        assert!((angle - 0.5).abs() < 0.02, "{angle}");
        assert!((DQuat::from_axis_angle(DVec3::Y, angle) * DVec3::Z).x > 0.0);
        assert_eq!(drag.step(drag.from, false), Step::Turned(1, 0.0));
    }

    #[test]
    fn the_middle_follows_the_mouse_in_the_picture() {
        for view in views() {
            let drag = drag(Handle::Slide, view);
            let to = [drag.from[0] + 31.0, drag.from[1] - 12.0];
            let Step::Moved(way) = drag.step(to, false) else {
                panic!("it moves");
            };
            let [x, y] = pixel_of(&view, drag.pivot + way);
            assert!((x - to[0]).abs() < 1e-6 && (y - to[1]).abs() < 1e-6);
        }
    }
}
