//! Colors in the window: by tracings, by a circuit's nodes, by a recording.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use neurotess::circuit::{Circuit, Compartment, NodeRef};
use neurotess::coloring::{
    self, Cell, ColorScheme, Coloring, Node, OwnColors, Recording, RecordingError,
};
use neurotess::generate::generate;
use neurotess::render::color::{ColorMap, Palette, Rgb};
use rayon::prelude::*;

use crate::model::circuits::Circuits;
use crate::model::document::{ColorBy, Document, Look};
use crate::model::ids::{CircuitId, CircuitNode};
use crate::model::revision::Revision;
use crate::model::state::State;
use crate::scene::templates::SceneTemplate;

/// What colors depend on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ColorInputs {
    /// What neurons are colored by, and which neurons.
    pub(crate) subject: ColorSubject,
    /// The colors that are used.
    pub(crate) style: ColorStyle,
}

/// What neurons are colored by, and which neurons.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ColorSubject {
    by: ColorBy,
    attribute: String,
    report: Option<PathBuf>,
    /// Revision of the neurons, if colors differ among those of one tracing.
    members: Option<Revision>,
}

/// The colors that are used.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ColorStyle {
    palette: Palette,
    own: OwnColors,
    map: ColorMap,
    trim: bool,
    background: Rgb,
    range: Option<[f32; 2]>,
}

impl ColorInputs {
    pub(crate) fn new(document: &Document) -> Self {
        let look = &document.look;
        let by = look.color_by;
        let members = document.neurons.revisions().members;
        let attribute = match by {
            ColorBy::Attribute => look.attribute.clone(),
            _ => String::new(),
        };
        let report = document.report.clone();
        Self {
            subject: ColorSubject {
                by,
                attribute,
                report: report.filter(|_| by == ColorBy::Value),
                members: by.is_of_neurons().then_some(members),
            },
            style: ColorStyle {
                palette: look.palette,
                own: look.own_colors.clone(),
                map: look.color_map,
                trim: look.trim_map,
                background: look.background,
                range: look.range.filter(|_| by.has_range()),
            },
        }
    }
}

/// The colors that the panel has set.
pub(crate) fn color_scheme(look: &Look) -> ColorScheme {
    let background = Some(look.background);
    ColorScheme {
        palette: look.palette,
        own_colors: look.own_colors.clone(),
        background,
        scale: match look.trim_map {
            true => look.color_map.scale_before(look.background),
            false => look.color_map.scale(),
        },
        range: look.range.filter(|[low, high]| low < high),
    }
}

/// All that a coloring is computed from, for another thread.
#[derive(Clone, Debug)]
pub(crate) struct ColorRequest {
    look: Look,
    report: Option<PathBuf>,
    /// Time (ms) of the recording.
    time: f64,
    circuits: Circuits,
    /// Index of the source, name and node of each neuron.
    neurons: Vec<(usize, String, Option<CircuitNode>)>,
}

/// A coloring, and the recording that it shows.
#[derive(Clone, Debug)]
pub(crate) struct ColorResult {
    pub(crate) coloring: Coloring,
    /// A recording with the range of its values.
    pub(crate) recording: Option<(Arc<Recording>, [f32; 2])>,
    /// What could not be colored, and why.
    pub(crate) problem: Option<(String, String)>,
}

impl From<Coloring> for ColorResult {
    fn from(coloring: Coloring) -> Self {
        Self {
            coloring,
            recording: None,
            problem: None,
        }
    }
}

impl ColorRequest {
    /// `sources`: the templates, sorted by id.
    pub(crate) fn new(state: &State, sources: &[SceneTemplate]) -> Self {
        let document = &state.document;
        let neurons = document.neurons.iter().map(|neuron| {
            let source = sources.binary_search_by_key(&neuron.source, |s| s.id);
            (source.unwrap_or(0), neuron.name.clone(), neuron.node)
        });
        Self {
            look: document.look.clone(),
            report: document.report.clone(),
            time: state.playback.pace.time,
            circuits: state.circuits.clone(),
            neurons: neurons.collect(),
        }
    }

    /// The templates meshed as they are drawn: with larger radii, and with a point at the middle of each
    /// compartment of the report, if its values are shown, so that also a dendrite of two traced points
    /// shows all its compartments. A template that cannot be meshed like this stays as it is. `before`:
    /// templates whose meshes are taken where they are the same.
    pub(crate) fn meshed(
        &self,
        mut sources: Vec<SceneTemplate>,
        before: &[SceneTemplate],
    ) -> Vec<SceneTemplate> {
        let cuts = self.cuts();
        let places = sources.par_iter_mut().enumerate();
        places.for_each(|(place, source)| {
            let elements = cuts.get(&place);
            if source.is_as_traced() && elements.is_none() {
                return;
            }
            let same = |other: &&SceneTemplate| {
                source.same_as(other) && Arc::ptr_eq(&source.morphology, &other.morphology)
            };
            if elements.is_none()
                && let Some(before) = before.get(place).filter(same)
            {
                source.generated = Arc::clone(&before.generated);
                source.proxy = None;
                return;
            }
            let morphology = match elements {
                Some(elements) => Arc::new(coloring::with_middles(&source.morphology, elements)),
                None => Arc::clone(&source.morphology),
            };
            if let Ok(generated) = generate(&morphology, &source.options) {
                source.morphology = morphology;
                source.generated = Arc::new(generated);
                source.proxy = None;
            }
        });
        sources
    }

