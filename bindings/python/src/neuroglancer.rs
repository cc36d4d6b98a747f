//! Cells as neuroglancer opens them, as the library writes them.

use std::path::PathBuf;
use std::sync::Arc;

use neurotess::batch::Shard;
use neurotess::precomputed::{Event, Export, ExportError, ExportReport, LOCAL_URL, LevelOptions};
use neurotess::recipe::Spelling;
use pyo3::exceptions::{PyFileExistsError, PyValueError};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::circuit::{Circuit, node_ref};
use crate::work::{Stop, stoppable};
use crate::{errors, json};

/// Writes files, or nodes of a circuit, into a folder. Gives what became of it, as `neurotess neuroglancer --json` has it.
///
/// # Errors
/// `ValueError` for what is wrong with an option, `FileExistsError` for a folder that is there, `KeyboardInterrupt` where Ctrl-C
/// was pressed.
#[pyfunction]
pub(crate) fn neuroglancer<'py>(
    py: Python<'py>,
    circuit: Option<&Circuit>,
    inputs: Vec<PathBuf>,
    nodes: Vec<(u32, u32)>,
    folder: PathBuf,
    wanted: Wanted,
) -> PyResult<Bound<'py, PyAny>> {
    let export = match circuit {
        None => Export::new(inputs),
        Some(of) => wanted.of_circuit(&of.circuit, &nodes)?,
    };
    let export = wanted.set(export)?.into(folder);
    let run = stoppable(py, None, &Stop::default(), move |stopped| {
        export
            .stopped_by(Arc::clone(stopped))
            .run(|_: Event<'_>| {})
    })?;
    let report = run.map_err(|error| match error {
        ExportError::Other(folder) => PyFileExistsError::new_err(format!(
            "{} was written from other cells, or with other options: give another folder, or overwrite=True",
            folder.display()
        )),
        ExportError::Exists(folder) => PyFileExistsError::new_err(format!(
            "{} was written before: resume=True finishes it, overwrite=True writes it anew",
            folder.display()
        )),
        ExportError::Foreign(_) => PyFileExistsError::new_err(error.to_string()),
        ExportError::NoAttribute { .. } | ExportError::Within(_) | ExportError::Unreadable(_) | ExportError::Levels | ExportError::Empty | ExportError::Ids(_) | ExportError::NoPlaces(_) => {
            PyValueError::new_err(error.to_string())
        }
        other => errors::bug(other),
    })?;
    json::serialized(py, &told(&report))
}

/// How a folder is written: the keywords, all of them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wanted {
    max_error: f32,
    lods: usize,
    sharded: bool,
    resume: bool,
    overwrite: bool,
    shard: Option<(usize, usize)>,
    threads: Option<usize>,
    url: Option<String>,
    color_by: Option<String>,
    synapses: Vec<String>,
}

impl Wanted {
    fn of_circuit(
        &self,
        circuit: &Arc<neurotess::circuit::Circuit>,
        nodes: &[(u32, u32)],
    ) -> PyResult<Export> {
        let named = |name: &String| {
            let found = circuit.edges.iter().find(|edges| edges.name == *name);
            found.cloned().ok_or_else(|| {
                let there: Vec<&str> = circuit.edges.iter().map(|edges| &*edges.name).collect();
                PyValueError::new_err(format!("synapses={name:?}: there are {}", there.join(", ")))
            })
        };
        let edges = self
            .synapses
            .iter()
            .map(named)
            .collect::<PyResult<Vec<_>>>()?;
        let nodes: Vec<_> = nodes.iter().copied().map(node_ref).collect();
        let instances = circuit.instances(&nodes, None);
        let export = Export::of_circuit(Arc::clone(circuit), instances);
        let export = export.synapses(edges);
        Ok(match &self.color_by {
            Some(attribute) => export.color_by(attribute),
            None => export,
        })
    }

    fn set(&self, export: Export) -> PyResult<Export> {
        let mut export = export
            .levels(LevelOptions {
                max_error: self.max_error,
                count: self.lods,
            })
            .sharded(self.sharded)
            .resume(self.resume)
            .replace(self.overwrite)
            .url(self.url.as_deref().unwrap_or(LOCAL_URL));
        if let Some((number, count)) = self.shard {
            let shard = Shard::new(number, count)
                .map_err(|e| PyValueError::new_err(format!("shard=({number}, {count}): {e}")))?;
            export = export.part(shard);
        }
        Ok(match self.threads {
            Some(threads) => export.workers(threads),
            None => export,
        })
    }
}

fn told(report: &ExportReport) -> Value {
    let not_found = report.not_found.iter();
    let not_found = not_found.map(|input| json!({"file": input.path, "error": input.to_string()}));
    let failures = report.failures.iter();
    let failures = failures
        .map(|failure| json!({"file": failure.file, "error": failure.told(Spelling::Keyword)}));
    json!({
        "written": report.written,
        "kept": report.kept,
        "triangles": report.triangles,
        "bytes": report.bytes,
        "synapses": report.synapses,
        "link": report.link,
        "warnings": report.warnings,
        "failed": not_found.chain(failures).collect::<Vec<_>>(),
    })
}
