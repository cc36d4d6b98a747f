//! Picking: the ids that sources draw, and what they stand for.
//!
//! A source draws a [`PickId`] for each pixel; its resolver, taken when the frame was drawn, says later
//! which instance and which part of its mesh that is.

/// What is drawn at a pixel, as a [`PickResolver`](crate::pick::PickResolver) reads it; zeros where nothing is.
pub type PickId = [u32; 2];
/// Width and height (pixels), and the ids of all pixels by row.
pub type PickIds = ([u32; 2], Vec<PickId>);

/// Bits of an id's first number for how a patch is drawn; those above are its batch's.
pub(crate) const BATCH_SHIFT: u32 = 3;
/// Bits of an id's second number for the point of a chunk of exploration; those above are the chunk's.
pub(crate) const POINT_BITS: u32 = 7;
/// How a patch is drawn: refined. Less than that is the number of a corner of a flat one.
pub(crate) const FINE: u32 = 4;

/// What is seen at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PickHit {
    /// Place of the instance in the scene.
    pub instance: u32,
    /// Where on it.
    pub spot: PickTarget,
}

/// A place on a template's mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PickTarget {
    /// Index of the patch.
    Patch(u32),
    /// Index of a vertex of the patch, one so small that it is drawn flat.
    Vertex(u32),
    /// Index of a tracing point.
    Point(u32),
    /// A soma, with the index of a tracing point of it.
    Soma(u32),
}
