//! A surface as it goes into files: perhaps with walls, placed, in another unit.

use glam::DAffine3;
use neurotess_mesh::{InUnit, Placed, Surface, SurfaceMesh, Unit, Walled, Watched, with_walls};

use super::error::SaveError;
use super::options::FileOptions;
use crate::{SurfaceWarning, Watch};

/// A surface as it goes into files.
pub struct FileSurface<'s> {
    surface: &'s dyn Surface,
    walled: Option<Walled>,
    world_from_cell: Option<DAffine3>,
    pub(super) options: FileOptions,
}

impl<'s> FileSurface<'s> {
    /// A surface (µm) as these options ask for it. With walls, it is whole in memory.
    ///
    /// # Errors
    /// It was stopped, or is no surface around its tracing.
    pub fn new(
        surface: &'s dyn Surface,
        options: &FileOptions,
        watch: &Watch<'_>,
    ) -> Result<Self, SaveError> {
        let walled = options.walls.then(|| walled(surface, watch)).transpose()?;
        Ok(Self {
            surface,
            walled,
            world_from_cell: None,
            options: *options,
        })
    }

    /// The same where an instance is.
    #[must_use]
    pub fn placed(self, world_from_cell: Option<DAffine3>) -> Self {
        Self {
            world_from_cell,
            ..self
        }
    }

    /// What is said of walls that are not there.
    pub fn warning(&self) -> Option<SurfaceWarning> {
        self.walled.as_ref().and_then(SurfaceWarning::of_walls)
    }

    /// Does something with it.
    pub fn with<T>(&self, take: impl FnOnce(&dyn Surface) -> T) -> T {
        let surface: &dyn Surface = match &self.walled {
            Some(walled) => walled,
            None => self.surface,
        };
        let placed = self.world_from_cell.map(|at| Placed::new(surface, at));
        let surface: &dyn Surface = placed.as_ref().map_or(surface, |placed| placed);
        match self.options.unit {
            Unit::Micrometer => take(surface),
            unit => take(&InUnit::new(surface, unit)),
        }
    }
}

fn walled(surface: &dyn Surface, watch: &Watch<'_>) -> Result<Walled, SaveError> {
    let watched = Watched::new(surface);
    let whole = SurfaceMesh::collect_watched(&watched, watch);
    let whole = whole.map_err(|_| SaveError::Stopped)?;
    // With walls it knows no tracing any more.
    watched.check()?;
    Ok(with_walls(whole))
}
