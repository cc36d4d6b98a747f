//! Reports of a circuit, by name or file, and whether their values are those of sections.

use std::path::{Path, PathBuf};

use super::RecordingFile;
use crate::declared::{DeclaredReport, Elements};
use crate::{Circuit, CircuitError, Fault};

impl Circuit {
    /// What a configuration says of the report of a file; none if it does not name it.
    pub fn declared_report(&self, path: &Path) -> Option<&DeclaredReport> {
        let wanted = path.canonicalize().ok();
        self.declared_reports.iter().find(|report| {
            report.path == path || (wanted.is_some() && report.path.canonicalize().ok() == wanted)
        })
    }

    /// The file of a report: one that exists, or the one that the configuration calls so.
    ///
    /// # Errors
    /// [`Fault::NoReport`], which names those that there are.
    pub fn report_file(&self, wanted: &Path) -> Result<PathBuf, CircuitError> {
        if wanted.exists() {
            return Ok(wanted.to_path_buf());
        }
        let named = wanted.to_str().and_then(|name| self.reports.get(name));
        named.cloned().ok_or_else(|| {
            let there: Vec<&str> = self.reports.keys().map(String::as_str).collect();
            let there = match there.is_empty() {
                true => format!("{} names none that exists", self.file),
                false => format!("{} has {}", self.file, there.join(", ")),
            };
            CircuitError::of_file(&wanted.display().to_string(), Fault::NoReport { there })
        })
    }

    /// Opens a report or a file of spikes: a file, or one by the circuit's name of it. Compartments of a report that is of a
    /// compartment set are where the set has them, if the file does not say.
    ///
    /// # Errors
    /// As [`Self::report_file`]; what is wrong with the file.
    pub fn open_recording(&self, wanted: &Path) -> Result<RecordingFile, CircuitError> {
        let path = self.report_file(wanted)?;
        let mut opened = RecordingFile::open(&path)?;
        let declared = self.declared_report(&path);
        let set =
            declared.and_then(|report| self.compartment_sets.get(report.compartment_set.as_ref()?));
        if let (Some(set), RecordingFile::Report(report)) = (set, &mut opened) {
            let own = report.populations.iter_mut();
            for population in own.filter(|population| population.name == set.population) {
                population.set = Some(set.clone());
            }
        }
        Ok(opened)
    }

    /// The file of a report whose values are those of sections: for whoever shows them on membranes.
    ///
    /// # Errors
    /// As [`Self::report_file`]; [`Fault::NotOfSections`], with the configuration and the key.
    pub fn report_of_sections(&self, wanted: &Path) -> Result<PathBuf, CircuitError> {
        let path = self.report_file(wanted)?;
        match self.declared_report(&path) {
            Some(report) if report.elements != Elements::Sections => {
                let fault = Fault::NotOfSections {
                    type_name: report.type_name.clone(),
                    elements: report.elements.name(),
                };
                Err(CircuitError::new(&report.config, report.key.clone(), fault))
            }
            _ => Ok(path),
        }
    }
}
