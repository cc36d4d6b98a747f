//! The state: all that the window shows. Panels are functions of it.

mod counters;
mod crossings;
mod derived;
mod dimension_table;
mod dimensions;
mod effect;
mod layout;
mod leaving;
mod markers;
mod meshes;
mod messages;
mod partners;
mod parts;
mod picked;
mod placing;
mod plots;
mod pointing;
mod split;
mod taste;
mod tools;
mod traces;
mod views;

use std::path::PathBuf;
use std::sync::Arc;

use neurotess::circuit::{Circuit, NodeRef};
use neurotess::render::{MarkerShape, Side};

use crate::model::changes::Changes;
use crate::model::circuits::Circuits;
use crate::model::command::{Command, Edit, Tab, Toggles};
use crate::model::crossings::CrossingList;
use crate::model::document::{Document, Look, SourceId};
use crate::model::history::History;
use crate::model::markers::MarkerData;
use crate::model::measuring::Measuring;
use crate::model::meshes::MeshData;
use crate::model::playback::Playback;
use crate::model::plots::MeasurePlot;
use crate::model::save::{SaveForm, SaveRequest};
use crate::model::settings::Settings;
use crate::model::sources::{self, Source, Sources};
use crate::model::traces::TraceData;
use crate::model::view::View;

pub use counters::{Counters, Draft, Drawing, Lowered, Rebuilds, StaticFigures};
use derived::Derived;
pub(crate) use derived::{PlacementsKey, SpheresKey};
pub use effect::{Dialog, Effect};
pub use layout::Layout;
pub(crate) use meshes::MeshesKey;
pub use messages::{Messages, Problem};
pub use picked::{CellPart, Picked};
pub use pointing::Pointing;
pub use tools::Tools;
pub(crate) use traces::part_name;
pub use views::Views;

/// All that the window shows.
pub struct State {
    /// The document, which is saved and whose edits can be undone.
    pub document: Document,
    /// Which edits the session's file has.
    pub changes: Changes,
    /// Whether files are being written.
    pub writing: bool,
    /// Earlier and later documents.
    pub history: History,
    /// Open tracings.
    pub sources: Sources,
    /// Open circuits.
    pub circuits: Circuits,
    /// Synapses and points that were read.
    pub marker_data: MarkerData,
    /// Meshes beside the cells that were read.
    pub mesh_data: MeshData,
    /// Playback of the recording.
    pub playback: Playback,
    /// What was read for the plot of values over time.
    pub traces: TraceData,
    /// What *Inspect* plots of the selected cells.
    pub measures: MeasurePlot,
    /// Where the selected cells' surfaces cross themselves.
    pub crossings: CrossingList,
    /// The camera's view.
    pub view: View,
    /// What is under the cursor, and what was clicked last.
    pub pointing: Pointing,
    /// Tools that take clicks in the picture.
    pub tools: Tools,
    /// Which parts of the window show.
    pub layout: Layout,
    /// Views beside the current one, and how it came to be.
    pub views: Views,
    /// What is said, and what went wrong.
    pub messages: Messages,
    /// What draws, and what it took.
    pub drawing: Drawing,
    /// Settings, which are kept between starts.
    pub settings: Settings,
    /// The look that a picture gave, until it is changed.
    look_of_picture: Option<Look>,
    /// Inputs of the panel that saves.
    pub save: SaveForm,
    /// The session's file, once there is one.
    pub session: Option<PathBuf>,
    /// What the program must do outside the state.
    pub effects: Vec<Effect>,
    /// Commands that panels have requested.
    pub requests: Vec<Command>,
    derived: Derived,
}

impl State {
    /// A state with nothing open.
    pub fn new(settings: Settings) -> Self {
        Self {
            document: Document {
                look: settings.look.clone(),
                detail: settings.detail,
                ..Document::default()
            },
            changes: Changes::default(),
            writing: false,
            look_of_picture: None,
            history: History::default(),
            sources: Sources::default(),
            circuits: Circuits::default(),
            marker_data: MarkerData::default(),
            mesh_data: MeshData::default(),
            playback: Playback::default(),
            traces: TraceData::default(),
            measures: MeasurePlot::default(),
            crossings: CrossingList::default(),
            view: View::default(),
            pointing: Pointing::default(),
            tools: Tools::default(),
            layout: Layout::default(),
            views: Views::default(),
            messages: Messages::default(),
            drawing: Drawing::default(),
            save: SaveForm::new(&settings),
            settings,
            session: None,
            effects: Vec::new(),
            requests: Vec::new(),
            derived: Derived::default(),
        }
    }

