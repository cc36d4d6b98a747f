//! Tools that take clicks and drags in the picture while they are on.

use crate::model::measuring::Measuring;
use crate::model::placing::Placing;

/// Tools that take clicks and drags in the picture while they are on.
#[derive(Clone, Debug, Default)]
pub struct Tools {
    /// The tool that measures.
    pub measuring: Option<Measuring>,
    /// The handles that move and turn the selected cells.
    pub placing: Option<Placing>,
    /// Angles (degrees) by which cells were turned last.
    pub(crate) typed_angles: Option<glam::DVec3>,
}
