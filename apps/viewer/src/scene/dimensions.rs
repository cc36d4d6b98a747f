//! Dimensions as lines in a picture. The window and saved pictures draw the same lines.

use glam::DVec3;
use neurotess::render::Camera;
use neurotess::render::overlay::{Annotation, AnnotationLine};

use crate::model::measuring::{Figure, FigureShape};
use crate::model::state::State;

/// Widths of lines; like all lengths below, as shares of the height of a line of text.
const THIN: f32 = 0.1;
const THICK: f32 = 0.17;
const DOT: f32 = 0.42;
/// Length of a dash and of the gap after it.
const DASH: [f64; 2] = [0.45, 0.35];
/// Most dashes of a line; a longer one, most of which is outside the picture, is drawn solid.
const MAX_DASHES: f64 = 400.0;
/// Half the length of a bar at an end.
const TICK: f64 = 0.32;
/// Length of the lines that point at the ends of a diameter from outside.
const POINTER: f64 = 0.9;
/// Radius of an arc, if the fork is not thicker.
const ARC: f64 = 2.0;
/// Number of segments of an arc.
const ROUND: usize = 24;
/// Room between a label and its line.
const GAP: f64 = 0.35;

/// Figures of the dimensions that show.
pub(crate) fn figures(state: &State) -> Vec<Figure> {
    let shown = state.shown_figures().into_iter();
    shown.map(|(_, figure)| figure).collect()
}

/// Dimensions in a picture of this size, with text of this height (both in the same unit, such as
/// pixels), without those that are behind the eye. Labels are moved apart where they would cover
/// one another.
pub(crate) fn annotations<'f>(
    figures: impl IntoIterator<Item = &'f Figure>,
    camera: &Camera,
    size: [f64; 2],
    line: f64,
) -> Vec<Option<Annotation>> {
    let figures = figures.into_iter();
    let mut all: Vec<Option<Annotation>> = figures
        .map(|figure| annotation(figure, camera, size, line))
        .collect();
    let mut taken: Vec<([f64; 2], [f64; 2])> = Vec::new();
    for annotation in all.iter_mut().flatten() {
        let half = half_size(&annotation.label).map(|n| n * line);
        let covers = |at: [f64; 2]| {
            let over = |(other, room): &([f64; 2], [f64; 2])| {
                (0..2).all(|k| (at[k] - other[k]).abs() < half[k] + room[k])
            };
            taken.iter().any(over)
        };
        let [x, y] = annotation.label_at;
        let moved = SHIFTS.map(|rows| [x, y + rows * line]);
        if let Some(free) = moved.into_iter().find(|&at| !covers(at)) {
            annotation.label_at = free;
        }
        taken.push((annotation.label_at, half));
    }
    all
}

/// Where a label may go, in lines of text below its usual place: not farther, so that one still
/// sees what it belongs to.
const SHIFTS: [f64; 9] = [0.0, -0.9, 0.9, -1.8, 1.8, -2.7, 2.7, -3.6, 3.6];

/// Half of the width and height of a label, in lines of text; about so, since letters differ.
fn half_size(label: &[String]) -> [f64; 2] {
    let letters = label.iter().map(|row| row.chars().count()).max();
    [
        0.25 * letters.unwrap_or(0) as f64 + 0.4,
        0.6 * label.len() as f64 + 0.15,
    ]
}

/// A dimension in a picture; none if it is behind the eye.
fn annotation(figure: &Figure, camera: &Camera, size: [f64; 2], line: f64) -> Option<Annotation> {
    let projection = Projection { camera, size, line };
    let (lines, beside) = match &figure.shape {
        FigureShape::Distance { ends, path } => projection.distance(*ends, path)?,
        FigureShape::Diameter {
            center,
            along,
            radius,
        } => projection.diameter(*center, *along, *radius)?,
        FigureShape::Angle {
            center,
            branches,
            radius,
        } => projection.angle(*center, branches, *radius)?,
    };
    Some(Annotation {
        lines,
        label_at: beside.middle(&figure.label, line),
        label: figure.label.clone(),
    })
}

/// A camera and the picture that it makes.
struct Projection<'a> {
    camera: &'a Camera,
    size: [f64; 2],
    line: f64,
}

/// A position in the picture, and the direction that a label lies in from it.
struct Beside {
    at: [f64; 2],
    towards: [f64; 2],
}

type Lines = (Vec<AnnotationLine>, Beside);