    /// The compartments of the report on each template, if its values are shown.
    fn cuts(&self) -> HashMap<usize, Vec<Compartment>> {
        let report = self.report.as_ref();
        let Some(report) = report.filter(|_| self.look.color_by == ColorBy::Value) else {
            return HashMap::new();
        };
        for (id, circuit) in self.circuits_newest_first() {
            let nodes_of_cells = self.neurons.iter().filter_map(|(source, _, of)| {
                let node = of.filter(|of| of.circuit == id)?.node;
                Some((*source, node))
            });
            let nodes_of_cells: Vec<_> = nodes_of_cells.collect();
            // Errors of the report are noted when its colors are computed.
            let cuts = coloring::cuts(report, circuit, &nodes_of_cells).unwrap_or_default();
            if !cuts.is_empty() {
                return cuts;
            }
        }
        HashMap::new()
    }

    /// Circuits of the neurons, the one opened last first.
    fn circuits_newest_first(&self) -> impl Iterator<Item = (CircuitId, &Circuit)> {
        let ids = self.neurons.iter().filter_map(|n| Some(n.2?.circuit));
        let mut ids: Vec<CircuitId> = ids.collect();
        ids.sort_unstable();
        ids.dedup();
        let known = |id| Some((id, self.circuits.get(id)?));
        ids.into_iter().rev().filter_map(known)
    }

    /// The coloring; by types if the requested one is not possible.
    pub(crate) fn colors(&self, sources: &[SceneTemplate]) -> ColorResult {
        let cells: Vec<Cell<'_>> = sources
            .iter()
            .map(|s| Cell {
                name: &s.name,
                morphology: &s.morphology,
                mesh: &s.generated.mesh,
                radius_factor: s.drawn_factor(),
            })
            .collect();
        let color_scheme = color_scheme(&self.look);
        let of_type = || coloring::coloring(&cells, coloring::ColorBy::Type, &color_scheme);
        let instead = |(what, why): (String, String)| ColorResult {
            problem: Some((what, why)),
            ..of_type().into()
        };
        match self.look.color_by {
            _ if sources.is_empty() => of_type().into(),
            ColorBy::Neuron => {
                let names: Vec<String> = self.neurons.iter().map(|n| n.1.clone()).collect();
                coloring::each(&cells, &names, &color_scheme).into()
            }
            ColorBy::Attribute => self
                .by_attribute(&cells, &color_scheme)
                .unwrap_or_else(instead),
            ColorBy::Value => self.by_value(&cells, &color_scheme).unwrap_or_else(instead),
            by => {
                let by = by.in_library().unwrap_or_default();
                coloring::coloring(&cells, by, &color_scheme).into()
            }
        }
    }

    fn by_attribute(
        &self,
        cells: &[Cell<'_>],
        color_scheme: &ColorScheme,
    ) -> Result<ColorResult, (String, String)> {
        let node = |of: &Option<CircuitNode>| of.and_then(|of| self.circuits.node(of));
        let neurons: Vec<Option<Node<'_>>> = self.neurons.iter().map(|n| node(&n.2)).collect();
        let what = || "colors by attribute".to_owned();
        if neurons.iter().all(Option::is_none) {
            let why = "attributes are those of a circuit's cells: open a circuit";
            return Err((what(), why.into()));
        }
        let attribute = &self.look.attribute;
        coloring::by_attribute(cells, &neurons, attribute, color_scheme)
            .map(ColorResult::from)
            .map_err(|e| (what(), e.to_string()))
    }

    /// A coloring by the recording's values, with the first circuit that the recording fits.
    fn by_value(
        &self,
        cells: &[Cell<'_>],
        color_scheme: &ColorScheme,
    ) -> Result<ColorResult, (String, String)> {
        let Some(report) = &self.report else {
            let why = "there is no report: open one (File, Open report)";
            return Err(("colors by value".into(), why.into()));
        };
        let file = report.display().to_string();
        let mut why = "a report has values of a circuit's cells: open its circuit".to_owned();
        for (id, circuit) in self.circuits_newest_first() {
            let node = |of: CircuitNode| (of.circuit == id).then_some(of.node);
            let nodes_of_cells: Vec<(usize, Option<NodeRef>)> = self
                .neurons
                .iter()
                .map(|(source, _, of)| (*source, of.and_then(node)))
                .collect();
            match Recording::open(report, circuit, cells, &nodes_of_cells) {
                Ok(recording) => {
                    return self
                        .of_recording(recording, color_scheme)
                        .map_err(|e| (file, e));
                }
                Err(e) => why = without(&file, &e.to_string()),
            }
        }
        Err((file, why))
    }

    fn of_recording(
        &self,
        recording: Recording,
        color_scheme: &ColorScheme,
    ) -> Result<ColorResult, String> {
        let reason = |e: RecordingError| without(&recording.file, &e.to_string());
        let all = recording.range(&|_| true).map_err(reason)?;
        let range = color_scheme.range.unwrap_or(all);
        let time = recording.time.nearest(self.time);
        let frame = recording
            .at(time, self.look.decay, &|_| true)
            .map_err(reason)?;
        let mut coloring = recording.coloring(range, color_scheme);
        coloring.table.values = frame.values(range);
        Ok(ColorResult {
            coloring,
            recording: Some((Arc::new(recording), all)),
            problem: None,
        })
    }
}

/// A reason without the file's name, which the window shows beside it.
fn without(file: &str, text: &str) -> String {
    let rest = text.strip_prefix(file).unwrap_or(text);
    rest.trim_start_matches([':', ' ']).to_owned()
}
