//! Pictures: drawn in tiles for a file, or step by step for a window; pictures that are colored anew; picking ids;
//! cells in a pass of another program.

pub(crate) mod composite;
pub(crate) mod extent;
pub(crate) mod host;
pub(crate) mod ids;
pub(crate) mod meter;
pub(crate) mod progressive;
pub(crate) mod static_picture;
pub(crate) mod still;
pub(crate) mod tiles;
pub(crate) mod tiling;
pub(crate) mod watched;
