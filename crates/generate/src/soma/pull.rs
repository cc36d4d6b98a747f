//! The elastic answer to neurites that draw a soma's surface out.
//!
//! **Theory.** A soma's surface is r(direction) of what was traced, times its **size**, times the distance of a node of
//! the pulled unit sphere from the origin. A corner of an insertion quad has to be at its ring, so there that distance
//! is prescribed: the ring's, over size times r. This is linear in 1/size, and so is the elastic answer: two right sides,
//! solved for at once, give the answer for every size.

use glam::DVec3;

use super::elasticity::Elasticity;
use super::insertion_quads::Insertion;
use super::sphere::Sphere;

/// The unit sphere's nodes, pulled for a soma of any size.
pub(super) struct Pull<'a> {
    nodes: &'a [DVec3],
    /// Displacements over 1/size, and of size 1 without rings.
    fields: Option<Vec<[DVec3; 2]>>,
}

impl<'a> Pull<'a> {
    /// A sphere that nothing pulls.
    pub(super) fn none(sphere: &'a Sphere) -> Self {
        Self {
            nodes: &sphere.nodes,
            fields: None,
        }
    }

    /// `reaches`: by insertion, distances of its ring's corners from the center in distances of the surface of size 1.
    /// Insets do not pull.
    pub(super) fn new<'e>(
        sphere: &'a Sphere,
        quads: &[usize],
        insertions: &[Insertion],
        reaches: &[[f64; 4]],
        elasticity: impl FnOnce() -> Option<&'e Elasticity>,
    ) -> Self {
        let pulling = quads.iter().zip(insertions).zip(reaches);
        let pulling = pulling.filter(|((_, insertion), _)| !insertion.inset);
        let prescribed = pulling.flat_map(|((&quad, _), reaches)| {
            let corners = sphere.quads[quad].into_iter().zip(*reaches);
            corners.map(|(vertex, reach)| {
                let node = sphere.nodes[vertex as usize];
                (vertex, [node * reach, node])
            })
        });
        let prescribed: Vec<(u32, [DVec3; 2])> = prescribed.collect();
        let fields = match prescribed.is_empty() {
            true => None,
            false => elasticity().and_then(|elasticity| elasticity.solve(&prescribed)),
        };
        Self {
            nodes: &sphere.nodes,
            fields,
        }
    }

    /// Where a node is, for a size.
    pub(super) fn node(&self, node: usize, size: f64) -> DVec3 {
        let displaced = self.fields.as_ref().map(|fields| fields[node]);
        let displacement = displaced.map_or(DVec3::ZERO, |[rings, sphere]| rings / size - sphere);
        self.nodes[node] + displacement
    }
}
