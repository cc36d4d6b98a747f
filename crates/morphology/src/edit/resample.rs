//! Samples at equal distances along each section.
//!
//! ```text
//! ●──○─────○─○──────●   traced: root, samples, fork
//! ●────○────○────○──●   resampled: the same length in equal parts, ends kept
//! ```
//!
//! The new samples are on the traced line, so a section becomes shorter by what its bends cut off. A section
//! without length keeps its last sample. All samples are numbered anew: between those that a file numbered
//! there would be no number left.

use glam::DVec3;

use super::nodes::{Edits, Nodes};
use super::{EditError, positive};
use crate::{Morphology, Node, SectionId};

/// Most samples that are made: some gigabytes.
const MOST: f64 = 1e8;

pub(super) fn resample(
    morphology: &Morphology,
    nodes: &Nodes,
    spacing: f64,
) -> Result<Edits, EditError> {
    positive("the spacing", spacing)?;
    let ids = || (0..morphology.sections.len() as u32).map(SectionId);
    let line = |id| Line::of(&nodes.nodes, &nodes.of_section(morphology, id));
    let samples: f64 = ids().map(|id| line(id).parts(spacing) + 1.0).sum();
    if samples > MOST {
        return Err(EditError::TooMany { spacing, samples });
    }
    let mut edited = nodes.nodes[..nodes.somata].to_vec();
    // The new node of the last point of each section.
    let mut lasts: Vec<u32> = Vec::with_capacity(morphology.sections.len());
    let mut largest_move = 0.0_f64;
    for id in ids() {
        let section = &morphology.sections[id.index()];
        let line = line(id);
        let parts = line.parts(spacing) as usize;
        let first = nodes.nodes[nodes.of_point(section.first as usize)];
        let parent = section.parent();
        let mut parent = match parent {
            Some(above) => Some(lasts[above.index()]),
            None => first.parent,
        };
        let begins = usize::from(section.parent().is_some());
        let samples = line.samples(parts);
        largest_move = largest_move.max(line.farthest_from(&samples));
        let begins = begins.min(samples.len() - 1);
        for (part, &(position, radius)) in samples.iter().enumerate().skip(begins) {
            let next = edited.len() as u32;
            // A new sample is from the section of the file that the traced one behind it is from.
            let behind = line
                .first_behind(part, parts)
                .max(usize::from(section.parent().is_some()));
            let behind = nodes.of_point(section.range().end) + behind - line.points.len();
            edited.push(Node {
                id: 0,
                kind: section.kind,
                position,
                radius,
                parent: parent.replace(next),
                section: nodes.nodes[behind].section,
            });
        }
        lasts.push(edited.len() as u32 - 1);
    }
    Ok(Edits {
        largest_move: Some(largest_move),
        renumbered: true,
        ..Edits::in_place(edited)
    })
}

/// A section's centers and radii by their distance along it.
struct Line {
    /// Center, radius, and distance (µm) from the start.
    points: Vec<(DVec3, f64, f64)>,
}

impl Line {
    fn of(nodes: &[Node], of_section: &[usize]) -> Self {
        let mut length = 0.0;
        let mut points: Vec<(DVec3, f64, f64)> = Vec::with_capacity(of_section.len());
        for &node in of_section {
            let node = &nodes[node];
            length += points
                .last()
                .map_or(0.0, |last| last.0.distance(node.position));
            points.push((node.position, node.radius, length));
        }
        Self { points }
    }

    fn length(&self) -> f64 {
        self.points.last().map_or(0.0, |last| last.2)
    }

    /// How many equal parts are nearest to the spacing: a whole number, 0 without length.
    fn parts(&self, spacing: f64) -> f64 {
        match self.length() {
            length if length > 0.0 => (length / spacing).round().max(1.0),
            _ => 0.0,
        }
    }

    /// The ends of the parts, one more than these; the first and the last are the traced ones.
    fn samples(&self, parts: usize) -> Vec<(DVec3, f64)> {
        let (first, last) = (0, self.points.len() - 1);
        let traced = |i: usize| (self.points[i].0, self.points[i].1);
        if parts == 0 {
            return vec![traced(last)];
        }
        let mut samples = vec![traced(first)];
        let mut left = 0;
        for part in 1..parts {
            let at = self.length() * part as f64 / parts as f64;
            while left + 2 < self.points.len() && self.points[left + 1].2 < at {
                left += 1;
            }
            let (from, to) = (self.points[left], self.points[left + 1]);
            let step = to.2 - from.2;
            let share = if step > 0.0 {
                ((at - from.2) / step).clamp(0.0, 1.0)
            } else {
                0.0
            };
            samples.push((from.0.lerp(to.0, share), from.1 + share * (to.1 - from.1)));
        }
        samples.push(traced(last));
        samples
    }

    /// Index of the first traced point that is not before the end of a part.
    fn first_behind(&self, part: usize, parts: usize) -> usize {
        let at = self.length() * part as f64 / parts.max(1) as f64;
        let before = self.points.partition_point(|point| point.2 < at);
        before.min(self.points.len() - 1)
    }

    /// The greatest distance of a traced point from the piece of the new line that is as far along.
    fn farthest_from(&self, samples: &[(DVec3, f64)]) -> f64 {
        let parts = samples.len() - 1;
        if parts == 0 {
            return 0.0;
        }
        let distance = |&(center, _, at): &(DVec3, f64, f64)| {
            let part = ((at / self.length() * parts as f64) as usize).min(parts - 1);
            from_segment(center, samples[part].0, samples[part + 1].0).0
        };
        self.points.iter().map(distance).fold(0.0, f64::max)
    }
}

/// Distance of a place from a segment, and where on it the nearest place is, in [0, 1].
pub(super) fn from_segment(place: DVec3, from: DVec3, to: DVec3) -> (f64, f64) {
    let along = to - from;
    let squared = along.length_squared();
    let share = match squared > 0.0 {
        true => ((place - from).dot(along) / squared).clamp(0.0, 1.0),
        false => 0.0,
    };
    (place.distance(from + share * along), share)
}
