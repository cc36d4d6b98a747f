//! Tables about one cell, beside its mesh.

mod sections;
mod triangles;

use std::io;
use std::path::{Path, PathBuf};

use neurotess_mesh::{Surface, WriteError};
use neurotess_morphology::Morphology;
use neurotess_output::{Existing, Output, OutputError};

use crate::standard::begin;

/// Which tables are written beside the mesh of a cell, as CSV, and where; `-` is standard output.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tables {
    /// A row for each triangle: its sample, section, place along the section and SWC type.
    pub triangles: Option<PathBuf>,
    /// A row for each section: SWC type, samples, length, and the area of its frusta beside that on the mesh.
    pub sections: Option<PathBuf>,
}

type Write = fn(&dyn Surface, &Morphology, &mut std::fs::File) -> Result<(), WriteError>;

/// Tables whose names are taken.
pub(crate) struct BegunTables<'t>(Vec<(&'t Path, Output, Write)>);

impl Tables {
    /// Takes their names, before the work: something may be in the way.
    pub(crate) fn begin(&self, existing: Existing) -> Result<BegunTables<'_>, OutputError> {
        let all: [(&Option<PathBuf>, Write); 2] = [
            (&self.triangles, triangles::write),
            (&self.sections, sections::write),
        ];
        let named = all.into_iter();
        let named = named.filter_map(|(path, write)| Some((path.as_deref()?, write)));
        let begun = named.map(|(path, write)| Ok((path, begin(path, existing)?, write)));
        begun.collect::<Result<_, _>>().map(BegunTables)
    }
}

impl BegunTables<'_> {
    /// Writes the tables of a surface in the coordinates of its tracing (µm).
    pub(crate) fn write(
        self,
        surface: &dyn Surface,
        morphology: &Morphology,
    ) -> Result<Vec<Output>, OutputError> {
        let written = self.0.into_iter().map(|(path, mut output, write)| {
            let written = write(surface, morphology, output.file());
            written.map_err(|e| OutputError::broken(path, io::Error::other(e)))?;
            Ok(output)
        });
        written.collect()
    }
}
