//! Static linear elasticity on linear tetrahedra.
//!
//! **Theory.** Isotropic material, Young's modulus 1 (it cancels, as only displacements are
//! prescribed), Poisson ratio ν. The stiffness of a tetrahedron of volume V with shape gradients gᵢ
//! is, for nodes i and j, the 3×3 block `V (λ gᵢ gⱼᵀ + μ gⱼ gᵢᵀ + μ (gᵢ·gⱼ) I)`, with
//! λ = ν / ((1 + ν)(1 − 2ν)) and μ = 1 / (2 (1 + ν)) (Zienkiewicz & Taylor, The Finite Element
//! Method, vol. 1, 5th ed., chapter 6, written without the B matrix).
//!
//! **Practice.** K depends on the sphere and ν alone, so it is factored once, in eight parts of an eighth of the
//! sphere ([`mirrors`]). A soma prescribes the displacements g of a few surface nodes c. With G = K⁻¹ the forces f
//! that do so solve `G_cc f = g`, and the displacements of the surface are `G f`: one small dense solve and a sum of
//! columns of G. These are solved for at their first use and kept. What lies inside is never asked for.

mod mirrors;

use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::cholesky::{Blocks, Cholesky, Clique, Columns, Elimination, NO_NODE};
use super::sphere::{self, Sphere};
use mirrors::{Image, Mirrors, Parity};

/// Columns of G that are solved for at once: of 4, 6, 8 and 12 the quickest on spheres of up to 6,000
/// nodes.
const COLUMNS: usize = 4;

/// The factored stiffness of a sphere.
pub(crate) struct Elasticity {
    mirrors: Mirrors,
    /// Number of surface nodes, which come first.
    surface: usize,
    /// By class of fields.
    fields: Vec<Field>,
}

/// Displacements of the representatives, three equations each, in the fields of a class.
struct Field {
    parity: Parity,
    /// Equations of displacements that are zero.
    held: Vec<bool>,
    factor: Cholesky,
    /// Columns of the inverse restricted to surface equations.
    columns: Mutex<Vec<Option<Box<[f64]>>>>,
}

/// A displacement that is prescribed: of a node along an axis.
#[derive(Clone, Copy)]
struct Constraint {
    image: Image,
    axis: usize,
}

impl Constraint {
    /// Equation of the representative.
    fn equation(self) -> usize {
        3 * self.image.of as usize + self.axis
    }

    fn sign(self, parity: Parity) -> f64 {
        self.image.sign(parity, self.axis)
    }
}

impl Elasticity {
    /// Assembles and factors; `None` if the matrix is not positive definite (ν out of range).
    pub(crate) fn new(sphere: &Sphere, poisson: f64) -> Option<Self> {
        let mirrors = Mirrors::new(sphere);
        let points = mirrors.representatives.iter();
        let points: Vec<DVec3> = points.map(|&node| sphere.nodes[node as usize]).collect();
        let represents = |tetrahedron: &&[u32; 4]| {
            let mut corners = tetrahedron.iter().map(|&node| sphere.nodes[node as usize]);
            mirrors.classes == 1 || corners.all(mirrors::is_first_eighth)
        };
        let tetrahedra: Vec<[u32; 4]> = sphere
            .tetrahedra
            .iter()
            .filter(represents)
            .copied()
            .collect();
        let free_corners = |corners: &[u32; 4]| {
            let images = corners.map(|node| mirrors.image(node));
            images.map(|image| image.map_or(NO_NODE, |image| image.of))
        };
        let elements: Vec<Clique> = tetrahedra.iter().map(free_corners).collect();
        let stiffness = tetrahedra.par_iter().with_min_len(256);
        let stiffness: Vec<Blocks> = stiffness
            .map(|&t| element(&sphere.nodes, t, poisson))
            .collect();
        let elimination = Elimination::new(&points, &elements);
        let fields = (0..mirrors.classes).into_par_iter().map(|parity| {
            let equations = points
                .iter()
                .flat_map(|&point| [0, 1, 2].map(|axis| (point, axis)));
            let held = equations.map(|(point, axis)| mirrors.holds(parity, point, axis));
            let held: Vec<bool> = held.collect();
            let blocks = |number: usize| hold(stiffness[number], elements[number], &held);
            Some(Field {
                factor: elimination.factor(&blocks)?,
                columns: Mutex::new(vec![None; 3 * mirrors.surface]),
                held,
                parity,
            })
        });
        let fields: Option<Vec<Field>> = fields.collect();
        Some(Self {
            fields: fields?,
            mirrors,
            surface: sphere.surface,
        })
    }

    /// Displacements of the surface nodes when some of them are moved as prescribed, for W prescriptions at once.
    ///
    /// `None` if they are singular (a node named twice). Nodes that are anchored stay.
    pub(crate) fn solve<const W: usize>(
        &self,
        prescribed: &[(u32, [DVec3; W])],
    ) -> Option<Vec<[DVec3; W]>> {
        let forces = self.forces(prescribed)?;
        let solved: Vec<Vec<[f64; W]>> = (self.fields.iter())
            .map(|field| self.answer(field, &forces))
            .collect();
        Some(self.displacements(self.surface, &solved))
    }

