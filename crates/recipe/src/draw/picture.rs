//! A finished picture.

use std::io::BufWriter;
use std::path::Path;

use neurotess_output::{Existing, Output, OutputError};
use neurotess_picture::{Image, PngWriter};

/// A finished picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its pixels.
    pub image: Image,
    /// Whether it is transparent where nothing is.
    pub(super) alpha: bool,
}

/// Why a picture was not saved.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct PictureSaveError(#[from] OutputError);

impl Picture {
    /// Saves it as PNG, whole or not at all; a file of this name is replaced.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, file: impl AsRef<Path>) -> Result<(), PictureSaveError> {
        let path = file.as_ref();
        let broken = |e: std::io::Error| OutputError::broken(path, e);
        let mut output = Output::create(path, Existing::Replace)?;
        let size = [self.image.width, self.image.height];
        let file = output.file().try_clone().map_err(broken)?;
        let mut png = PngWriter::new(BufWriter::new(file), size, self.alpha).map_err(broken)?;
        png.write(&self.image).map_err(broken)?;
        png.finish().map_err(broken)?;
        Ok(output.finish()?)
    }
}
