//! What panels are made of: fields for numbers, hints, color maps, marks over the picture.

pub(crate) mod color_map;
pub(crate) mod marks;
pub(crate) mod number;
pub(crate) mod tip;
