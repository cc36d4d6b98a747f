//! What the ids of a report's elements mean, which its file does not say: the simulation's configuration does.

use std::path::{Path, PathBuf};

use crate::json::Json;
use crate::{Circuit, CircuitError, Fault};

/// What the ids of a report's elements are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elements {
    /// Sections, as NEURON numbers them: reports of compartments, sets of these, and sums over cells.
    Sections,
    /// Synapses: rows of edges.
    Synapses,
    /// Electrodes, or places outside of the cells.
    Electrodes,
}

impl Elements {
    /// Name of a column with such ids.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sections => "section",
            Self::Synapses => "synapse",
            Self::Electrodes => "electrode",
        }
    }
}

/// What a configuration says of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeclaredReport {
    /// Its file.
    pub path: PathBuf,
    /// What its elements are.
    pub elements: Elements,
    /// Its type as it is written, like `synapse`; of bmtk's the module.
    pub type_name: String,
    /// The configuration.
    config: String,
    /// The key of the report in it.
    key: String,
}

impl DeclaredReport {
    /// `type` of SONATA's reports, and `module` of bmtk's. A report of another type, or of none, has sections: ids that no
    /// section has are told where they are met.
    pub(crate) fn of(report: &Json<'_>, path: &Path) -> Self {
        let text = |key| {
            report
                .get(key)
                .and_then(|value| value.value.as_str().map(str::to_owned))
        };
        let type_name = text("type").or_else(|| text("module")).unwrap_or_default();
        let elements = match type_name.to_ascii_lowercase().as_str() {
            "synapse" | "netcon_report" | "synapse_report" | "synapsereport" => Elements::Synapses,
            "lfp" | "extracellular" | "ecp" | "electrode" => Elements::Electrodes,
            _ => Elements::Sections,
        };
        Self {
            path: path.to_path_buf(),
            elements,
            type_name,
            config: report.file.into(),
            key: report.key.clone(),
        }
    }
}

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

    /// The file of a report whose values are those of sections: for whoever shows them on membranes.
    ///
    /// # Errors
    /// As [`Self::report_file`]; [`Fault::NotOfSections`], with the configuration and the key.
    pub fn report_of_sections(&self, wanted: &Path) -> Result<PathBuf, CircuitError> {
        let path = self.report_file(wanted)?;
        match self.declared_report(&path) {
            Some(report) if report.elements != Elements::Sections => {
                let fault = Fault::NotOfSections {
                    report: path.display().to_string(),
                    type_name: report.type_name.clone(),
                    elements: report.elements.name(),
                };
                Err(CircuitError::new(&report.config, report.key.clone(), fault))
            }
            _ => Ok(path),
        }
    }
}
