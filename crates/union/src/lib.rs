//! The exact union of a closed surface with itself: what is enclosed once or more is inside, and no two
//! triangles cross.
//!
//! A surface made of tubes crosses itself where branches were traced through one another, and at tight bends
//! and forks. [`union`] finds the faces that cross, cuts them along one another, and keeps what bounds the
//! points of **winding number** 1 or more. All other faces, and their vertices with all attributes, stay to
//! the bit. Then splinters are left out, sheets that touch are parted, needles and caps at the **seams** are
//! tidied, seams are smoothed a little, and the result is checked; what still crosses after rounding to 32
//! bits is cut once more. On request surfaces that cross a little are pressed in instead
//! ([`UnionOptions::press`]), small holes that merging leaves are filled ([`UnionOptions::fill`]), and narrow triangles
//! are made wider, wherever they are ([`UnionOptions::least_angle`]).
//!
//! Merging makes **handles**: two branches that cross grow together. [`UnionReport::places`] names each place. A
//! **tunnel** is a loop that bounds a disk outside the solid: around the hole of a handle.
//!
//! **Theory.** Q. Zhou, E. Grinspun, D. Zorin, A. Jacobson, Mesh Arrangements for Solid Geometry, 2016, with
//! the arrangement of the faces near crossings only: the winding numbers of its cells follow from one ray
//! through the whole surface for each set of cells that hang together.
//!
//! **Practice.** Time grows with the faces (a search for crossings among all of them, and further ones among those that changed) and with the crossings.
//!
//! ```
//! use neurotess_mesh::{SurfaceMesh, SurfaceVertex};
//! use neurotess_union::{UnionOptions, union};
//!
//! // Two tetrahedra, one through the other.
//! let mut mesh = SurfaceMesh::default();
//! for shift in [0.0_f32, 0.3] {
//!     let first = mesh.vertices.len() as u32;
//!     for [x, y, z] in [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]] {
//!         let position = [x + shift, y + 0.9 * shift, z + 0.8 * shift].into();
//!         mesh.vertices.push(SurfaceVertex { position, ..Default::default() });
//!     }
//!     let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
//!     mesh.faces.triangles.extend(faces.map(|face| face.map(|corner| first + corner)));
//! }
//! let merged = union(&mesh, &UnionOptions::default())?;
//! assert!(merged.report.pairs_before > 0 && merged.report.pairs == 0);
//! assert_eq!(merged.report.components, 1);
//! # Ok::<(), neurotess_union::UnionError>(())
//! ```
#![forbid(unsafe_code)]

mod arrange;
mod body;
mod handles;
mod mend;
mod merge;
mod options;
mod report;
mod rounds;
mod solver;
mod surface;

pub use merge::{Union, crossing_places, union, union_watched};
pub use options::{UnionError, UnionOptions};
pub use report::{Filled, Joined, Kin, Part, Place, UnionReport, Why};
