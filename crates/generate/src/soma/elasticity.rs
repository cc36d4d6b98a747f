//! Static linear elasticity on linear tetrahedra.
//!
//! **Theory.** Isotropic material, Young's modulus 1 (it cancels, as only displacements are
//! prescribed), Poisson ratio ν. The stiffness of a tetrahedron of volume V with shape gradients gᵢ
//! is, for nodes i and j, the 3×3 block `V (λ gᵢ gⱼᵀ + μ gⱼ gᵢᵀ + μ (gᵢ·gⱼ) I)`, with
//! λ = ν / ((1 + ν)(1 − 2ν)) and μ = 1 / (2 (1 + ν)) (Zienkiewicz & Taylor, The Finite Element
//! Method, vol. 1, 5th ed., chapter 6, written without the B matrix).
//!
//! **Practice.** K depends on the sphere and ν alone, so it is factored once. A soma prescribes the
//! displacements g of a few surface nodes c. With G = K⁻¹ the forces f that do so solve
//! `G_cc f = g`, and the displacements of all nodes are `K⁻¹ f`: one small dense solve and one pair
//! of triangular sweeps. Columns of G are solved for at their first use and kept.

use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::cholesky::{Cholesky, Clique, Columns, NO_NODE};
use super::sphere::{self, Sphere};

/// Columns of G that are solved for at once: of 4, 6, 8 and 12 the quickest on spheres of up to 6,000
/// nodes.
const COLUMNS: usize = 4;

/// The factored stiffness of a sphere.
pub(crate) struct Elasticity {
    /// First of a node's three equations, or `None` for an anchored node.
    equation: Vec<Option<usize>>,
    equations: usize,
    surface_equations: usize,
    factor: Cholesky,
    /// Columns of G restricted to surface equations.
    columns: Mutex<Vec<Option<Box<[f64]>>>>,
}

impl Elasticity {
    /// Assembles and factors; `None` if the matrix is not positive definite (ν out of range).
    pub(crate) fn new(sphere: &Sphere, poisson: f64) -> Option<Self> {
        let mut free = Vec::new();
        let mut number = Vec::with_capacity(sphere.nodes.len());
        for (node, &point) in sphere.nodes.iter().enumerate() {
            let moves = !sphere.anchored(node);
            number.push(moves.then_some(free.len() as u32));
            free.extend(moves.then_some(point));
        }
        let free_corners = |corners: &[u32; 4]| {
            let corners = corners.map(|node| number[node as usize]);
            corners.map(|node| node.unwrap_or(NO_NODE))
        };
        let elements: Vec<Clique> = sphere.tetrahedra.iter().map(free_corners).collect();
        let stiffness = |index: usize| element(&sphere.nodes, sphere.tetrahedra[index], poisson);
        let surface_equations = 3 * sphere.surface;
        Some(Self {
            equation: number
                .into_iter()
                .map(|number| number.map(|number| 3 * number as usize))
                .collect(),
            equations: 3 * free.len(),
            surface_equations,
            factor: Cholesky::new(&free, &elements, &stiffness)?,
            columns: Mutex::new(vec![None; surface_equations]),
        })
    }

    /// Displacement of every node when some surface nodes are moved as prescribed.
    ///
    /// `None` if the prescription is singular (a node named twice). Nodes that are anchored stay.
    pub(crate) fn solve(&self, prescribed: &[(u32, DVec3)]) -> Option<Vec<DVec3>> {
        let constrained: Vec<usize> = prescribed
            .iter()
            .filter_map(|&(node, _)| self.equation[node as usize])
            .flat_map(|first| first..first + 3)
            .collect();
        let goals = prescribed.iter().flat_map(|(_, goal)| goal.to_array());
        let mut small: Vec<[f64; 1]> = goals.map(|goal| [goal]).collect();
        let compliance = self.compliance(&constrained).factor()?;
        compliance.forward(&mut small);
        compliance.backward(&mut small);
        let mut forces = vec![[0.0]; self.equations];
        for (&equation, force) in constrained.iter().zip(small) {
            forces[equation] = force;
        }
        self.factor.solve(&mut forces);
        let displacement =
            |first: usize| DVec3::from_array([0, 1, 2].map(|i| forces[first + i][0]));
        Some(
            self.equation
                .iter()
                .map(|e| e.map_or(DVec3::ZERO, displacement))
                .collect(),
        )
    }

    fn lock_columns(&self) -> MutexGuard<'_, Vec<Option<Box<[f64]>>>> {
        let columns = self.columns.lock();
        columns.unwrap_or_else(PoisonError::into_inner)
    }

    /// Up to [`COLUMNS`] columns of G, restricted to surface equations.
    fn solve_columns(&self, equations: &[usize]) -> impl Iterator<Item = Box<[f64]>> {
        let mut unit = vec![[0.0; COLUMNS]; self.equations];
        for (column, &equation) in equations.iter().enumerate() {
            unit[equation][column] = 1.0;
        }
        self.factor.solve(&mut unit);
        unit.truncate(self.surface_equations);
        (0..equations.len()).map(move |column| unit.iter().map(|row| row[column]).collect())
    }

    /// The rows and columns of G that belong to the constrained equations.
    fn compliance(&self, constrained: &[usize]) -> Columns {
        let missing: Vec<usize> = {
            let columns = self.lock_columns();
            let missing = constrained.iter().filter(|&&c| columns[c].is_none());
            missing.copied().collect()
        };
        // Not while the columns are locked: a thread that waits here may take up another soma.
        let solved: Vec<Box<[f64]>> = missing
            .par_chunks(COLUMNS)
            .flat_map_iter(|equations| self.solve_columns(equations))
            .collect();
        let mut columns = self.lock_columns();
        for (equation, column) in missing.into_iter().zip(solved) {
            columns[equation] = Some(column);
        }
        let columns: Vec<&[f64]> = constrained
            .iter()
            .map(|&c| columns[c].as_deref().expect("solved for above"))
            .collect();
        Columns::from_fn(constrained.len(), |row, column| {
            columns[column][constrained[row]]
        })
    }
}

/// Stiffness blocks of one tetrahedron, E = 1.
pub(crate) fn element(nodes: &[DVec3], tetrahedron: [u32; 4], poisson: f64) -> [[DMat3; 4]; 4] {
    let lambda = poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let mu = 0.5 / (1.0 + poisson);
    let volume = sphere::volume(nodes, tetrahedron);
    let gradients = shape_gradients(nodes, tetrahedron);
    gradients.map(|gi| {
        gradients.map(|gj| {
            let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
            (outer(gi, gj) * lambda + outer(gj, gi) * mu + DMat3::IDENTITY * (mu * gi.dot(gj)))
                * volume
        })
    })
}

/// Gradients of the four linear shape functions.
fn shape_gradients(nodes: &[DVec3], tetrahedron: [u32; 4]) -> [DVec3; 4] {
    let [a, b, c, d] = tetrahedron.map(|i| nodes[i as usize]);
    let inverse = DMat3::from_cols(b - a, c - a, d - a).inverse().transpose();
    let [gb, gc, gd] = [inverse.x_axis, inverse.y_axis, inverse.z_axis];
    [-(gb + gc + gd), gb, gc, gd]
}

#[cfg(test)]
mod tests;
