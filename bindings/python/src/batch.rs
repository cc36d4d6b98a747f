//! Files into a folder of meshes, as the library's batches make them.

use std::path::PathBuf;
use std::sync::Arc;

use neurotess::Batch;
use neurotess::batch::{BatchError, BatchReport, Entry, Shard};
use neurotess::mesh::Format;
use neurotess::output::Existing;
use neurotess::recipe::{FileOptions, MeshOptions, Spelling};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::surface::Recipe;
use crate::work::{Stop, stoppable};
use crate::{errors, json};

/// Meshes files into a folder. Gives what became of each, as `neurotess mesh --json` has it.
///
/// # Errors
/// `ValueError` for what is wrong with an option or with where files would go, `KeyboardInterrupt` where Ctrl-C was pressed.
#[pyfunction]
pub(crate) fn mesh_all<'py>(
    py: Python<'py>,
    recipe: &Recipe,
    inputs: Vec<PathBuf>,
    folder: PathBuf,
    wanted: Wanted,
) -> PyResult<Bound<'py, PyAny>> {
    let checked = wanted.checked()?;
    let options = recipe.0.clone();
    let run = stoppable(py, None, &Stop::default(), move |stopped| {
        let batch = wanted.batch(inputs, options, checked).into(folder);
        batch.stopped_by(Arc::clone(stopped)).run(|_| {})
    })?;
    let report = run.map_err(|e| match e {
        BatchError::Options(e) => errors::option(py, &e.told(Spelling::Keyword)),
        BatchError::Target(e) => PyValueError::new_err(e.to_string()),
        e => errors::bug(e),
    })?;
    json::serialized(py, &entries(&report))
}

/// How a batch runs: the keywords, all of them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wanted {
    format: String,
    resume: bool,
    overwrite: bool,
    shard: Option<(usize, usize)>,
    threads: Option<usize>,
}

impl Wanted {
    /// The file format and the part of the inputs.
    fn checked(&self) -> PyResult<(Format, Option<Shard>)> {
        let format = self.format.parse();
        let format = format.map_err(|e| PyValueError::new_err(format!("format=: {e}")))?;
        let shard = self.shard.map(|(number, count)| {
            let shard = Shard::new(number, count);
            shard.map_err(|e| PyValueError::new_err(format!("shard=({number}, {count}): {e}")))
        });
        Ok((format, shard.transpose()?))
    }

    /// `options`: of meshes.
    fn batch(
        &self,
        inputs: Vec<PathBuf>,
        options: MeshOptions,
        (format, shard): (Format, Option<Shard>),
    ) -> Batch {
        let mut batch = Batch::new(inputs)
            .options(options)
            .files(FileOptions::new(format))
            .resume(self.resume)
            .existing(match self.overwrite {
                true => Existing::Replace,
                false => Existing::Refuse(
                    "resume=True leaves it where it is up to date, overwrite=True replaces it",
                ),
            });
        if let Some(shard) = shard {
            batch = batch.shard(shard);
        }
        match self.threads {
            Some(threads) => batch.workers(threads),
            None => batch,
        }
    }
}

/// Inputs without any file, and what became of the others.
fn entries(report: &BatchReport) -> Vec<Entry<'_>> {
    let not_found = report.not_found.iter();
    let not_found = not_found.map(|input| Entry::failed(&input.path, input.to_string()));
    not_found.chain(report.entries(Spelling::Keyword)).collect()
}
