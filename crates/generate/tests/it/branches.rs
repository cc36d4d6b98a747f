//! Trees of a few branches.

use glam::Vec3;
use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Point, Section};

/// Adds a branch of points with radii (µm).
pub(crate) fn add(
    m: &mut Morphology,
    attachment: Attachment,
    points: impl IntoIterator<Item = (Vec3, f32)>,
) {
    let first = m.points.len() as u32;
    for (position, radius) in points {
        m.sample_ids.push(m.points.len() as i64 + 1);
        m.points.push(Point { position, radius });
    }
    m.sections.push(Section {
        kind: NeuriteKind(3),
        attachment,
        first,
        end: m.points.len() as u32,
    });
}
