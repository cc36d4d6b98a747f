//! The files of a cell: its mesh, or one for each part, and what is written beside.

use std::path::{Path, PathBuf};

use neurotess::mesh::{
    Parts, Surface, WriteError, WriteOptions, obj_materials, region_name, write_with,
};
use serde::Serialize;

use super::options::MeshOptions;
use crate::io::claims::Claimed;
use crate::io::output::{Output, OutputError, begin};
use crate::io::targets::Job;

/// Where a cell goes.
pub(super) struct Target<'j> {
    job: &'j Job,
    claimed: Claimed,
}

/// A file of one part of a cell, in the report.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PartReport {
    pub(crate) out: String,
    #[serde(rename = "type")]
    kind: String,
    vertices: usize,
    triangles: usize,
    quads: usize,
}

/// The temporary files of a cell.
pub(super) struct Files {
    /// The mesh, or what holds its name while parts are written.
    whole: Output,
    parts: Vec<(PathBuf, Output)>,
    /// Materials and tables.
    beside: Vec<Output>,
}

impl<'j> Target<'j> {
    pub(super) fn new(job: &'j Job, claimed: Claimed) -> Self {
        Self { job, claimed }
    }

    /// The file, or what files of parts are named after.
    pub(super) fn out(&self) -> &'j Path {
        &self.job.out
    }

    /// Writes a surface with all that the options ask for.
    pub(super) fn write(
        mut self,
        surface: &dyn Surface,
        options: &MeshOptions,
    ) -> Result<(Files, Vec<PartReport>), OutputError> {
        let out = self.out();
        let replace = self.claimed.replace;
        let file = self.job.beside.as_deref();
        // Before the work: it may be in the way.
        let beside = file.map(|file| begin(file, replace)).transpose()?;
        let name = file.and_then(Path::file_name);
        let write_options = WriteOptions {
            material_file: name.map(|name| name.to_string_lossy().into_owned()),
            glb_materials: options.materials,
        };
        let mut parts = Vec::new();
        let mut reports = Vec::new();
        let kinds = if self.job.parts {
            let found = Parts::find(surface).map_err(|e| broken(out, e))?;
            for part in found.iter() {
                let name = region_name(part.kind());
                let path = Job::part(out, &name);
                let mut output = begin(&path, replace)?;
                write_with(&part, options.format, &write_options, output.file())
                    .map_err(|e| broken(&path, e))?;
                reports.push(PartReport {
                    out: path.display().to_string(),
                    kind: name.into_owned(),
                    vertices: part.vertex_count(),
                    triangles: part.triangle_count(),
                    quads: part.quad_count(),
                });
                parts.push((path, output));
            }
            found.iter().map(|part| part.kind()).collect()
        } else {
            let whole = self.claimed.output.file();
            write_with(surface, options.format, &write_options, whole)
                .map_err(|e| broken(out, e))?
        };
        let mut files = Files {
            whole: self.claimed.output,
            parts,
            beside: Vec::new(),
        };
        if let (Some(path), Some(mut output)) = (file, beside) {
            std::io::Write::write_all(output.file(), obj_materials(&kinds).as_bytes())
                .map_err(|e| OutputError::broken(path, e))?;
            files.add(output);
        }
        Ok((files, reports))
    }
}

impl Files {
    /// Adds a file that is no mesh.
    pub(super) fn add(&mut self, output: Output) {
        self.beside.push(output);
    }

    /// What the record is to know: the names of the meshes, and where they are.
    pub(super) fn recorded<'f>(&'f self, job: &'f Job) -> Vec<(&'f Path, &'f Path)> {
        match job.parts {
            true => {
                let parts = self.parts.iter();
                parts.map(|(out, output)| (&**out, output.part())).collect()
            }
            false => vec![(&job.out, self.whole.part())],
        }
    }

    /// Gives all files their names, the mesh last: where it is, all that belongs to it is.
    pub(super) fn finish(self) -> Result<(), OutputError> {
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

pub(super) fn broken(out: &Path, error: WriteError) -> OutputError {
    match error {
        WriteError::Io(e) => OutputError::broken(out, e),
        other => OutputError::broken(out, std::io::Error::other(other)),
    }
}