    /// What titles of commands depend on.
    pub fn toggles(&self) -> Toggles {
        Toggles {
            orthographic: self.view.orthographic,
            y_down: self.document.y_down,
            grid: self.document.grid,
            frozen: self.views.frozen.is_some(),
            caches: self.settings.caches,
            dark: self.settings.dark,
            playing: self.playback.playing,
            measuring: self.tools.measuring.is_some(),
            synapses: self.document.markers.synapses,
            contacts: self.document.markers.shape == MarkerShape::Contact,
            traces: self.traces.open,
            crossings: self.crossings.open,
            lasso: self.settings.lasso,
            placing: self.tools.placing.is_some(),
            clamped: self.document.neurons.clamps_selected(),
            split: self.views.split.is_some(),
            linked: self.views.split.is_some_and(|split| split.linked),
            presenting: self.layout.presenting,
            turning: self.views.turning,
            full_screen: self.layout.full_screen,
        }
    }

    /// Runs a command.
    pub fn run(&mut self, command: impl Into<Command>) {
        let command = command.into();
        if !matches!(command, Command::Edit(_)) {
            self.history.end_joining();
        }
        match command {
            Command::Edit(edit) => self.edit(edit),
            Command::Undo => {
                let y_down = self.document.y_down;
                let mut number = self.changes.document();
                self.messages.status = match self.history.undo(&mut self.document, &mut number) {
                    Some(name) => {
                        self.changes.note_return(number);
                        format!("Undone: {}", name.to_lowercase())
                    }
                    None => "Nothing to undo".into(),
                };
                self.forget_what_is_gone();
                self.show_upright(y_down);
            }
            Command::Redo => {
                let y_down = self.document.y_down;
                let mut number = self.changes.document();
                self.messages.status = match self.history.redo(&mut self.document, &mut number) {
                    Some(name) => {
                        self.changes.note_return(number);
                        format!("Redone: {}", name.to_lowercase())
                    }
                    None => "Nothing to redo".into(),
                };
                self.forget_what_is_gone();
                self.show_upright(y_down);
            }
            Command::AskFiles(purpose) => self.layout.dialog = Dialog::Files(purpose),
            Command::Quit | Command::Open(_) if self.loses_work(&command) => {
                self.layout.dialog = Dialog::Unsaved(Box::new(command));
            }
            Command::Unasked(command) => self.run_unasked(*command),
            Command::Open(_) => self.run_unasked(command),
            Command::OpenSample(kind) => {
                let sample = sources::sample(kind);
                self.effects.push(Effect::Load(vec![sample]));
            }
            Command::Reload => self.effects.push(Effect::Reload),
            Command::Cancel => self.effects.push(Effect::Cancel),
            Command::Quit => self.run_unasked(command),
            Command::Recover(open) => self.effects.push(Effect::Recover(open)),
            Command::Look(side) => {
                self.effects.push(Effect::Go(self.fit(side)));
                self.views.fitted = Some(side);
            }
            Command::Home => self.run(Command::Look(Side::Front)),
            Command::Focus => self.focus(),
            Command::Go(view) => {
                self.effects.push(Effect::Go(view));
                self.views.fitted = None;
            }
            Command::SaveView => self.save_view(),
            Command::GoSaved(index) => self.go_to_saved(index),
            Command::SetOrthographic(on) => self.effects.push(Effect::Project(on)),
            Command::SetYDown(y_down) => {
                self.run(Edit::SetYDown(y_down));
                self.run(Command::Home);
            }
            Command::SetLasso(lasso) => {
                self.settings.lasso = lasso;
                let area = if lasso { "lasso" } else { "rectangle" };
                self.messages.status = format!("Ctrl and a drag select with a {area}");
            }
            Command::SetPlacing(on) => self.set_placing(on),
            Command::EndPlacing => {
                if let Some(placing) = &mut self.tools.placing {
                    placing.drag = None;
                }
            }
            Command::Duplicate => self.duplicate(),
            Command::PutBack => self.put_back(),
            Command::SetPresenting(on) => self.present(on),
            Command::SetSplit(on) => self.set_split(on),
            Command::SetLinked(on) => self.set_linked(on),
            Command::SetTurning(on) => self.views.turning = on,
            Command::SetFullScreen(on) => self.fill_screen(on),
            Command::ShowTraces(open) => self.traces.open = open,
            Command::PlotMeasure(form) => self.measures.form = form,
            Command::ListCrossings(open) => self.list_crossings(open),
            Command::GoCrossing(index) => self.go_to_crossing(index),
            Command::TogglePlay => self.playback.play(!self.playback.playing),
            Command::Seek(time) => self.playback.seek(time),
            Command::StepTime(frames) => self.playback.step(frames),
            Command::SetPace(pace) => self.playback.pace = pace,
            Command::SetFrozen(frozen) => self.views.frozen = frozen.then_some(self.view),
            Command::Show(tab) => (self.layout.tab, self.layout.panels) = (tab, true),
            Command::ToggleKeys => self.toggle(Dialog::Keys),
            Command::TogglePalette => self.toggle(Dialog::Palette(String::new(), 0)),
            Command::ToggleProblems => self.toggle(Dialog::Problems),
            Command::SetCaches(caches) => self.settings.caches = caches,
            Command::SetDark(dark) => {
                self.settings.dark = dark;
            }
            Command::TogglePanels => self.layout.panels = !self.layout.panels,
            Command::SetMeasuring(on) => {
                self.tools.measuring = on.then(Measuring::default);
                if on {
                    self.layout.tab = Tab::Inspect;
                }
            }
            Command::MeasureFrom(anchor) => {
                self.tools.measuring = Some(Measuring {
                    first: Some(anchor),
                    ..self.tools.measuring.unwrap_or_default()
                });
            }
            Command::LeaveMeasuring => self.leave_measuring(),
            Command::CopyDimensions(which) => self.copy_dimensions(which),
            Command::AddKeyView => {
                self.views.key_views.push(self.view);
                self.changes.note_lasting();
                self.messages.status =
                    format!("Key view {} kept (Save, Film)", self.views.key_views.len());
            }
            Command::DropKeyView(which) => {
                if which < self.views.key_views.len() {
                    self.views.key_views.remove(which);
                    self.changes.note_lasting();
                }
            }
            Command::OpenPoints(path) => {
                self.marker_data.forget_points();
                self.run(Edit::SetPoints(Some(path)));
            }
            Command::OpenMeshes(paths) => self.open_meshes(paths),
            Command::OpenPalette(path) => self.effects.push(Effect::OpenPalette(path)),
            Command::SavePalette(path) => self.effects.push(Effect::SavePalette(path)),
            Command::SaveSession(path) => self.save(SaveRequest::Session(path)),
            Command::SaveMeshes(options) => self.save(SaveRequest::Meshes(Box::new(options))),
            Command::SavePage(path) => self.save(SaveRequest::Page(path)),
            Command::SavePicture(options) => self.save(SaveRequest::Picture(options)),
            Command::SaveFilm(options) => self.save(SaveRequest::Film(options)),
            Command::SavePlot(of, path) => self.save_plot(of, path),
        }
    }

