//! The caches of the circuits that are being opened.

use std::path::Path;

use neurotess::cache::Cache;

use crate::io::find::{Found, OpenRequest};

/// A cache for each circuit, and which one a file has.
#[derive(Default)]
pub(crate) struct CircuitCaches {
    caches: Vec<Cache>,
    /// By file: index of its cache.
    of_files: Vec<Option<usize>>,
}

impl CircuitCaches {
    /// The caches of all circuits that were found. The files of a session are those of its first circuit.
    pub(crate) fn open(found: &Found, request: &OpenRequest) -> Self {
        if request.without_caches {
            return Self::default();
        }
        let circuits = found.circuits.iter();
        let open = circuits.map(|(_, circuit)| Cache::open(Path::new(&circuit.file)));
        let caches: Vec<Cache> = open.collect();
        let session = (!request.circuits.is_empty() && !caches.is_empty()).then_some(0);
        let mut of_files = vec![session; found.files.len()];
        for cell in &found.cells {
            of_files[cell.file] = Some(cell.circuit);
        }
        Self { caches, of_files }
    }

    /// The cache of a file, if it belongs to a circuit.
    pub(crate) fn of_file(&self, file: usize) -> Option<&Cache> {
        self.caches.get((*self.of_files.get(file)?)?)
    }

    /// Writes what is new, and tells what was wrong.
    pub(crate) fn finish(self) -> impl Iterator<Item = String> {
        let summaries = self.caches.into_iter().map(Cache::finish);
        summaries
            .flat_map(|summary| summary.warnings)
            .map(|warning| warning.to_string())
    }
}
