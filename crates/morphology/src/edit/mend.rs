//! Radii that cannot be right, interpolated along the tree.
//!
//! A radius is **bad** if it is not above 0, or if it is an outlier: more than so many times the median of the
//! three before it in its section and of the three after it, or less than the so-manieth part of both. So
//! tapers, steps and boutons stay, and up to two outliers in a row are found. Sections are looked at one by
//! one because radii change at forks; of fewer than five samples none is called an outlier.
//!
//! The nearest good radius above a sample and the nearest one below it, by way of any child, give the new
//! radius, each weighing by the distance of the other. A sample with one of both takes that; a neurite without
//! any good radius is left as it is.

use super::EditError;
use super::nodes::{Edits, Nodes};
use crate::{Morphology, SectionId};

/// Samples on each side of one that may be an outlier.
const AROUND: usize = 3;
/// Least samples of a section in which there are outliers.
const LEAST: usize = 5;

pub(super) fn mend_radii(
    morphology: &Morphology,
    nodes: &Nodes,
    outliers: Option<f64>,
) -> Result<Edits, EditError> {
    if let Some(factor) = outliers.filter(|factor| !(*factor > 1.0 && factor.is_finite())) {
        return Err(EditError::Number {
            what: "the factor of outliers",
            value: factor,
            must: "above 1 and finite",
        });
    }
    let good = good(morphology, nodes, outliers);
    let above = from_above(nodes, &good);
    let below = from_below(nodes, &good);
    let mut edited = nodes.nodes.clone();
    let mut left = 0;
    for i in (nodes.somata..edited.len()).filter(|&i| !good[i]) {
        match between(above[i], below[i]) {
            Some(radius) => edited[i].radius = radius,
            None => left += 1,
        }
    }
    Ok(Edits {
        left,
        ..Edits::in_place(edited)
    })
}

/// A good radius and how far it is (µm).
type Near = Option<(f64, f64)>;

fn between(above: Near, below: Near) -> Option<f64> {
    match (above, below) {
        (Some((upper, up)), Some((lower, down))) if up + down > 0.0 => {
            Some((upper * down + lower * up) / (up + down))
        }
        (Some((radius, _)), _) | (None, Some((radius, _))) => Some(radius),
        (None, None) => None,
    }
}

fn good(morphology: &Morphology, nodes: &Nodes, outliers: Option<f64>) -> Vec<bool> {
    let positive = |i: usize| nodes.nodes[i].radius > 0.0;
    let mut good: Vec<bool> = (0..nodes.nodes.len()).map(positive).collect();
    let Some(factor) = outliers else { return good };
    for id in (0..morphology.sections.len() as u32).map(SectionId) {
        let own = morphology.sections[id.index()].range();
        let own: Vec<usize> = own
            .map(|point| nodes.of_point(point))
            .filter(|&i| positive(i))
            .collect();
        if own.len() < LEAST {
            continue;
        }
        let radii: Vec<f64> = own.iter().map(|&i| nodes.nodes[i].radius).collect();
        for (k, &i) in own.iter().enumerate() {
            let before = median(&radii[k.saturating_sub(AROUND)..k]);
            let after = median(&radii[k + 1..radii.len().min(k + 1 + AROUND)]);
            let sides = || before.into_iter().chain(after);
            let too_thick = sides().all(|usual| radii[k] > usual * factor);
            let too_thin = sides().all(|usual| radii[k] * factor < usual);
            good[i] = !(too_thick || too_thin);
        }
    }
    good
}

/// Of an even number the mean of the middle two.
fn median(radii: &[f64]) -> Option<f64> {
    let mut radii = radii.to_vec();
    radii.sort_by(f64::total_cmp);
    let last = radii.len().checked_sub(1)?;
    Some(0.5 * (radii[last / 2] + radii[radii.len() / 2]))
}

/// For each node the nearest good radius on the way to the root, a soma's aside.
fn from_above(nodes: &Nodes, good: &[bool]) -> Vec<Near> {
    let mut above: Vec<Near> = vec![None; nodes.nodes.len()];
    for i in nodes.somata..nodes.nodes.len() {
        let Some(parent) = parent_in_neurite(nodes, i) else {
            continue;
        };
        above[i] = match good[parent] {
            true => Some((nodes.nodes[parent].radius, link(nodes, i, parent))),
            false => above[parent].map(|(r, way)| (r, way + link(nodes, i, parent))),
        };
    }
    above
}

/// For each node the nearest good radius among those that hang on it.
fn from_below(nodes: &Nodes, good: &[bool]) -> Vec<Near> {
    let mut below: Vec<Near> = vec![None; nodes.nodes.len()];
    for i in (nodes.somata..nodes.nodes.len()).rev() {
        let Some(parent) = parent_in_neurite(nodes, i) else {
            continue;
        };
        let found = match good[i] {
            true => Some((nodes.nodes[i].radius, 0.0)),
            false => below[i],
        };
        let found = found.map(|(r, way)| (r, way + link(nodes, i, parent)));
        // The first child of equally near ones counts: they come last here.
        let nearer = |(_, way): (f64, f64)| below[parent].is_none_or(|(_, other)| way <= other);
        if found.is_some_and(nearer) {
            below[parent] = found;
        }
    }
    below
}

fn parent_in_neurite(nodes: &Nodes, i: usize) -> Option<usize> {
    let parent = nodes.nodes[i].parent? as usize;
    (parent >= nodes.somata).then_some(parent)
}

fn link(nodes: &Nodes, a: usize, b: usize) -> f64 {
    nodes.nodes[a].position.distance(nodes.nodes[b].position)
}
