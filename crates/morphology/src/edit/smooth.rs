//! Noise, smoothed away section by section.

use glam::DVec3;

use super::nodes::{Edits, Nodes};
use super::{EditError, positive};
use crate::smoothing::{SmoothingLength, auto_length, smooth_line};
use crate::{Morphology, SectionId};

pub(super) fn smooth(
    morphology: &Morphology,
    nodes: &Nodes,
    length: SmoothingLength,
) -> Result<Edits, EditError> {
    if let SmoothingLength::Length(length) = length {
        positive("the smoothing length", length)?;
    }
    let mut edited = nodes.nodes.clone();
    for id in (0..morphology.sections.len() as u32).map(SectionId) {
        let begins_at_fork = morphology.sections[id.index()].parent().is_some();
        let line = nodes.of_section(morphology, id);
        let traced = line.iter().map(|&i| &nodes.nodes[i]);
        let (mut centers, mut radii): (Vec<DVec3>, Vec<f64>) =
            traced.map(|node| (node.position, node.radius)).unzip();
        let length = match length {
            SmoothingLength::Length(length) => length,
            SmoothingLength::Auto => {
                auto_length(&mut radii[usize::from(begins_at_fork)..].to_vec())
            }
        };
        if length > 0.0 {
            smooth_line(&mut centers, &mut radii, length, begins_at_fork);
        }
        let inner = 1..line.len().saturating_sub(1).max(1);
        for i in inner {
            edited[line[i]].position = centers[i];
            edited[line[i]].radius = radii[i];
        }
    }
    Ok(Edits::in_place(edited))
}
