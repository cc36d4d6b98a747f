//! What the ids of a report's elements mean, which its file does not say: the simulation's configuration does.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::compartment_sets::CompartmentSet;
use crate::json::Json;
use crate::warning::Warning;

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
    /// The set of compartments that it is of.
    pub compartment_set: Option<String>,
    /// Its type as it is written, like `synapse`; of bmtk's the module.
    pub type_name: String,
    /// The configuration.
    pub(crate) config: String,
    /// The key of the report in it.
    pub(crate) key: String,
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
            compartment_set: text("compartment_set").filter(|_| type_name == "compartment_set"),
            type_name,
            config: report.file.into(),
            key: report.key.clone(),
        }
    }

    /// What to say of a set that no file has.
    pub(crate) fn unknown_set(&self, sets: &BTreeMap<String, CompartmentSet>) -> Option<Warning> {
        let name = self.compartment_set.as_ref()?;
        if sets.contains_key(name) {
            return None;
        }
        let there: Vec<&str> = sets.keys().map(String::as_str).collect();
        let message = format!(
            "no compartment set is called {name} (there are: {}): its compartments are placed evenly along sections",
            there.join(", ")
        );
        Some(Warning::new(
            &self.config,
            &self.key,
            "compartment_set_unknown",
            message,
        ))
    }
}
