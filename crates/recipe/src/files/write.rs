//! Writing of a surface into temporary files, which then get their names.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use neurotess_mesh::{
    Parts, Surface, WriteError, WriteOptions, obj_materials, region_name, write_with,
};
use neurotess_output::{Existing, Output, OutputError};
use serde::Serialize;

use super::error::SaveError;
use super::observed::Observed;
use super::options::{FileOptions, part_file};
use super::surface::FileSurface;
use crate::Watch;

/// A file of one part of a cell, as in `neurotess mesh --json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct PartFile {
    /// The file.
    pub out: String,
    /// The type: `soma`, `axon`, …
    #[serde(rename = "type")]
    pub kind: String,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of quads.
    pub quads: usize,
}

/// Temporary files, and what is in them.
#[non_exhaustive]
pub struct WrittenFiles {
    /// The files, still to be given their names.
    pub files: CellFiles,
    /// What is written instead of the whole, if each type has a file.
    pub parts: Vec<PartFile>,
    /// Number of vertices of the whole.
    pub vertices: usize,
    /// Number of triangles of the whole.
    pub triangles: usize,
    /// Number of quads of the whole.
    pub quads: usize,
    /// Seconds in which blocks of the surface were made, summed over all threads; 0 without a clock.
    pub block_seconds: f64,
}

/// The temporary files of a cell. Dropped before they are finished, they were never there.
pub struct CellFiles {
    /// The mesh, or what holds its name while parts are written.
    whole: Output,
    parts: Vec<(PathBuf, Output)>,
    /// Materials and tables.
    beside: Vec<Output>,
}

impl FileSurface<'_> {
    /// Writes it into temporary files. `whole`: that of `out`; it only holds the name if there is a file for each type.
    /// `existing`: what becomes of other files that are there.
    ///
    /// # Errors
    /// A file is in the way or cannot be written, the format cannot hold the surface, or it was stopped.
    pub fn write(
        &self,
        out: &Path,
        whole: Output,
        existing: Existing,
        watch: &Watch<'_>,
    ) -> Result<WrittenFiles, SaveError> {
        self.with(|surface| {
            let observed = Observed::new(surface, &self.options, watch);
            let to = Target {
                out,
                existing,
                options: &self.options,
                watch,
            };
            let written = to.write(&observed, whole);
            let (files, parts) = written.map_err(|e| match watch.is_stopped() {
                true => SaveError::Stopped,
                false => e,
            })?;
            Ok(WrittenFiles {
                files,
                parts,
                vertices: surface.vertex_count(),
                triangles: surface.triangle_count(),
                quads: surface.quad_count(),
                block_seconds: observed.seconds(),
            })
        })
    }
}

/// Where a surface goes.
struct Target<'t> {
    out: &'t Path,
    existing: Existing,
    options: &'t FileOptions,
    watch: &'t Watch<'t>,
}

impl Target<'_> {
    fn write(
        &self,
        surface: &dyn Surface,
        whole: Output,
    ) -> Result<(CellFiles, Vec<PartFile>), SaveError> {
        let (out, format) = (self.out, self.options.format);
        let materials = self.options.materials_of(out);
        // Before the work: it may be in the way.
        let beside = materials.as_deref();
        let beside = beside.map(|file| Output::create(file, self.existing));
        let beside = beside.transpose()?;
        let name = materials.as_deref().and_then(Path::file_name);
        let name = name.map(|name| name.to_string_lossy().into_owned());
        let options = self.options.writing(name);
        let mut files = CellFiles {
            whole,
            parts: Vec::new(),
            beside: Vec::new(),
        };
        let (kinds, reports) = match self.options.parts {
            true => self.write_parts(surface, &options, &mut files)?,
            false => {
                let mut file = self.stoppable(&mut files.whole);
                let kinds = write_with(surface, format, &options, &mut file);
                (kinds.map_err(|e| broken(out, e))?, Vec::new())
            }
        };
        if let (Some(path), Some(mut output)) = (materials, beside) {
            let text = obj_materials(&kinds);
            let written = output.file().write_all(text.as_bytes());
            written.map_err(|e| OutputError::broken(&path, e))?;
            files.add(output);
        }
        Ok((files, reports))
    }

    /// A file for each type. Gives the types, too.
    fn write_parts(
        &self,
        surface: &dyn Surface,
        options: &WriteOptions,
        files: &mut CellFiles,
    ) -> Result<(std::collections::BTreeSet<i32>, Vec<PartFile>), SaveError> {
        let mut reports = Vec::new();
        let found = Parts::find(surface).map_err(|e| broken(self.out, e))?;
        for part in found.iter() {
            let name = region_name(part.kind());
            let path = part_file(self.out, &name);
            let mut output = Output::create(&path, self.existing)?;
            let mut file = self.stoppable(&mut output);
            write_with(&part, self.options.format, options, &mut file)
                .map_err(|e| broken(&path, e))?;
            reports.push(PartFile {
                out: path.display().to_string(),
                kind: name.into_owned(),
                vertices: part.vertex_count(),
                triangles: part.triangle_count(),
                quads: part.quad_count(),
            });
            files.parts.push((path, output));
        }
        Ok((found.iter().map(|part| part.kind()).collect(), reports))
    }

    fn stoppable<'o>(&'o self, output: &'o mut Output) -> Stoppable<'o> {
        Stoppable {
            file: output.file(),
            watch: self.watch,
        }
    }
}

impl CellFiles {
    /// Adds a file that is no mesh.
    pub fn add(&mut self, output: Output) {
        self.beside.push(output);
    }

    /// The names of the meshes, and where they are until they are finished. `out`: the name of the whole.
    pub fn meshes<'f>(&'f self, out: &'f Path) -> Vec<(&'f Path, &'f Path)> {
        match &self.parts[..] {
            [] => vec![(out, self.whole.part())],
            parts => {
                let parts = parts.iter();
                parts.map(|(out, output)| (&**out, output.part())).collect()
            }
        }
    }

    /// Gives all files their names, the mesh last: where it is, all that belongs to it is.
    ///
    /// # Errors
    /// Another file has got a name meanwhile, or the file system refuses.
    pub fn finish(self) -> Result<(), OutputError> {
        let is_whole = self.parts.is_empty();
        self.beside.into_iter().try_for_each(Output::finish)?;
        for (_, part) in self.parts {
            part.finish()?;
        }
        match is_whole {
            true => self.whole.finish(),
            false => Ok(()),
        }
    }
}

/// A file that takes no more once another thread has stopped the work.
struct Stoppable<'o> {
    file: &'o mut std::fs::File,
    watch: &'o Watch<'o>,
}

impl Write for Stoppable<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.watch.is_stopped() {
            true => Err(io::Error::other("stopped")),
            false => self.file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Stoppable<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

fn broken(out: &Path, error: WriteError) -> SaveError {
    let error = match error {
        WriteError::Io(e) => e,
        other => io::Error::other(other),
    };
    OutputError::broken(out, error).into()
}
