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
//! of triangular sweeps. Columns of G are made when first asked for and kept.

use std::sync::Mutex;

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use glam::{DMat3, DVec3};

use super::sphere::{self, Sphere};

/// The factored stiffness of a sphere.
pub(crate) struct Elasticity {
    /// Equation of a node's x, or `None` for an anchored node.
    equation: Vec<Option<usize>>,
    equations: usize,
    surface_equations: usize,
    factor: Llt<usize, f64>,
    /// Columns of G restricted to surface equations.
    columns: Mutex<Vec<Option<Box<[f64]>>>>,
}

impl Elasticity {
    /// Assembles and factors; `None` if the matrix is not positive definite (ν out of range).
    pub(crate) fn new(sphere: &Sphere, poisson: f64) -> Option<Self> {
        let mut equation = Vec::with_capacity(sphere.nodes.len());
        let mut equations = 0;
        for node in 0..sphere.nodes.len() {
            let free = !sphere.anchored(node);
            equation.push(free.then_some(equations));
            equations += 3 * usize::from(free);
        }
        let mut triplets = Vec::new();
        for &tetrahedron in &sphere.tetrahedra {
            let blocks = element(&sphere.nodes, tetrahedron, poisson);
            for (i, row) in blocks.iter().enumerate() {
                for (j, block) in row.iter().enumerate() {
                    let (row, column) = (tetrahedron[i] as usize, tetrahedron[j] as usize);
                    if let (Some(r), Some(c)) = (equation[row], equation[column]) {
                        push_lower(&mut triplets, r, c, block);
                    }
                }
            }
        }
        let matrix = SparseColMat::try_new_from_triplets(equations, equations, &triplets).ok()?;
        let factor = matrix.sp_cholesky(Side::Lower).ok()?;
        let surface_equations = 3 * sphere.surface;
        let columns = Mutex::new(vec![None; surface_equations]);
        Some(Self {
            equation,
            equations,
            surface_equations,
            factor,
            columns,
        })
    }

    /// Displacement of every node when some surface nodes are moved as prescribed.
    ///
    /// `None` if the prescription is singular (a node named twice).
    pub(crate) fn solve(&self, prescribed: &[(u32, DVec3)]) -> Option<Vec<DVec3>> {
        let constrained: Vec<usize> = prescribed
            .iter()
            .filter_map(|&(node, _)| self.equation[node as usize])
            .flat_map(|first| first..first + 3)
            .collect();
        let mut forces = Mat::zeros(self.equations, 1);
        if !constrained.is_empty() {
            let compliance = self.compliance(&constrained);
            let goal = Mat::from_fn(constrained.len(), 1, |i, _| prescribed[i / 3].1[i % 3]);
            let small = compliance.llt(Side::Lower).ok()?.solve(&goal);
            for (i, &equation) in constrained.iter().enumerate() {
                forces[(equation, 0)] = small[(i, 0)];
            }
            self.factor.solve_in_place(&mut forces);
        }
        let displacement =
            |first: usize| DVec3::from_array([0, 1, 2].map(|i| forces[(first + i, 0)]));
        Some(
            self.equation
                .iter()
                .map(|e| e.map_or(DVec3::ZERO, displacement))
                .collect(),
        )
    }

    /// The rows and columns of G that belong to the constrained equations.
    fn compliance(&self, constrained: &[usize]) -> Mat<f64> {
        let mut columns = self
            .columns
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let missing: Vec<usize> = constrained
            .iter()
            .copied()
            .filter(|&c| columns[c].is_none())
            .collect();
        if !missing.is_empty() {
            let mut unit = Mat::zeros(self.equations, missing.len());
            for (column, &equation) in missing.iter().enumerate() {
                unit[(equation, column)] = 1.0;
            }
            self.factor.solve_in_place(&mut unit);
            for (column, &equation) in missing.iter().enumerate() {
                let rows = 0..self.surface_equations;
                columns[equation] = Some(rows.map(|row| unit[(row, column)]).collect());
            }
        }
        Mat::from_fn(constrained.len(), constrained.len(), |i, j| {
            columns[constrained[j]]
                .as_ref()
                .map_or(0.0, |column| column[constrained[i]])
        })
    }
}

fn push_lower(triplets: &mut Vec<Triplet<usize, usize, f64>>, r: usize, c: usize, block: &DMat3) {
    for i in 0..3 {
        for j in 0..3 {
            if r + i >= c + j {
                triplets.push(Triplet::new(r + i, c + j, block.col(j)[i]));
            }
        }
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
