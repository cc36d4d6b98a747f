//! Saving a cell's surface.

use std::path::{Path, PathBuf};

use glam::DAffine3;
use neurotess_mesh::Format;
use neurotess_output::{Existing, Output};

use super::error::SaveError;
use super::options::FileOptions;
use super::surface::FileSurface;
use crate::{CellMesh, SurfaceWarning, Watch};

/// How and where a mesh is saved.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct SaveOptions {
    /// Format, unit, walls, materials and parts.
    pub files: FileOptions,
    /// Where the cell is; none: as it was traced.
    pub world_from_cell: Option<DAffine3>,
    /// What becomes of files that are there.
    pub existing: Existing,
}

/// What was saved.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Saved {
    /// The meshes: one, or one for each type.
    pub files: Vec<PathBuf>,
    /// Number of vertices of the whole.
    pub vertices: usize,
    /// Number of triangles of the whole.
    pub triangles: usize,
    /// Number of quads of the whole.
    pub quads: usize,
    /// What is said of walls that are not there.
    pub warning: Option<SurfaceWarning>,
}

impl SaveOptions {
    /// Files of this format, in µm, as traced; what is there is replaced.
    pub fn new(format: Format) -> Self {
        Self {
            files: FileOptions::new(format),
            world_from_cell: None,
            existing: Existing::Replace,
        }
    }
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
        self.save_with(file, &SaveOptions::new(format), &Watch::default())?;
        Ok(())
    }

    /// Saves the surface as options ask for it, whole or not at all.
    ///
    /// # Errors
    /// The format does not hold what is asked for, a file is in the way or cannot be written, or it was stopped.
    pub fn save_with(
        &self,
        out: &Path,
        options: &SaveOptions,
        watch: &Watch<'_>,
    ) -> Result<Saved, SaveError> {
        options.files.check(self.options())?;
        let surface = self.surface_for(options.files.format);
        let surface = FileSurface::new(surface.surface(), &options.files, watch)?;
        let surface = surface.placed(options.world_from_cell);
        surface.save(out, options.existing, watch)
    }
}

impl FileSurface<'_> {
    /// Saves it whole or not at all.
    ///
    /// # Errors
    /// A file is in the way or cannot be written, the format cannot hold it, or it was stopped.
    pub fn save(
        &self,
        out: &Path,
        existing: Existing,
        watch: &Watch<'_>,
    ) -> Result<Saved, SaveError> {
        // The name of files of parts only, which may be that of another mesh.
        let of_whole = match self.options.parts {
            true => Existing::Replace,
            false => existing,
        };
        let whole = Output::create(out, of_whole)?;
        let written = self.write(out, whole, existing, watch)?;
        let files = written.files.meshes(out).into_iter();
        let files = files.map(|(file, _)| file.to_owned()).collect();
        written.files.finish()?;
        Ok(Saved {
            files,
            vertices: written.vertices,
            triangles: written.triangles,
            quads: written.quads,
            warning: self.warning(),
        })
    }
}