    fn edit(&mut self, edit: Edit) {
        let edit = match edit {
            // Where the list is filtered, all are those that it shows.
            Edit::SelectAll if !self.layout.search.is_empty() => {
                let shows = |&neuron: &usize| self.document.neurons.shows(neuron);
                Edit::Select(self.found().iter().copied().filter(shows).collect(), false)
            }
            edit => edit,
        };
        let before = self.document.clone();
        let (name, joins) = (edit.name(), edit.joins());
        let measures = matches!(edit, Edit::AddDimension(_));
        let is_work = edit.is_work();
        let spreads = matches!(edit, Edit::SetGrid(_) | Edit::Duplicate(_));
        edit.apply(&mut self.document);
        if self.document != before {
            let number = self.changes.document();
            self.history.keep(name, (before, number), joins);
            if is_work {
                self.changes.note();
            }
            self.remember();
            if measures {
                self.end_measure();
            }
            if spreads {
                self.show_all();
            }
        }
        self.forget_what_is_gone();
    }

    fn save(&mut self, request: SaveRequest) {
        self.effects.push(Effect::Save(request));
    }

    fn toggle(&mut self, dialog: Dialog) {
        let same = std::mem::discriminant(&self.layout.dialog) == std::mem::discriminant(&dialog);
        self.layout.dialog = if same { Dialog::Nothing } else { dialog };
    }

    /// Shows everything anew after an undo, if y points the other way.
    fn show_upright(&mut self, before: bool) {
        if self.document.y_down != before {
            self.run(Command::Home);
        }
    }

    fn forget_what_is_gone(&mut self) {
        let neurons = self.document.neurons.len();
        let there = |p: &Picked| p.neuron < neurons;
        self.pointing.hovered = self.pointing.hovered.filter(there);
        self.pointing.picked = self.pointing.picked.filter(there);
        self.forget_lost_ends();
        self.forget_lost_markers();
    }

    /// Number of neurons that show.
    pub(crate) fn shown(&self) -> usize {
        self.document.neurons.len() - self.document.neurons.hidden().len()
    }

    /// The source of a neuron.
    pub fn source_of(&self, neuron: usize) -> Option<&Source> {
        let neuron = self.document.neurons.get(neuron)?;
        self.sources.get(neuron.source)
    }

    /// The node of a circuit that has a tracing for itself.
    pub(crate) fn node_of(&self, source: SourceId) -> Option<(Arc<Circuit>, NodeRef)> {
        let neurons = self.document.neurons.iter();
        let mut neurons = neurons.filter(|neuron| neuron.source == source);
        let node = match (neurons.next(), neurons.next()) {
            (Some(neuron), None) => neuron.node?,
            _ => return None,
        };
        Some((self.circuits.shared(node.circuit)?, node.node))
    }
}
