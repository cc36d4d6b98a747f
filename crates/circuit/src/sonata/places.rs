//! Where nodes are: `positions` of a group, or its `x`, `y` and `z`, or those of node types.
//!
//! bmtk's builder writes `positions`, a row of two or three numbers a node, and some files have `position`; it reads
//! them before `x`, `y` and `z`, of which those that are not there are 0, and has nodes of a group without any of
//! them at the origin (`bionet/sonata_adaptors.py`). Blue Brain's files have `x`, `y` and `z`.

use glam::DVec3;

use crate::sonata::nodes::Table;
use crate::sonata::notes::{Broken, Notes};
use crate::{CircuitError, Population};

const AXES: [&str; 3] = ["x", "y", "z"];
/// In the order of preference.
const VECTORS: [&str; 2] = ["positions", "position"];

/// What is known of places beside the places themselves.
pub(crate) struct Placed {
    /// Names of the attributes that were read as places.
    pub(crate) read_from: Vec<&'static str>,
    /// Whether a node's group has places, though perhaps none of this node.
    pub(crate) has_place: Vec<bool>,
}

/// Reads the places of all nodes; NaN where there is none, or none that makes sense.
pub(crate) fn read(
    table: &Table,
    population: &mut Population,
    broken: &mut Broken,
    notes: &mut Notes,
) -> Result<Placed, CircuitError> {
    let mut placed = Placed {
        read_from: AXES.to_vec(),
        has_place: vec![false; population.len()],
    };
    let mut faulty = of_axes(table, population, &mut placed)?;
    let mut overridden = vec![false; population.len()];
    for name in VECTORS {
        for vectors in table.vectors(name)? {
            if !placed.read_from.contains(&name) {
                placed.read_from.push(name);
            }
            let mut own = Vec::new();
            for (node, vector) in vectors.rows {
                let row = node as usize;
                if overridden[row] {
                    continue;
                }
                population.positions[row] = DVec3::from_array(vector);
                placed.has_place[row] = true;
                overridden[row] = true;
                let all_nan = vector.iter().all(|c| c.is_nan());
                let wrong = vector.into_iter().find(|c| !c.is_finite());
                own.extend(wrong.filter(|_| !all_nan).map(|value| (row, value)));
            }
            broken.mark(vectors.path, &own, false, notes);
        }
    }
    for (axis, rows) in AXES.into_iter().zip(&mut faulty) {
        rows.retain(|&(row, _)| !overridden[row]);
        broken.mark(table.key(axis), rows, false, notes);
    }
    for (row, _) in broken.rows.iter().enumerate().filter(|&(_, &b)| b) {
        population.positions[row] = DVec3::NAN;
    }
    Ok(placed)
}

/// Reads `x`, `y` and `z`. Of each, gives the rows that make no sense, and what stands there.
fn of_axes(
    table: &Table,
    population: &mut Population,
    placed: &mut Placed,
) -> Result<[Vec<(usize, f64)>; 3], CircuitError> {
    let mut faulty = [const { Vec::new() }; 3];
    let columns = AXES.map(|axis| table.numbers(axis));
    let [x, y, z] = columns;
    let columns = [x?, y?, z?];
    if columns.iter().all(Option::is_none) {
        return Ok(faulty);
    }
    let with = AXES.map(|axis| table.rows_with(axis));
    for row in 0..population.len() {
        let value = |axis: usize| columns[axis].as_ref().map_or(f64::NAN, |c| c[row]);
        let mut place = [0, 1, 2].map(value);
        placed.has_place[row] = with.iter().any(|with| with[row]);
        // One without any coordinate, as in a group of virtual nodes, has no place.
        if place.iter().all(|c| c.is_nan()) {
            continue;
        }
        for (axis, faulty) in faulty.iter_mut().enumerate() {
            if place[axis].is_nan() && !with[axis][row] {
                place[axis] = 0.0;
            }
            if !place[axis].is_finite() {
                faulty.push((row, place[axis]));
            }
        }
        population.positions[row] = DVec3::from_array(place);
    }
    Ok(faulty)
}
