//! What pages of cells in memory show beside them: reports, synapses and points, by the options of `neurotess html`.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use clap::Parser;
use neurotess::circuit::{Circuit, Compartment, NodeRef};
use neurotess::coloring::{Cell, ColorScheme, cuts};
use neurotess::web::{PageMarkers, PageRecording};

use super::{markers, recording};
use crate::commands::render::DrawError;
use crate::options::markers::MarkerArgs;
use crate::options::time::Time;
use crate::report::{self, Common, Reporter, Usage, first_paragraph};

/// The options alone, without the program around them.
#[derive(Debug, Parser)]
struct Options {
    #[command(flatten)]
    common: Common,
    #[arg(long)]
    report: Option<PathBuf>,
    #[arg(long, allow_hyphen_values = true)]
    time: Option<Time>,
    #[command(flatten)]
    markers: MarkerArgs,
}

/// Reports, synapses and points that options ask for.
pub struct PageContent {
    options: Options,
    reporter: Reporter,
}

impl PageContent {
    /// Reads the options: `--report`, `--time`, and those of synapses and points.
    ///
    /// # Errors
    /// Wrong options.
    pub fn new(options: impl IntoIterator<Item = String>) -> Result<Self, DrawError> {
        let words = ["html".to_owned()].into_iter().chain(options);
        let options = Options::try_parse_from(words);
        let options = options.map_err(|e| DrawError::Option(first_paragraph(&e)))?;
        let reporter = Reporter::recording(options.common, &Arc::default());
        Ok(Self { options, reporter })
    }

    /// The compartments by which cells are cut so that they show a report, as [`cuts`] gives them. `shown`: the cell that
    /// each node shows.
    ///
    /// # Errors
    /// The report is invalid, or of another circuit.
    pub fn cuts(
        &self,
        circuit: &Circuit,
        shown: &[(usize, NodeRef)],
    ) -> Result<HashMap<usize, Vec<Compartment>>, DrawError> {
        let report = self.options.report.as_ref();
        let found = report
            .map(|report| cuts(report, circuit, shown))
            .transpose();
        let found = found.map_err(|e| DrawError::Failed(e.to_string()))?;
        Ok(found.unwrap_or_default())
    }

    /// The report, of cells which are these nodes of a circuit; `range`: the values at both ends of the scale.
    ///
    /// # Errors
    /// Cells of no circuit have no report; one that is invalid, or of another circuit.
    pub fn recording(
        &self,
        of: Option<(&Circuit, &[NodeRef])>,
        cells: &[Cell<'_>],
        range: Option<[f32; 2]>,
    ) -> Result<Option<PageRecording>, DrawError> {
        let Some(report) = &self.options.report else {
            return Ok(None);
        };
        let Some(of) = of else {
            let needed = "--report needs a circuit, whose cells have its values";
            return Err(DrawError::Option(needed.into()));
        };
        let asked = (&**report, self.options.time);
        recording::read(asked, of, cells, range, &self.reporter)
            .map(Some)
            .map_err(|e| told(&e))
    }

    /// Synapses or points; `of`: the nodes of a circuit that are shown.
    ///
    /// # Errors
    /// Wrong options; files that are invalid, or do not have what is asked for.
    pub fn markers(
        &self,
        of: Option<(&Circuit, &[NodeRef])>,
        scheme: &ColorScheme,
    ) -> Result<PageMarkers, DrawError> {
        markers::read(&self.options.markers, of, scheme, &self.reporter).map_err(|e| told(&e))
    }

    /// What there is to say about them.
    pub fn messages(&self) -> Vec<String> {
        self.reporter.take_recorded()
    }
}

fn told(error: &anyhow::Error) -> DrawError {
    match error.is::<Usage>() {
        true => DrawError::Option(report::told(error)),
        false => DrawError::Failed(report::told(error)),
    }
}
