//! What keeps a mesh from being saved.

use neurotess_mesh::{UnknownFormat, Unsound};
use neurotess_output::OutputError;

use crate::OptionsError;

/// Why a mesh was not saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The name has no ending of a format.
    #[error(transparent)]
    Format(#[from] UnknownFormat),
    /// The format does not hold what is asked for.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// The file cannot be written, or the format cannot hold the surface.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A fault of ours.
    #[error(transparent)]
    Unsound(#[from] Unsound),
    /// Another thread stopped it.
    #[error("stopped")]
    Stopped,
}
