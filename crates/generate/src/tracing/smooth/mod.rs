//! Noise of the tracing is smoothed away: jumps between focal planes, jitter of a mouse, steps of pixels.
//!
//! Each section is smoothed by itself, as [`neurotess_morphology::smoothing`] explains: the unbranched run of the
//! skeleton between roots, forks and ends, which stay.
//!
//! # Practice
//! [`smooth`] goes through the sections, `report` is what came of it. Time is linear in the number of points.

mod report;
#[cfg(test)]
mod tests;

pub use report::Smoothing;

use neurotess_morphology::smoothing::{auto_length, smooth_line};

use crate::options::Smooth;
use crate::tracing::mend;
use crate::tracing::{Children, NONE, Shapes, Skeleton};
use crate::warning::Warnings;

/// Smooths all sections; nothing if that is not asked for.
pub(crate) fn smooth(
    skeleton: &mut Skeleton,
    amount: Smooth,
    warnings: &mut Warnings,
) -> Option<Smoothing> {
    let length = match amount {
        Smooth::Auto => None,
        Smooth::Length(length) if length > 0.0 => Some(length),
        Smooth::None | Smooth::Length(_) => return None,
    };
    let traced = skeleton.nodes().to_vec();
    let mut free = Vec::new();
    let (mut shapes, children) = skeleton.shapes();
    for end in 0..traced.len() as u32 {
        let Some(section) = Section::ending_at(end, &shapes, children) else {
            continue;
        };
        let length = length.unwrap_or_else(|| section.auto_length(&shapes));
        section.smooth(&mut shapes, length);
        free.extend(section.inner());
    }
    let report = Smoothing::new(&traced, skeleton, &free);
    // A section that ended where it began is now in one place.
    mend::merge_coincident(skeleton, warnings);
    Some(report)
}

/// An unbranched run of nodes.
#[derive(Debug)]
struct Section {
    /// From the root or fork to the next fork or end.
    nodes: Vec<u32>,
    begins_at_fork: bool,
}

impl Section {
    /// The section that ends at a node, if one does and it has points to move.
    fn ending_at(end: u32, shapes: &Shapes<'_>, children: &Children) -> Option<Self> {
        if children.of(end).len() == 1 {
            return None;
        }
        let mut nodes = vec![end];
        let mut here = shapes.node(end).parent;
        while here != NONE {
            nodes.push(here);
            if children.of(here).len() > 1 {
                break;
            }
            here = shapes.node(here).parent;
        }
        nodes.reverse();
        (nodes.len() > 2).then_some(Self {
            nodes,
            begins_at_fork: here != NONE,
        })
    }

    /// Nodes that may move.
    fn inner(&self) -> &[u32] {
        &self.nodes[1..self.nodes.len() - 1]
    }

    /// By the radii that are the section's own (µm).
    fn auto_length(&self, shapes: &Shapes<'_>) -> f64 {
        let own = self.nodes[1..].iter();
        let mut radii: Vec<f64> = own.map(|&i| shapes.node(i).radius).collect();
        auto_length(&mut radii)
    }

    fn smooth(&self, shapes: &mut Shapes<'_>, length: f64) {
        let nodes = self.nodes.iter().map(|&i| shapes.node(i));
        let (mut centers, mut radii): (Vec<_>, Vec<_>) =
            nodes.map(|node| (node.center, node.radius)).unzip();
        smooth_line(&mut centers, &mut radii, length, self.begins_at_fork);
        let inner = 1..self.nodes.len() - 1;
        for (i, &node) in inner.clone().zip(&self.nodes[inner]) {
            shapes.set_center(node, centers[i]);
            shapes.set_radius(node, radii[i]);
        }
    }
}
