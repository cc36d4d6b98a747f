//! Saving a cell's surface.

use std::path::Path;

use neurotess_mesh::{Format, UnknownFormat, WriteError, write};
use neurotess_output::{Existing, Output, OutputError};

use crate::CellMesh;

/// Why a mesh was not saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The name has no ending of a format.
    #[error(transparent)]
    Format(#[from] UnknownFormat),
    /// The file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The surface cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl CellMesh {
    /// Saves the surface, in µm, whole or not at all; a file of this name is replaced. The ending tells the format: `ply`,
    /// `obj`, `stl`, `glb`, `off`, `vtu`, `msh`, `poly` or `smesh`.
    ///
    /// # Errors
    /// The ending is none of these, the file cannot be written, or the format cannot hold the surface.
    pub fn save(&self, file: impl AsRef<Path>) -> Result<(), SaveError> {
        let file = file.as_ref();
        let format = Format::from_extension(file)?;
        let surface = self.surface();
        let mut output = Output::create(file, Existing::Replace)?;
        write(surface.surface(), format, output.file())?;
        Ok(output.finish()?)
    }
}
