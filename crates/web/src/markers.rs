//! Markers in a page: synapses, or points of a table.

use neurotess_picture::color::Rgb;
use serde::Serialize;

use crate::arrays::{ArrayRef, Arrays};

/// Markers, and what their colors mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PageMarkers {
    /// Where each is (µm, in the world), and the index of its color.
    pub markers: Vec<([f64; 3], usize)>,
    /// The colors.
    pub colors: Vec<Rgb>,
    /// Radius (µm).
    pub radius: f64,
    /// What the legend lists of them.
    pub legend: Vec<(Rgb, String)>,
}

/// Markers as the page's host reads them.
#[derive(Debug, Serialize)]
pub(crate) struct MarkerData {
    /// What is added to all positions.
    origin: [f64; 3],
    /// Three coordinates of each, as bits of f32.
    positions: ArrayRef,
    /// Index of the color of each.
    categories: ArrayRef,
    colors: Vec<Rgb>,
    radius: f64,
    legend: Vec<(Rgb, String)>,
}

impl MarkerData {
    /// None if there are no markers.
    pub(crate) fn new(set: &PageMarkers, arrays: &mut Arrays) -> Option<Self> {
        let origin = set.markers.first()?.0;
        let relative = set.markers.iter();
        let relative = relative.flat_map(|(at, _)| [0, 1, 2].map(|k| (at[k] - origin[k]) as f32));
        let bits: Vec<u32> = relative.map(f32::to_bits).collect();
        let categories = set.markers.iter();
        let categories: Vec<u16> = categories.map(|&(_, color)| color as u16).collect();
        Some(Self {
            origin,
            positions: arrays.records(&[(&bits, 3)]),
            categories: arrays.u16s(&categories),
            colors: set.colors.clone(),
            radius: set.radius,
            legend: set.legend.clone(),
        })
    }
}
