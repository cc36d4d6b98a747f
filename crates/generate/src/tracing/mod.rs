//! The tracing as a forest of nodes, and what mends it before anything is planned: radii, coincident points, noise,
//! what lies inside a soma or a thicker neurite, points closer together than their radius.

pub(crate) mod coordinates;
pub(crate) mod mend;
pub(crate) mod repeated;
pub(crate) mod separate;
mod skeleton;
pub(crate) mod smooth;
pub(crate) mod soma_ends;
mod soma_sphere;
pub(crate) mod thin;

pub(crate) use skeleton::{Children, NONE, Root, Shapes, Skeleton, SkeletonNode, off_segment};
pub(crate) use soma_sphere::SomaSphere;
