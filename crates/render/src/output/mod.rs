//! Pictures: drawn in tiles for a file, or step by step for a window; pictures that are colored anew; overlays; picking ids.

pub(crate) mod annotation;
pub(crate) mod axes;
pub(crate) mod extent;
pub(crate) mod host;
pub(crate) mod ids;
pub(crate) mod image;
pub(crate) mod legend;
pub(crate) mod meter;
pub(crate) mod options;
pub(crate) mod overlay;
pub(crate) mod progressive;
pub(crate) mod static_picture;
pub(crate) mod still;
pub(crate) mod stroke;
pub(crate) mod text;
pub(crate) mod tiles;
pub(crate) mod tiling;
pub(crate) mod watch;