impl Projection<'_> {
    /// Where a point is in the picture; none if it is behind the eye.
    fn at(&self, point: DVec3) -> Option<[f64; 2]> {
        let [right, up, _] = self.camera.axes();
        let pixel = self.pixel(point)?;
        let from = point - self.camera.eye();
        let [x, y] = [from.dot(right) / pixel, -from.dot(up) / pixel];
        Some([self.size[0] / 2.0 + x, self.size[1] / 2.0 + y])
    }

    /// Size (µm) of a pixel at a point.
    fn pixel(&self, point: DVec3) -> Option<f64> {
        let depth = self.camera.depth(point);
        let pixel = self.camera.pixel_size(self.size[1]).at(depth);
        (depth > 1e-9 || self.camera.is_orthographic()).then_some(pixel)
    }

    fn distance(&self, ends: [DVec3; 2], path: &[DVec3]) -> Option<Lines> {
        let [a, b] = [self.at(ends[0])?, self.at(ends[1])?];
        let mut lines = Vec::new();
        if path.len() > 1 {
            lines.extend(self.polyline(path, THICK));
            lines.extend(self.dashes(a, b));
        } else {
            lines.push(line(vec![a, b], THIN));
        }
        // A segment without length is a dot.
        lines.extend([a, b].map(|end| line(vec![end, end], DOT)));
        let beside = Beside {
            at: lerp(a, b, 0.5),
            towards: upwards(across(a, b)),
        };
        Some((lines, beside))
    }

    fn dashes(&self, a: [f64; 2], b: [f64; 2]) -> Vec<AnnotationLine> {
        let [dash, gap] = DASH.map(|length| length * self.line);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let count = ((length + gap) / (dash + gap)).ceil();
        if !(2.0..=MAX_DASHES).contains(&count) {
            return vec![line(vec![a, b], THIN)];
        }
        let dash_at = |i: u32| {
            let start = f64::from(i) * (dash + gap);
            let end = (start + dash).min(length);
            let ends = [start, end].map(|way| lerp(a, b, way / length));
            (start < length).then(|| line(ends.to_vec(), THIN))
        };
        (0..count as u32).filter_map(dash_at).collect()
    }

    /// The parts of a line that are in front of the eye.
    fn polyline(&self, points: &[DVec3], width: f32) -> Vec<AnnotationLine> {
        let places: Vec<Option<[f64; 2]>> = points.iter().map(|&p| self.at(p)).collect();
        let parts = places.split(Option::is_none);
        let parts = parts.map(|part| part.iter().copied().flatten().collect::<Vec<_>>());
        parts
            .filter(|part| part.len() > 1)
            .map(|part| line(part, width))
            .collect()
    }

    fn diameter(&self, center: DVec3, along: DVec3, radius: f64) -> Option<Lines> {
        let [right, ..] = self.camera.axes();
        let towards_eye = match self.camera.is_orthographic() {
            true => self.camera.axes()[2],
            false => self.camera.eye() - center,
        };
        // Across the neurite, seen in its true length. Of a soma, or along the view: to the right.
        let across_axis = along.cross(towards_eye).try_normalize().unwrap_or(right);
        let ends = [-1.0, 1.0].map(|side| self.at(center + side * radius * across_axis));
        let [a, b] = [ends[0]?, ends[1]?];
        let pixel = self.pixel(center)?;
        let far = self.at(center + across_axis * pixel)?;
        let middle = self.at(center)?;
        let out = unit([far[0] - middle[0], far[1] - middle[1]]);
        let tick = [-out[1] * TICK * self.line, out[0] * TICK * self.line];
        let mut lines = vec![line(vec![a, b], THIN)];
        for (end, side) in [(a, -1.0), (b, 1.0)] {
            let bar = [-1.0, 1.0].map(|s| [end[0] + s * tick[0], end[1] + s * tick[1]]);
            lines.push(line(bar.to_vec(), THICK));
            // Thin neurites show little between the bars.
            let away = side * POINTER * self.line;
            let pointer = [end[0] + away * out[0], end[1] + away * out[1]];
            lines.push(line(vec![end, pointer], THIN));
        }
        let up = upwards(out);
        let top = if up == out { b } else { a };
        let away = POINTER * self.line;
        let beside = Beside {
            at: [top[0] + away * up[0], top[1] + away * up[1]],
            towards: up,
        };
        Some((lines, beside))
    }

    fn angle(&self, center: DVec3, branches: &[DVec3], radius: f64) -> Option<Lines> {
        let middle = self.at(center)?;
        // The arc is outside of the fork's own membrane.
        let arc = (ARC * self.line * self.pixel(center)?).max(2.0 * radius);
        let mut lines = Vec::new();
        let mut sum = DVec3::ZERO;
        for (i, &a) in branches.iter().enumerate() {
            sum += a;
            lines.extend(self.polyline(&[center, center + 1.35 * arc * a], THIN));
            for &b in &branches[i + 1..] {
                let arc: Vec<DVec3> = (0..=ROUND)
                    .map(|k| center + arc * between(a, b, k as f64 / ROUND as f64))
                    .collect();
                lines.extend(self.polyline(&arc, THICK));
            }
        }
        let outwards = sum.try_normalize().unwrap_or(self.camera.axes()[1]);
        let at = self.at(center + arc * outwards).unwrap_or(middle);
        let beside = Beside {
            at,
            towards: unit([at[0] - middle[0], at[1] - middle[1]]),
        };
        Some((lines, beside))
    }
}

