//! The coarse mesh: closed, oriented, all quads, and every vertex knows its tracing point.
//!
//! ```text
//!        3 ───────── 2      ring of the child (corners 3, 2)
//!      ╱ │         ╱ │
//!     ●  │  lateral  │ ──▶ path: y runs from corner 0 to 3, x from corner 0 to 1
//!      ╲ │         ╲ │
//!        0 ───────── 1      ring of the parent (corners 0, 1)
//! ```

use glam::{DVec3, Vec3};

/// A closed mesh of quad patches. Closed by index: every edge is shared by exactly two patches, in
/// opposite directions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoarseMesh {
    /// What to add to every position to get the tracing's own coordinates (µm).
    pub origin: DVec3,
    /// Corners of patches.
    pub vertices: Vec<Vertex>,
    /// Tracing points; those of a soma stand for one vertex each.
    pub tracing: Vec<TracingPoint>,
    /// Quads.
    pub patches: Vec<Patch>,
}

/// A corner of patches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Position (µm, relative to the mesh's origin).
    pub position: Vec3,
    /// Unit normal of the surface, outwards.
    pub normal: Vec3,
    /// Index of its tracing point.
    pub tracing: u32,
}

/// What a tracing point is for the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Role {
    /// One ring between two others.
    #[default]
    Ordinary,
    /// The last ring of a neurite, closed by a cap.
    End,
    /// Three or more tubes meet.
    Joint,
    /// A vertex of a soma: `center` is the soma's, `radius` the distance from it.
    Soma,
    /// The ring where a neurite leaves the soma.
    Insertion,
    /// The ring where a branch leaves a quad of its trunk or of the soma, lifted off it: `center` is
    /// the mean of its corners. The patches around it end along `tangent`.
    Inset,
}

/// A traced center with what the surface needs of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracingPoint {
    /// Center (µm, relative to the mesh's origin).
    pub center: Vec3,
    /// Radius (µm).
    pub radius: f32,
    /// Unit orientation: the direction of the path here.
    pub tangent: Vec3,
    /// What it is for the surface.
    pub role: Role,
    /// Of an inset: how long (µm) the patches around it run along its tangent before they turn towards
    /// the trunk, as the last leg of their cubics; negative where its path ends at the inset instead of beginning
    /// there, so that its tangent points into the trunk. 0 for all others.
    pub collar: f32,
    /// Of an ordinary point: change of the radius along the path (µm per µm, −1 to 1). The normals of its ring
    /// lean by it, and the radius has this slope there on both sides. 0 for all others.
    pub taper: f32,
    /// Of an ordinary point or an end: where on the way from the ring before its section begins, in sixteenths, −15 to 15;
    /// negative where that has a lower number than the section before. 0 where the section is the same: then the sample
    /// changes half way.
    pub border: i8,
    /// SWC type of the section.
    pub kind: SwcType,
    /// The sample that it was traced as.
    pub sample: SampleId,
    /// The section that it lies on.
    pub section: SectionNumber,
}

/// Type of a section as SWC numbers it: 1 soma, 2 axon, 3 basal dendrite, 4 apical dendrite, others as the
/// file means them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SwcType(pub i32);

impl SwcType {
    /// The type of somata.
    pub const SOMA: Self = Self(1);
}

/// The file's own number of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SampleId(pub i32);

/// A section as surfaces number it: 0 is the soma, all others are those of the morphology plus one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SectionNumber(pub i32);

impl SectionNumber {
    /// The soma.
    pub const SOMA: Self = Self(0);

    /// Index of the section in its morphology; none for the soma.
    pub fn index(self) -> Option<usize> {
        usize::try_from(i64::from(self.0) - 1).ok()
    }
}

/// What a patch covers, and so how it is refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum PatchKind {
    /// A quarter of a tube: edge 0–1 on the parent's ring, 3–2 on the child's.
    Lateral,
    /// The end of a tube: all corners on one ring.
    Cap,
    /// Part of a soma.
    Soma,
    /// Between a side of a trunk's or soma's quad (corners 0 and 1) and a side of the inset within it
    /// (corners 3 and 2): at each x a cubic from the one to the other.
    Loft,
}

/// A quad, counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patch {
    /// Indices of vertices.
    pub corners: [u32; 4],
    /// What it covers.
    pub kind: PatchKind,
}
