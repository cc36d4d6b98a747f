//! Picking: the ids that sources draw, and what they mean.
//!
//! A source draws a [`PickId`] for each pixel. Its resolver, taken when the frame was drawn, later
//! finds the instance and the place on its mesh that an id means.

/// What is drawn at a pixel, as a [`PickResolver`](crate::pick::PickResolver) reads it; zeros where
/// nothing is.
pub type PickId = [u32; 2];
/// Width and height (pixels), and the ids of all pixels by row.
pub type PickIds = ([u32; 2], Vec<PickId>);

/// Low bits of an id's first number: the corner of a flat patch, or [`FINE`]. The bits above are
/// the index of the batch.
pub(crate) const BATCH_SHIFT: u32 = 3;
/// Low bits of an id's second number, in exploration mode: the point of the chunk. The bits above
/// are the index of the chunk.
pub(crate) const POINT_BITS: u32 = 7;
/// In place of a corner's number: the patch is refined.
pub(crate) const FINE: u32 = 4;

/// What is drawn at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PickHit {
    /// Index of the instance in the scene.
    pub instance: u32,
    /// The place on the template's mesh.
    pub target: PickTarget,
}

/// A place on a template's mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PickTarget {
    /// Index of the patch.
    Patch(u32),
    /// Index of a vertex: the nearest corner of a patch that is drawn flat.
    Vertex(u32),
    /// Index of a tracing point.
    Point(u32),
    /// A soma, with the index of a tracing point of it.
    Soma(u32),
}