impl Beside {
    /// Middle of a label that does not cover the position.
    fn middle(&self, label: &[String], line: f64) -> [f64; 2] {
        let half = half_size(label);
        let [x, y] = self.towards;
        let away = line * (half[0] * x.abs() + half[1] * y.abs() + GAP);
        [self.at[0] + away * x, self.at[1] + away * y]
    }
}

fn line(points: Vec<[f64; 2]>, width: f32) -> AnnotationLine {
    AnnotationLine { points, width }
}

/// The unit direction that is this share of the way from one to another.
fn between(a: DVec3, b: DVec3, share: f64) -> DVec3 {
    let angle = a.dot(b).clamp(-1.0, 1.0).acos();
    let aside = (b - a * a.dot(b)).try_normalize();
    let aside = aside.unwrap_or_else(|| a.any_orthonormal_vector());
    a * (share * angle).cos() + aside * (share * angle).sin()
}

fn lerp(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
}

/// Unit direction at a right angle to a line; upwards if the line has no length.
fn across(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    unit([a[1] - b[1], b[0] - a[0]])
}

/// Unit direction; upwards of nothing.
fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = x.hypot(y);
    match length > 1e-9 {
        true => [x / length, y / length],
        false => [0.0, -1.0],
    }
}

/// This direction or the opposite one, whichever points upwards in the picture; of level ones the
/// one to the right.
fn upwards([x, y]: [f64; 2]) -> [f64; 2] {
    match y < -1e-6 || (y.abs() <= 1e-6 && x > 0.0) {
        true => [x, y],
        false => [-x, -y],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::measuring::Measured;

    const SIZE: [f64; 2] = [400.0, 300.0];

    fn camera() -> Camera {
        Camera::new(DVec3::Z * 100.0, DVec3::ZERO, DVec3::Y, 1.0).expect("a camera")
    }

    fn shown(shape: FigureShape) -> Option<Annotation> {
        let figure = Figure {
            shape,
            label: vec!["12.0 µm".into()],
            measured: Measured::Diameter(12.0),
        };
        annotation(&figure, &camera(), SIZE, 14.0)
    }

    #[test]
    fn a_diameter_is_as_long_as_the_neurite_is_wide() {
        let shape = FigureShape::Diameter {
            center: DVec3::ZERO,
            along: DVec3::Y,
            radius: 6.0,
        };
        let drawn = shown(shape).expect("in front");
        let [a, b] = [drawn.lines[0].points[0], drawn.lines[0].points[1]];
        let pixel = camera().pixel_size(300.0).at(100.0);
        assert!(((b[0] - a[0]).abs() * pixel - 12.0).abs() < 1e-6);
        assert!((a[1] - 150.0).abs() < 1e-9 && (b[1] - a[1]).abs() < 1e-9);
        assert!(drawn.label_at[0] > 200.0 + 6.0 / pixel, "beside it");
    }

    #[test]
    fn dashes_end_where_the_line_does() {
        let ends = [DVec3::X * -30.0, DVec3::X * 30.0];
        let path = vec![ends[0], DVec3::Y * 9.0, ends[1]];
        let drawn = shown(FigureShape::Distance { ends, path }).expect("in front");
        let dashes: Vec<&AnnotationLine> = drawn.lines.iter().filter(|l| l.width == THIN).collect();
        assert!(dashes.len() > 5);
        let last = dashes.last().expect("some").points[1];
        let end = camera().pixel_of(ends[1], [400, 300]).expect("in front");
        assert!(
            last[0] <= end[0] + 1e-6 && last[0] > end[0] - 14.0,
            "{last:?}"
        );
        assert!(drawn.label_at[1] < 150.0, "above the line");
    }

    #[test]
    fn labels_do_not_cover_one_another() {
        let figure = |x: f64| Figure {
            shape: FigureShape::Distance {
                ends: [DVec3::X * (x - 20.0), DVec3::X * (x + 20.0)],
                path: Vec::new(),
            },
            label: vec!["40.0 µm".into()],
            measured: Measured::Diameter(40.0),
        };
        let figures = [figure(0.0), figure(1.0), figure(2.0)];
        let drawn = annotations(&figures, &camera(), SIZE, 14.0);
        let mut places: Vec<f64> = drawn.iter().flatten().map(|a| a.label_at[1]).collect();
        places.sort_by(f64::total_cmp);
        assert_eq!(places.len(), 3);
        assert!(places.windows(2).all(|p| p[1] - p[0] > 20.0), "{places:?}");
    }

    #[test]
    fn what_is_behind_the_eye_is_not_drawn() {
        let ends = [DVec3::ZERO, DVec3::Z * 200.0];
        let path = Vec::new();
        assert_eq!(shown(FigureShape::Distance { ends, path }), None);
        let shape = FigureShape::Angle {
            center: DVec3::ZERO,
            branches: vec![DVec3::X, -DVec3::X],
            radius: 1.0,
        };
        let arc = shown(shape).expect("in front");
        let numbers = arc.lines.iter().flat_map(|l| l.points.iter().flatten());
        assert!(numbers.copied().all(f64::is_finite), "opposite branches");
    }
}
