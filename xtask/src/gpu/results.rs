//! What a run of the bundle found out: one JSON file, complete after every part.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::Context;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The name of the file.
pub(crate) const FILE: &str = "result.json";

/// All that a run found out.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub(crate) struct Results {
    /// Version and commit of what was run.
    pub(crate) version: String,
    pub(crate) commit: String,
    /// Day of the run, as in 2026-11-27.
    pub(crate) date: String,
    /// Processors of the machine.
    pub(crate) cores: usize,
    /// Whether scenes were reduced, for a trial in software.
    pub(crate) reduced: bool,
    /// Seconds of all parts together.
    pub(crate) seconds: f64,
    pub(crate) parts: Vec<Part>,
    /// Plots by name, as SVG.
    pub(crate) plots: BTreeMap<String, String>,
}

/// A part of the run.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Part {
    pub(crate) name: String,
    pub(crate) ended: Ended,
    pub(crate) seconds: f64,
    /// The figures; of a part that did not end well, those that it had said by then.
    pub(crate) figures: Value,
    /// Why it did not end well.
    pub(crate) why: String,
}

/// How a part ended.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Ended {
    Well,
    Failed,
    /// It took longer than it may.
    TooLate,
}

impl Results {
    /// The figures of a part that ended well.
    pub(crate) fn figures(&self, part: &str) -> Option<&Value> {
        let part = self.part(part)?;
        (part.ended == Ended::Well).then_some(&part.figures)
    }

    pub(crate) fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == name)
    }

    /// The adapter's name, as the part that looked at it says.
    pub(crate) fn adapter(&self) -> &str {
        let name = self.figures("adapter").map(|figures| &figures["adapter"]);
        name.and_then(Value::as_str).unwrap_or("no adapter")
    }

    /// Whether pictures were drawn on the processor.
    pub(crate) fn is_software(&self) -> bool {
        self.figures("adapter")
            .is_none_or(|figures| figures["software"] != false)
    }

    /// Reads such a file.
    pub(crate) fn read(file: &Path) -> anyhow::Result<Self> {
        let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
        serde_json::from_str(&text)
            .with_context(|| format!("{}: not the {FILE} of a bundle", file.display()))
    }

    /// Writes them to a folder; whoever kills the program meanwhile leaves the file of before.
    pub(crate) fn write(&self, folder: &Path) -> anyhow::Result<()> {
        replace(&folder.join(FILE), &serde_json::to_string_pretty(self)?)
    }
}

/// Writes a file beside the one that is there, and puts it in its place.
pub(crate) fn replace(file: &Path, text: &str) -> anyhow::Result<()> {
    let beside = file.with_extension("new");
    fs::write(&beside, text).with_context(|| beside.display().to_string())?;
    fs::rename(&beside, file).with_context(|| file.display().to_string())
}
