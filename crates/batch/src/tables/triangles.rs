//! A row for each triangle, with where on the tracing it is.
//!
//! A triangle has a sample and a section by the rule of all files ([`FaceLabel`]). Its place is where
//! its center falls on the traced line of the section, as share of the length of the line: 0 at its
//! start, 1 at its end. A section that hangs on another starts at that one's last point, as in
//! `info`; NEURON and SONATA (`section_pos`) count alike. Triangles of the soma have 0.5.

use std::collections::HashMap;
use std::io::{self, Seek, Write};

use glam::DVec3;
use neurotess_mesh::{FaceLabel, Surface, SurfaceTriangle, WriteError, write_triangles};
use neurotess_morphology::{Attachment, Morphology, SampleLabels};

const HEADER: &str = "triangle,sample,section,position,type\n";

/// The place of what has none: the middle.
const MIDDLE: f64 = 0.5;

/// Writes the table of a surface in the coordinates of its tracing (µm).
pub(super) fn write<W: Write + Seek>(
    surface: &dyn Surface,
    morphology: &Morphology,
    out: &mut W,
) -> Result<(), WriteError> {
    let lines = Lines::of(morphology);
    out.write_all(HEADER.as_bytes())?;
    write_triangles(surface, out, |row, triangle| {
        // Writing into memory does not fail.
        let _: io::Result<()> = push(row, triangle, &lines);
    })
}

fn push(row: &mut Vec<u8>, triangle: &SurfaceTriangle, lines: &Lines<'_>) -> io::Result<()> {
    let SurfaceTriangle {
        number,
        label,
        center,
    } = triangle;
    let position = lines.position(*label, *center);
    let FaceLabel {
        point,
        section,
        kind,
    } = label;
    let sample = lines.labels.own_number(i64::from(*point));
    writeln!(row, "{number},{sample},{section},{position:.6},{kind}")
}

/// The traced lines of all sections.
struct Lines<'m> {
    sections: Vec<Line>,
    labels: SampleLabels<'m>,
    /// Where on its line a sample is, by section and number in the mesh.
    samples: HashMap<(usize, i32), usize>,
}

/// A line through the points of a section, and the point that it hangs on.
struct Line {
    points: Vec<DVec3>,
    /// Length (µm) from the start to each point.
    lengths: Vec<f64>,
}

impl<'m> Lines<'m> {
    fn of(morphology: &'m Morphology) -> Self {
        let labels = morphology.sample_labels();
        let mut samples = HashMap::new();
        let mut sections = Vec::with_capacity(morphology.sections.len());
        for (n, section) in morphology.sections.iter().enumerate() {
            let start = match section.attachment {
                Attachment::Section(parent) => Some(morphology.sections[parent.index()].end - 1),
                Attachment::Soma { .. } | Attachment::Free => None,
            };
            let points = start.map(|p| p as usize).into_iter().chain(section.range());
            let mut line = Line {
                points: Vec::new(),
                lengths: Vec::new(),
            };
            for point in points {
                let at = morphology.points[point].position.as_dvec3() + morphology.origin;
                samples.insert((n, labels.of_point(point)), line.points.len());
                line.push(at);
            }
            sections.push(line);
        }
        Self {
            sections,
            labels,
            samples,
        }
    }

    /// Where on its section a triangle is, as share of the section's length.
    fn position(&self, label: FaceLabel, center: DVec3) -> f64 {
        let section = usize::try_from(label.section)
            .ok()
            .and_then(|n| n.checked_sub(1));
        let Some(section) = section else {
            return MIDDLE;
        };
        let Some(line) = self.sections.get(section) else {
            return MIDDLE;
        };
        let sample = (section, label.point);
        line.share(self.samples.get(&sample).copied().unwrap_or(0), center)
    }
}

impl Line {
    fn push(&mut self, point: DVec3) {
        let length = match (self.points.last(), self.lengths.last()) {
            (Some(last), Some(length)) => length + last.distance(point),
            _ => 0.0,
        };
        self.points.push(point);
        self.lengths.push(length);
    }

    /// The share of the length where a place falls on the line. The search begins at a point and goes
    /// on along the line as long as the line comes nearer: other parts of a section may be near, too.
    fn share(&self, from: usize, place: DVec3) -> f64 {
        let total = self.lengths.last().copied().unwrap_or(0.0);
        let segments = self.points.len().saturating_sub(1);
        if segments == 0 || total <= 0.0 {
            return MIDDLE;
        }
        let mut best = self.nearest(from.min(segments - 1), place);
        for direction in [-1, 1] {
            let mut segment = from;
            while let Some(next) = segment.checked_add_signed(direction)
                && next < segments
            {
                let found = self.nearest(next, place);
                if found.0 >= best.0 && next.abs_diff(from) > 1 {
                    break;
                }
                if found.0 < best.0 {
                    best = found;
                }
                segment = next;
            }
        }
        (best.1 / total).clamp(0.0, 1.0)
    }

    /// The squared distance of a place from a segment, and the length up to where it is nearest.
    fn nearest(&self, segment: usize, place: DVec3) -> (f64, f64) {
        let (a, b) = (self.points[segment], self.points[segment + 1]);
        let along = b - a;
        let square = along.length_squared();
        let t = if square > 0.0 {
            ((place - a).dot(along) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let length =
            self.lengths[segment] + t * (self.lengths[segment + 1] - self.lengths[segment]);
        (place.distance_squared(a + along * t), length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f64; 3]]) -> Line {
        let mut line = Line {
            points: Vec::new(),
            lengths: Vec::new(),
        };
        for &point in points {
            line.push(point.into());
        }
        line
    }

    #[test]
    fn a_place_falls_on_the_line() {
        let line = line(&[[0., 0., 0.], [4., 0., 0.], [4., 4., 0.], [4., 8., 0.]]);
        for (from, place, share) in [
            (0, [1., 1., 0.], 1. / 12.),
            (1, [1., 1., 0.], 1. / 12.),
            (2, [5., 5., 1.], 9. / 12.),
            (0, [5., 5., 1.], 9. / 12.),
            (3, [-1., 0., 0.], 0.),
            (3, [4., 9., 0.], 1.),
        ] {
            let found = line.share(from, place.into());
            assert!(
                (found - share).abs() < 1e-9,
                "{place:?}: {found}, not {share}"
            );
        }
    }

    #[test]
    fn a_line_that_comes_back_is_searched_near_the_sample() {
        let hairpin = line(&[
            [0., 0., 0.],
            [9., 0., 0.],
            [18., 0., 0.],
            [18., 1., 0.],
            [9., 1., 0.],
            [0., 1., 0.],
        ]);
        let place = DVec3::new(1.0, 0.6, 0.0);
        assert!(hairpin.share(0, place) < 0.1);
        assert!(hairpin.share(5, place) > 0.9);
    }

    #[test]
    fn what_has_no_length_is_in_the_middle() {
        assert_eq!(line(&[[1., 1., 1.]]).share(0, DVec3::ZERO), MIDDLE);
        assert_eq!(
            line(&[[1., 1., 1.], [1., 1., 1.]]).share(1, DVec3::ZERO),
            MIDDLE
        );
    }
}
