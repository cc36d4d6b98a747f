//! Fields of displacements on a sphere that is its own mirror image.
//!
//! **Theory.** Mirrored at the planes x = 0, y = 0 and z = 0 the sphere is itself, so every field is the sum of
//! eight, each of which is even or odd under each of the three mirrorings, and the stiffness does not mix these
//! (A. Bossavit, Symmetry, groups, and boundary value problems, Comput. Methods Appl. Mech. Eng. 56, 1986). Each
//! is known from an eighth of the sphere; on a plane it is held across or along. Eight factors of an eighth of
//! the equations are a fraction of the work of one of all, and do not wait for one another.
//!
//! **Practice.** A sphere that is not mirrored, as a cube with an odd number of quads along its edges, has one
//! class of fields, and all nodes represent themselves.

use std::collections::HashMap;

use glam::DVec3;

use crate::soma::sphere::Sphere;

/// Mirror images are found by their coordinates, rounded to one over this.
const PLACES: f64 = 1e7;

/// Which mirrorings: bit 0 at x = 0, bit 1 at y = 0, bit 2 at z = 0.
type Mirrorings = u8;

/// A class of fields: those of a set bit are odd under that mirroring, the others even.
pub(super) type Parity = u8;

/// What each node is the mirror image of.
pub(super) struct Mirrors {
    /// By node; none of a node that is held in place.
    images: Vec<Option<Image>>,
    /// Nodes of the eighth of the sphere where no coordinate is negative, in order.
    pub(super) representatives: Vec<u32>,
    /// So many of them are on the surface.
    pub(super) surface: usize,
    pub(super) classes: u8,
}

/// A node as the mirror image of a representative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Image {
    /// Number among the representatives.
    pub(super) of: u32,
    mirrorings: Mirrorings,
}

impl Image {
    /// Displacement along an axis by that of its representative, in a field of a class: 1 or −1.
    pub(super) fn sign(self, parity: Parity, axis: usize) -> f64 {
        let odd = (parity & self.mirrorings).count_ones() + u32::from(self.mirrorings >> axis & 1);
        if odd.is_multiple_of(2) { 1.0 } else { -1.0 }
    }
}

impl Mirrors {
    pub(super) fn new(sphere: &Sphere) -> Self {
        let free = |&node: &u32| !sphere.anchored(node as usize);
        let nodes = (0..sphere.nodes.len() as u32).filter(free);
        let represents =
            |node: &u32| !sphere.mirrored || is_first_eighth(sphere.nodes[*node as usize]);
        let representatives: Vec<u32> = nodes.filter(represents).collect();
        let on_surface = |&node: &u32| (node as usize) < sphere.surface;
        Self {
            images: images(sphere, &representatives),
            surface: representatives.partition_point(on_surface),
            representatives,
            classes: if sphere.mirrored { 8 } else { 1 },
        }
    }

    pub(super) fn image(&self, node: u32) -> Option<Image> {
        self.images[node as usize]
    }

    pub(super) fn images(&self) -> impl Iterator<Item = Option<Image>> {
        self.images.iter().copied()
    }

    /// Whether a representative at a point does not move along an axis in a field of a class: it is its own image
    /// under a mirroring that would turn its displacement round.
    pub(super) fn holds(&self, parity: Parity, point: DVec3, axis: usize) -> bool {
        let on_plane = |plane: &usize| point[*plane] == 0.0;
        let turns = |plane: usize| (plane == axis) != (parity >> plane & 1 == 1);
        self.classes > 1 && (0..3).filter(on_plane).any(turns)
    }
}

/// Whether no coordinate is negative.
pub(super) fn is_first_eighth(point: DVec3) -> bool {
    point.cmpge(DVec3::ZERO).all()
}

fn images(sphere: &Sphere, representatives: &[u32]) -> Vec<Option<Image>> {
    let mut images = vec![None; sphere.nodes.len()];
    if !sphere.mirrored {
        for (of, &node) in (0..).zip(representatives) {
            images[node as usize] = Some(Image { of, mirrorings: 0 });
        }
        return images;
    }
    let place = |point: DVec3| (point.abs() * PLACES).round().as_i64vec3().to_array();
    let by_place: HashMap<[i64; 3], u32> = (representatives.iter().zip(0..))
        .map(|(&node, of)| (place(sphere.nodes[node as usize]), of))
        .collect();
    for (image, &point) in images.iter_mut().zip(&sphere.nodes) {
        *image = by_place.get(&place(point)).map(|&of| Image {
            of,
            mirrorings: point.cmplt(DVec3::ZERO).bitmask() as u8,
        });
    }
    images
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::SphereKind;

    /// All that there are.
    fn spheres() -> impl Iterator<Item = Sphere> {
        let octahedra = (1..=5).map(|level| Sphere::new(SphereKind::Octahedron, level));
        octahedra.chain((2..=32).map(|level| Sphere::new(SphereKind::Cube, level)))
    }

    #[test]
    fn spheres_are_their_own_mirror_images() {
        for sphere in spheres().filter(|sphere| sphere.mirrored) {
            let place = |point: DVec3| (point * PLACES).round().as_i64vec3().to_array();
            let corners = |t: &[u32; 4], mirror: DVec3| {
                let mut corners = t.map(|node| place(sphere.nodes[node as usize] * mirror));
                corners.sort_unstable();
                corners
            };
            let all: HashSet<_> = (sphere.tetrahedra.iter())
                .map(|t| corners(t, DVec3::ONE))
                .collect();
            for axis in DVec3::AXES {
                let mirror = DVec3::ONE - 2.0 * axis;
                assert!(
                    sphere
                        .tetrahedra
                        .iter()
                        .all(|t| all.contains(&corners(t, mirror)))
                );
            }
            let eighth = sphere.tetrahedra.iter().filter(|t| {
                let mut corners = t.iter().map(|&node| sphere.nodes[node as usize]);
                corners.all(is_first_eighth)
            });
            assert_eq!(8 * eighth.count(), sphere.tetrahedra.len());
        }
    }

    #[test]
    fn every_free_node_has_a_representative() {
        let mut mirrored = 0;
        for sphere in spheres() {
            let mirrors = Mirrors::new(&sphere);
            mirrored += usize::from(mirrors.classes == 8);
            for (node, image) in mirrors.images().enumerate() {
                let Some(image) = image else {
                    assert!(sphere.anchored(node));
                    continue;
                };
                let of = sphere.nodes[mirrors.representatives[image.of as usize] as usize];
                let signs = [0, 1, 2].map(|axis| image.sign(0, axis));
                let there = of * DVec3::from_array(signs);
                assert!(there.distance(sphere.nodes[node]) < 1e-12, "{node}");
                // Nodes on a plane are known by it.
                let on_plane = |x: f64| x == 0.0 || x.abs() > 1e-9;
                assert!(mirrors.classes == 1 || of.to_array().into_iter().all(on_plane));
            }
        }
        assert_eq!(mirrored, 21, "octahedra, and cubes of even levels");
    }
}
