//! Edits of each sample by itself: types, units, and where the cell is.

use glam::{DAffine3, DMat3, DVec3};

use super::nodes::{Edits, Nodes, global};
use super::{EditError, positive};
use crate::{Morphology, NeuriteKind, Node};

pub(super) fn retype(nodes: &Nodes, types: &[(NeuriteKind, NeuriteKind)]) -> Edits {
    each(nodes, |node| {
        let renamed = types.iter().find(|(from, _)| *from == node.kind);
        node.kind = renamed.map_or(node.kind, |&(_, to)| to);
    })
}

pub(super) fn scale(nodes: &Nodes, factors: DVec3) -> Result<Edits, EditError> {
    for factor in factors.to_array() {
        positive("the scale", factor)?;
    }
    // Exact where both are the same.
    let in_plane = match factors.x == factors.y {
        true => factors.x,
        false => (factors.x * factors.y).sqrt(),
    };
    let mut edits = moved(nodes, |place| place * factors);
    for node in &mut edits.nodes {
        node.radius *= in_plane;
    }
    Ok(edits)
}

pub(super) fn place(nodes: &Nodes, placement: &DAffine3) -> Result<Edits, EditError> {
    let factor = positive("the scale", placement.matrix3.determinant().abs().cbrt())?;
    // A rotation leaves radii as they are, to the last digit.
    let factor = if (factor - 1.0).abs() < 1e-12 {
        1.0
    } else {
        factor
    };
    let mut edits = moved(nodes, |place| placement.transform_point3(place));
    for node in &mut edits.nodes {
        node.radius *= factor;
    }
    Ok(edits)
}

pub(super) fn recenter(morphology: &Morphology, nodes: &Nodes) -> Edits {
    let soma = morphology.soma().map(|s| s.center.as_dvec3());
    let center = match (soma, morphology.points.first()) {
        (Some(center), _) => morphology.origin + center,
        (None, Some(root)) => global(morphology, root),
        (None, None) => DVec3::ZERO,
    };
    moved(nodes, |place| place - center)
}

pub(super) fn rotate(nodes: &Nodes, axis: DVec3, angle: f64) -> Result<Edits, EditError> {
    let Some(axis) = axis.try_normalize() else {
        return Err(EditError::Number {
            what: "the length of the axis",
            value: axis.length(),
            must: "above 0 and finite",
        });
    };
    if !angle.is_finite() {
        return Err(EditError::Number {
            what: "the angle",
            value: angle,
            must: "finite",
        });
    }
    let turn = exact_quarters(DMat3::from_axis_angle(axis, angle));
    Ok(moved(nodes, |place| turn * place))
}

/// Entries that are a rounding error from 0, 1 and −1 become these: a quarter turn around an axis then moves
/// coordinates without a trace in their last digits.
fn exact_quarters(turn: DMat3) -> DMat3 {
    let exact = |entry: f64| match (entry - entry.round()).abs() < 1e-15 {
        true => entry.round() + 0.0,
        false => entry,
    };
    DMat3::from_cols_array(&turn.to_cols_array().map(exact))
}

pub(super) fn mirror(nodes: &Nodes, axis: usize) -> Result<Edits, EditError> {
    if axis > 2 {
        return Err(EditError::Axis { axis });
    }
    // Not −0, which files would show.
    Ok(moved(nodes, |mut place| {
        place[axis] = 0.0 - place[axis];
        place
    }))
}

/// Samples, and spines that are not in the tree, at other places.
fn moved(nodes: &Nodes, to: impl Fn(DVec3) -> DVec3) -> Edits {
    Edits {
        spines: Some(nodes.spines.iter().map(|&spine| to(spine)).collect()),
        ..each(nodes, |node| node.position = to(node.position))
    }
}

fn each(nodes: &Nodes, edit: impl Fn(&mut Node)) -> Edits {
    let mut edited = nodes.nodes.clone();
    edited.iter_mut().for_each(edit);
    Edits::in_place(edited)
}
