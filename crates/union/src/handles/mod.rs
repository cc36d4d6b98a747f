//! Pieces and holes that merging has made: pieces are joined again, small holes are filled.

mod blend;
pub(crate) mod fill;
mod loops;
mod patch;
mod plug;
pub(crate) mod rejoin;
