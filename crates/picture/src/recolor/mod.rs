//! Pictures that are colored anew without being drawn anew: a sparse matrix of the weights of color keys.
//!
//! **Theory.** In linear light a pixel is a sum over its samples, and light and occlusion do not
//! depend on colors. So a picture is a sparse matrix, whose rows are pixels and whose columns are the
//! color keys that show, times the colors of these keys, plus a constant. Another frame of a
//! recording, another range or color map is one product, whatever the scene; and only keys that show
//! need values. Heras Ciechomski et al. (2008) describe such a static mode for circuits.

mod key_color;
mod matrix;

use bytemuck::{Pod, Zeroable};

use crate::color::ColorTable;
pub use key_color::Contrast;
pub use matrix::{Matrix, MatrixBuilder, VisibleKey, Weight, Weights, packed};

/// What a color key adds to a pixel. Twin of the struct in collect.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Weighed {
    /// Index of the pixel in its tile or band.
    pub pixel: u32,
    /// The key.
    pub color_key: u32,
    /// Index of the instance.
    pub instance: u32,
    /// Factor of the color, and white: 16 bits each, of 0 to 2.
    pub low: u32,
    /// Share of the edge's color, and 0.
    pub high: u32,
}

/// The pixels of a tile.
#[derive(Clone, Debug, Default)]
pub struct Collected {
    /// Width and height.
    pub size: [u32; 2],
    /// By pixel: what does not depend on colors, white and coverage.
    pub fixed: Vec<[f32; 2]>,
    /// In any order; a color key may come more than once in a pixel.
    pub weighed: Vec<Weighed>,
}

/// The colors of a static picture.
#[derive(Clone, Copy, Debug)]
pub struct KeyColors<'a> {
    /// Scale and categories; and values of instances, if `values` has none.
    pub table: &'a ColorTable,
    /// States of instances: of these, [`HIGHLIGHTED`](crate::state::HIGHLIGHTED) changes colors.
    pub states: &'a [u32],
    /// A value for each of the picture's keys, 0 to 1 or NaN: the color keys that are not
    /// categories are then not looked up in the table's values.
    pub values: Option<&'a [f32]>,
}
