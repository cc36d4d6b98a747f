//! Morphologies that nodes share: found by name, read once, when first asked for.

use std::path::PathBuf;
use std::sync::OnceLock;

use glam::DVec3;
use neurotess_formats::{Read, ReadError, ReadOptions};
use neurotess_morphology::Morphology;
use rayon::prelude::*;

/// Index of a template in [`Circuit::templates`](crate::Circuit::templates).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TemplateId(pub u32);

impl TemplateId {
    /// The index as a `usize`.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A morphology file.
#[derive(Debug)]
pub struct Template {
    /// Where it lies; of one in a container `FILE#NAME`, which [`neurotess_formats::read`] takes.
    pub path: PathBuf,
    read: OnceLock<Result<Read, ReadError>>,
}

impl Template {
    pub(crate) fn new(path: PathBuf) -> Self {
        Self {
            path,
            read: OnceLock::new(),
        }
    }

    /// Its morphology, read at the first call; threads that ask meanwhile wait for it.
    ///
    /// # Errors
    /// Why the file cannot be read, at every call.
    pub fn read(&self) -> Result<&Read, &ReadError> {
        let read = || neurotess_formats::read(&self.path, &ReadOptions::default());
        self.read.get_or_init(read).as_ref()
    }

    /// Whether it has been read.
    pub fn is_read(&self) -> bool {
        self.read.get().is_some()
    }

    /// Forgets the morphology, to give its memory back.
    pub fn forget(&mut self) {
        self.read = OnceLock::new();
    }
}

/// Reads all of these at once on all threads of the pool. Failures stay with their template.
pub fn read_all<'a>(templates: impl IntoIterator<Item = &'a Template>) {
    let templates: Vec<&Template> = templates.into_iter().collect();
    templates.par_iter().for_each(|template| {
        // A failure is told by whoever uses the template.
        let _: Result<&Read, &ReadError> = template.read();
    });
}

/// Center of the main soma in the file's coordinates (µm); zero if there is no soma.
pub fn soma_center(morphology: &Morphology) -> DVec3 {
    morphology.soma().map_or(DVec3::ZERO, |soma| {
        morphology.origin + soma.center.as_dvec3()
    })
}