    /// The forces that move nodes as prescribed.
    fn forces<const W: usize>(
        &self,
        prescribed: &[(u32, [DVec3; W])],
    ) -> Option<Vec<(Constraint, [f64; W])>> {
        let free = prescribed.iter();
        let free = free.filter_map(|&(node, goal)| Some((self.mirrors.image(node)?, goal)));
        let constraints = free
            .clone()
            .flat_map(|(image, _)| [0, 1, 2].map(|axis| Constraint { image, axis }));
        let constraints: Vec<Constraint> = constraints.collect();
        let goals = free.flat_map(|(_, goals)| [0, 1, 2].map(|axis| goals.map(|goal| goal[axis])));
        let mut small: Vec<[f64; W]> = goals.collect();
        let compliance = self.compliance(&constraints).factor()?;
        compliance.forward(&mut small);
        compliance.backward(&mut small);
        Some(constraints.into_iter().zip(small).collect())
    }

    /// Displacements of the first nodes; `solved`: by class, those of the representatives.
    fn displacements<const W: usize>(
        &self,
        nodes: usize,
        solved: &[Vec<[f64; W]>],
    ) -> Vec<[DVec3; W]> {
        let of_image = |image: Image| -> [DVec3; W] {
            std::array::from_fn(|side| {
                let along = |axis: usize| {
                    let by_class = self.fields.iter().zip(solved);
                    let by_class = by_class.map(|(field, solved)| {
                        image.sign(field.parity, axis) * solved[3 * image.of as usize + axis][side]
                    });
                    by_class.sum::<f64>()
                };
                DVec3::from_array([0, 1, 2].map(along))
            })
        };
        let images = self.mirrors.images().take(nodes);
        let at = |image: Option<Image>| image.map_or([DVec3::ZERO; W], of_image);
        images.map(at).collect()
    }

    /// Displacements of the representatives on the surface under forces whose columns of G are known, in the fields of a
    /// class.
    fn answer<const W: usize>(
        &self,
        field: &Field,
        forces: &[(Constraint, [f64; W])],
    ) -> Vec<[f64; W]> {
        let mut x = vec![[0.0; W]; 3 * self.mirrors.surface];
        let columns = field.lock_columns();
        for &(constraint, force) in forces {
            let column = columns[constraint.equation()].as_deref();
            let weight = constraint.sign(field.parity) * self.share();
            let force = force.map(|force| weight * force);
            for (x, column) in x.iter_mut().zip(column.unwrap_or_default()) {
                for (x, force) in x.iter_mut().zip(force) {
                    *x += column * force;
                }
            }
        }
        x
    }

    /// Share of the sphere that the representatives stand for, of which alone the stiffness was summed.
    fn share(&self) -> f64 {
        1.0 / f64::from(self.mirrors.classes)
    }

    /// The rows and columns of G that belong to the constraints.
    fn compliance(&self, constraints: &[Constraint]) -> Columns {
        let mut equations: Vec<usize> = constraints.iter().map(|c| c.equation()).collect();
        equations.sort_unstable();
        equations.dedup();
        // Not while columns are locked: a thread that waits here may take up another soma.
        let chunks = equations.chunks(COLUMNS);
        let pieces: Vec<(&Field, &[usize])> = (self.fields.iter())
            .flat_map(|field| chunks.clone().map(move |chunk| (field, chunk)))
            .collect();
        pieces
            .into_par_iter()
            .for_each(|(field, chunk)| field.know(chunk));
        let columns: Vec<_> = self.fields.iter().map(Field::lock_columns).collect();
        let share = self.share();
        Columns::from_fn(constraints.len(), |row, column| {
            let [to, from] = [row, column].map(|at| constraints[at]);
            let by_class = self.fields.iter().zip(&columns).map(|(field, columns)| {
                let column = columns[from.equation()].as_deref();
                let column = column.expect("made known above");
                to.sign(field.parity) * from.sign(field.parity) * column[to.equation()]
            });
            by_class.sum::<f64>() * share
        })
    }
}

impl Field {
    /// Solves for those of up to [`COLUMNS`] columns that are not known yet.
    fn know(&self, equations: &[usize]) {
        let missing: Vec<usize> = {
            let columns = self.lock_columns();
            let missing = equations.iter().filter(|&&e| columns[e].is_none());
            missing.copied().collect()
        };
        if missing.is_empty() {
            return;
        }
        let mut unit = vec![[0.0; COLUMNS]; self.held.len()];
        for (column, &equation) in missing.iter().enumerate() {
            unit[equation][column] = f64::from(u8::from(!self.held[equation]));
        }
        self.factor.solve(&mut unit);
        let mut columns = self.lock_columns();
        unit.truncate(columns.len());
        for (column, &equation) in missing.iter().enumerate() {
            columns[equation] = Some(unit.iter().map(|row| row[column]).collect());
        }
    }

    fn lock_columns(&self) -> MutexGuard<'_, Vec<Option<Box<[f64]>>>> {
        let columns = self.columns.lock();
        columns.unwrap_or_else(PoisonError::into_inner)
    }
}

/// Blocks without what belongs to equations that are held: there they have a one on the diagonal.
fn hold(mut blocks: Blocks, clique: Clique, held: &[bool]) -> Blocks {
    for (corner, &node) in clique
        .iter()
        .enumerate()
        .filter(|(_, node)| **node != NO_NODE)
    {
        for axis in (0..3).filter(|axis| held[3 * node as usize + axis]) {
            for row in &mut blocks {
                *row[corner].col_mut(axis) = DVec3::ZERO;
            }
            for block in &mut blocks[corner] {
                (0..3).for_each(|column| block.col_mut(column)[axis] = 0.0);
            }
            blocks[corner][corner].col_mut(axis)[axis] = 1.0;
        }
    }
    blocks
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
