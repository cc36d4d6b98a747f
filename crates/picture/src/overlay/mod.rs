//! Drawn over a picture: legends, scale bars, and lines with labels.

mod annotation;
mod axes;
mod corners;
mod legend;
mod stroke;
mod text;

pub use annotation::{Annotation, AnnotationLine, Annotations};
pub use corners::{MARGIN, Overlay, OverlayOptions};
pub use legend::{Legend, nice_length, scale_bar};
