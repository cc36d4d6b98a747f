//! Markers in a page: synapses, or points of a table.

use neurotess_render::color::Rgb;
use serde::Serialize;

use crate::arrays::{ArrayRef, Arrays};

/// A marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageMarker {
    /// Where it is (µm, in the world).
    pub position: [f64; 3],
    /// Its color.
    pub color: Rgb,
}

/// Markers as the page's host reads them.
#[derive(Debug, Serialize)]
pub(crate) struct MarkerData {
    /// What is added to all positions.
    origin: [f64; 3],
    /// Three coordinates of each, as bits of f32.
    positions: ArrayRef,
    /// Three bytes of each.
    colors: ArrayRef,
}

impl MarkerData {
    /// None if there are no markers.
    pub(crate) fn new(markers: &[PageMarker], arrays: &mut Arrays) -> Option<Self> {
        let origin = markers.first()?.position;
        let relative = markers
            .iter()
            .flat_map(|marker| [0, 1, 2].map(|k| (marker.position[k] - origin[k]) as f32));
        let bits: Vec<u32> = relative.map(f32::to_bits).collect();
        let colors: Vec<u8> = markers.iter().flat_map(|marker| marker.color).collect();
        Some(Self {
            origin,
            positions: arrays.u32s(&bits),
            colors: arrays.u8s(&colors),
        })
    }
}
