//! All that the window shows, in one place; panels are functions of it.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use neurotess::render::{BoundingSphere, Placement, Side};

use crate::model::circuits::Circuits;
use crate::model::command::{Ask, Command, Edit, Tab, Toggles};
use crate::model::document::{self, Document, Neuron, NeuronRevisions, SourceId};
use crate::model::history::History;
use crate::model::playback::Playback;
use crate::model::revision::{Memo, Revision};
use crate::model::save::{SaveForm, SaveRequest};
use crate::model::settings::Settings;
use crate::model::sources::{self, Source, Sources, extent};
use crate::model::totals::{self, Totals};
use crate::model::view::View;

/// From so many neurons on, a few balls around each will do.
const MANY: usize = 64;

/// A piece of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellPart {
    /// Its soma.
    Soma,
    /// A neurite, from 0.
    Neurite(u32),
    /// A section, as in the morphology.
    Section(u32),
}

/// What the cursor is at or was clicked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Picked {
    /// Place among the neurons.
    pub neuron: usize,
    /// Which piece of it.
    pub part: CellPart,
}

/// Something that went wrong or was lowered, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file or thing.
    pub what: String,
    /// The reason, and what to do.
    pub why: String,
}

/// What a frame drew, for the panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counters {
    /// Triangles drawn, if counted.
    pub triangles: u64,
    /// Patches drawn, and those there are.
    pub patches: [u64; 2],
    /// Bytes on the device: of cells, and of pictures.
    pub bytes: [u64; 2],
    /// Milliseconds of the last frames.
    pub frames_ms: Vec<f32>,
    /// How often the picture's parts were made.
    pub rebuilds: Rebuilds,
    /// How drafts are lowered.
    pub draft: Draft,
    /// How the picture at rest is lowered, if it is.
    pub lowered: Option<Lowered>,
}

/// How the picture at rest is less than what is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lowered {
    /// By exploration: triangles drawn, and those that half a pixel would take, once they are known.
    Triangles(Option<[u64; 2]>),
    /// So many times the error.
    Error(f32),
}

/// How what is drawn while something moves is less than the full picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Draft {
    /// At most so many triangles, for those that show most.
    Budget(u32),
    /// So many times the error.
    Error(f32),
}

impl Default for Draft {
    fn default() -> Self {
        Self::Error(1.0)
    }
}

/// What placements depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PlacementsKey {
    /// Of the neurons.
    pub(crate) members: Revision,
    /// Of the meshes, if neurons are side by side.
    grid: Option<Revision>,
}

/// What the bounding spheres of all that shows depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SpheresKey {
    placements: PlacementsKey,
    hidden: Revision,
    geometry: Revision,
}

/// What follows from the rest and takes time that grows with the number of neurons.
#[derive(Debug, Default)]
struct Derived {
    placements: Memo<PlacementsKey, Vec<Placement>>,
    spheres: Memo<SpheresKey, Vec<BoundingSphere>>,
    found: Memo<(Revision, String), Vec<usize>>,
    totals: Memo<(NeuronRevisions, Revision), Totals>,
    kinds: Memo<Revision, BTreeSet<i32>>,
}

/// How often the picture's parts were made since the window opened: an idle frame makes none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rebuilds {
    /// Placements of all neurons.
    pub placements: u64,
    /// Bounding spheres of all that shows.
    pub spheres: u64,
    /// Instances on the device.
    pub instances: u64,
    /// Selected, ghosted: states of instances on the device.
    pub states: u64,
    /// Meshes of templates on the device.
    pub templates: u64,
    /// Proxies of templates on the device.
    pub proxies: u64,
    /// Tables of colors.
    pub colors: u64,
}

/// All that there is.
pub struct State {
    /// What can be undone and is saved.
    pub document: Document,
    /// Documents before and after.
    pub history: History,
    /// Open tracings.
    pub sources: Sources,
    /// Open circuits.
    pub circuits: Circuits,
    /// The recording's time, and how that goes on.
    pub playback: Playback,
    /// From where one looks.
    pub view: View,
    /// The side from which the view shows everything, until it is moved by hand.
    pub fitted: Option<Side>,
    /// Views of a film.
    pub key_views: Vec<View>,
    /// The view that levels are frozen for.
    pub frozen: Option<View>,
    /// What is under the cursor, in the picture or in the tree.
    pub hovered: Option<Picked>,
    /// The neurite whose ring's slider is touched.
    pub touched: Option<(SourceId, u32)>,
    /// What was clicked last.
    pub picked: Option<Picked>,
    /// What went wrong, in the order in which it did.
    pub problems: Vec<Problem>,
    /// The last word, for the status bar.
    pub status: String,
    /// The panel on the right.
    pub tab: Tab,
    /// Words to search the list by.
    pub search: String,
    /// Which window is open over the others.
    pub over: Over,
    /// Whether the side panels show.
    pub panels: bool,
    /// What is remembered between starts.
    pub settings: Settings,
    /// What is to be saved, and how.
    pub save: SaveForm,
    /// Counters of the level of detail.
    pub counters: Counters,
    /// The adapter, and whether it is software.
    pub adapter: (String, bool),
    /// The session's file, once there is one.
    pub session: Option<PathBuf>,
    /// Width by height of the picture.
    pub aspect: f64,
    /// What is to be done beside the state.
    pub effects: Vec<Effect>,
    /// Commands that panels asked for.
    pub requests: Vec<Command>,
    /// A part to be scrolled to in the tree.
    pub reveal: Option<Picked>,
    derived: Derived,
}

/// A window over the others.
#[derive(Clone, Debug, Default)]
pub enum Over {
    /// None.
    #[default]
    Nothing,
    /// Keys and mouse.
    Keys,
    /// Commands, with what is searched and which is chosen.
    Palette(String, usize),
    /// What went wrong.
    Problems,
    /// Files to choose.
    Files(Ask),
    /// Files exist: what to do if they may be replaced.
    Replace(PathBuf, Box<Command>),
}

/// What a command asks of the program around.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Read files.
    Load(Vec<PathBuf>),
    /// Read changed files again.
    Reload,
    /// Write files.
    Save(SaveRequest),
    /// End what is under way.
    Cancel,
    /// Go to a view, smoothly.
    Go(View),
    /// Leave.
    Quit,
}

impl State {
    /// Nothing open.
    pub fn new(settings: Settings) -> Self {
        Self {
            document: Document {
                look: settings.look.clone(),
                detail: settings.detail,
                ..Document::default()
            },
            history: History::default(),
            sources: Sources::default(),
            circuits: Circuits::default(),
            playback: Playback::default(),
            view: View::default(),
            fitted: None,
            key_views: Vec::new(),
            frozen: None,
            hovered: None,
            touched: None,
            picked: None,
            problems: Vec::new(),
            status: String::new(),
            tab: Tab::default(),
            search: String::new(),
            over: Over::Nothing,
            panels: true,
            save: SaveForm::new(&settings),
            settings,
            counters: Counters::default(),
            adapter: (String::new(), false),
            session: None,
            aspect: 1.0,
            effects: Vec::new(),
            requests: Vec::new(),
            reveal: None,
            derived: Derived::default(),
        }
    }

    /// What titles of commands depend on.
    pub fn toggles(&self) -> Toggles {
        Toggles {
            y_down: self.settings.y_down,
            grid: self.document.grid,
            frozen: self.frozen.is_some(),
            dark: self.settings.dark,
            playing: self.playback.playing,
        }
    }

    /// Does a command.
    pub fn run(&mut self, command: impl Into<Command>) {
        let command = command.into();
        if !matches!(command, Command::Edit(_)) {
            self.history.end_joining();
        }
        match command {
            Command::Edit(edit) => self.edit(edit),
            Command::Undo => {
                self.status = match self.history.undo(&mut self.document) {
                    Some(name) => format!("Undone: {}", name.to_lowercase()),
                    None => "Nothing to undo".into(),
                };
                self.forget_what_is_gone();
            }
            Command::Redo => {
                self.status = match self.history.redo(&mut self.document) {
                    Some(name) => format!("Redone: {}", name.to_lowercase()),
                    None => "Nothing to redo".into(),
                };
                self.forget_what_is_gone();
            }
            Command::AskFiles(ask) => self.over = Over::Files(ask),
            Command::Open(paths) => {
                self.settings.remember_files(&paths);
                self.effects.push(Effect::Load(paths));
            }
            Command::OpenSample(kind) => {
                let sample = sources::sample(kind);
                self.effects.push(Effect::Load(vec![sample]));
            }
            Command::Reload => self.effects.push(Effect::Reload),
            Command::Cancel => self.effects.push(Effect::Cancel),
            Command::Quit => self.effects.push(Effect::Quit),
            Command::Look(side) => {
                self.effects.push(Effect::Go(self.fit(side)));
                self.fitted = Some(side);
            }
            Command::Home => self.run(Command::Look(Side::Front)),
            Command::Focus => {
                let any = self.document.selected().next().is_some();
                let spheres = self.outline(|n| n.selected || !any);
                let (low, high) = extent(&spheres);
                if !spheres.is_empty() {
                    let sphere = ((low + high) / 2.0, (high - low).length() / 2.0);
                    self.run(Command::Go(self.view.focused(sphere)));
                }
            }
            Command::Go(view) => {
                self.effects.push(Effect::Go(view));
                self.fitted = None;
            }
            Command::SetYDown(y_down) => {
                self.settings.y_down = y_down;
                self.run(Command::Home);
            }
            Command::TogglePlay => self.playback.play(!self.playback.playing),
            Command::Seek(time) => self.playback.seek(time),
            Command::StepTime(frames) => self.playback.step(frames),
            Command::SetPace(pace) => self.playback.pace = pace,
            Command::SetFrozen(frozen) => self.frozen = frozen.then_some(self.view),
            Command::Show(tab) => (self.tab, self.panels) = (tab, true),
            Command::ToggleKeys => self.toggle(Over::Keys),
            Command::TogglePalette => self.toggle(Over::Palette(String::new(), 0)),
            Command::ToggleProblems => self.toggle(Over::Problems),
            Command::SetDark(dark) => {
                self.settings.dark = dark;
            }
            Command::TogglePanels => self.panels = !self.panels,
            Command::AddKeyView => {
                self.key_views.push(self.view);
                self.status = format!("Key view {} kept (Save, Film)", self.key_views.len());
            }
            Command::DropKeyView(which) => {
                if which < self.key_views.len() {
                    self.key_views.remove(which);
                }
            }
            Command::SaveSession(path) => self.save(SaveRequest::Session(path)),
            Command::SaveMeshes(options) => self.save(SaveRequest::Meshes(options)),
            Command::SavePicture(options) => self.save(SaveRequest::Picture(options)),
            Command::SaveFilm(options) => self.save(SaveRequest::Film(options)),
        }
    }

    fn edit(&mut self, edit: Edit) {
        let before = self.document.clone();
        let (name, joins) = (edit.name(), edit.joins());
        edit.apply(&mut self.document);
        if self.document != before {
            self.history.keep(name, before, joins);
            self.remember();
        }
        self.forget_what_is_gone();
    }

    fn save(&mut self, request: SaveRequest) {
        self.effects.push(Effect::Save(request));
    }

    /// Everything, from a side.
    fn fit(&self, side: Side) -> View {
        let spheres = self.outline(|_| true);
        self.view
            .fitted(side, self.settings.y_down, self.aspect, &spheres)
    }

    /// The picture has another form: what was seen is still seen. Gives the view, if it is another one.
    pub(crate) fn reshape(&mut self, aspect: f64) -> Option<View> {
        let before = std::mem::replace(&mut self.aspect, aspect);
        if before == aspect || self.document.neurons.is_empty() {
            return None;
        }
        Some(match self.fitted {
            Some(side) => self.fit(side),
            None => self.view.reshaped(before, aspect),
        })
    }

    fn toggle(&mut self, over: Over) {
        let same = std::mem::discriminant(&self.over) == std::mem::discriminant(&over);
        self.over = if same { Over::Nothing } else { over };
    }

    fn remember(&mut self) {
        self.settings.look = self.document.look.clone();
        self.settings.detail = self.document.detail;
    }

    fn forget_what_is_gone(&mut self) {
        let neurons = self.document.neurons.len();
        let there = |p: &Picked| p.neuron < neurons;
        self.hovered = self.hovered.filter(there);
        self.picked = self.picked.filter(there);
    }

    /// Where all neurons are, in the order of the list.
    pub fn placements(&self) -> Arc<Vec<Placement>> {
        let neurons = &self.document.neurons;
        self.derived.placements.get(self.placements_key(), || {
            if !self.document.grid {
                return neurons.iter().map(|n| n.placement).collect();
            }
            let extents = neurons.iter().map(|neuron| {
                let (low, high) = extent(&self.spheres_of(neuron.source, neuron.placement));
                ((low + high) / 2.0, high - low)
            });
            document::grid(neurons, &extents.collect::<Vec<_>>())
        })
    }

    /// What placements depend on.
    pub(crate) fn placements_key(&self) -> PlacementsKey {
        let grid = self.document.grid;
        PlacementsKey {
            members: self.document.neurons.revisions().members,
            // Side by side, neurons need room for their meshes.
            grid: grid.then(|| self.sources.geometry()),
        }
    }

    fn spheres_of(&self, source: SourceId, placement: Placement) -> Vec<BoundingSphere> {
        let many = self.document.neurons.len() >= MANY;
        let spheres = self.sources.get(source).map_or(&[][..], |s| match many {
            true => &s.few_spheres,
            false => &s.spheres,
        });
        spheres
            .iter()
            .map(|&(c, r)| (placement.world_from_cell(c), r * placement.scale))
            .collect()
    }

    /// Bounding spheres (µm) of all that shows.
    pub fn spheres(&self) -> Arc<Vec<BoundingSphere>> {
        let derive = || self.spheres_where(|_| true);
        self.derived.spheres.get(self.spheres_key(), derive)
    }

    /// What the spheres of all that shows depend on.
    pub(crate) fn spheres_key(&self) -> SpheresKey {
        SpheresKey {
            placements: self.placements_key(),
            hidden: self.document.neurons.revisions().hidden,
            geometry: self.sources.geometry(),
        }
    }

    fn spheres_where(&self, fits: impl Fn(&Neuron) -> bool) -> Vec<BoundingSphere> {
        let placements = self.placements();
        let neurons = self.document.neurons.iter().zip(placements.iter());
        neurons
            .filter(|(n, _)| !n.hidden && fits(n))
            .flat_map(|(n, placement)| self.spheres_of(n.source, *placement))
            .collect()
    }

    /// Spheres (µm) at the tracing points of what shows and fits: tighter than [`State::spheres`], to
    /// frame it. Of many neurons a few spheres each.
    pub fn outline(&self, fits: impl Fn(&Neuron) -> bool) -> Vec<BoundingSphere> {
        let placements = self.placements();
        let neurons = self.document.neurons.iter().zip(placements.iter());
        let shown: Vec<_> = neurons.filter(|(n, _)| !n.hidden && fits(n)).collect();
        if shown.len() >= MANY {
            return self.spheres_where(fits);
        }
        let spheres = |(neuron, placement): (&Neuron, &Placement)| {
            let mesh = self.sources.get(neuron.source).map(|s| &s.generated.mesh);
            let points = mesh.into_iter().flat_map(|mesh| {
                let points = mesh.tracing.iter();
                points.map(|p| (mesh.origin + p.center.as_dvec3(), f64::from(p.radius)))
            });
            let placed = points.map(|(c, r)| (placement.world_from_cell(c), r * placement.scale));
            placed.collect::<Vec<_>>()
        };
        shown.into_iter().flat_map(spheres).collect()
    }

    /// Indices of the neurons whose names contain the search text.
    pub(crate) fn found(&self) -> Arc<Vec<usize>> {
        let members = self.document.neurons.revisions().members;
        let derive = || {
            let text = self.search.to_lowercase();
            let neurons = self.document.neurons.iter().enumerate();
            let found =
                neurons.filter(|(_, n)| text.is_empty() || n.name.to_lowercase().contains(&text));
            found.map(|(i, _)| i).collect()
        };
        self.derived
            .found
            .get((members, self.search.clone()), derive)
    }

    /// Sums over what is selected; over all, if nothing is.
    pub(crate) fn totals(&self) -> Arc<Totals> {
        let neurons = &self.document.neurons;
        let key = (neurons.revisions(), self.sources.geometry());
        self.derived.totals.get(key, || {
            let any = !neurons.selected().is_empty();
            let counted = neurons.iter().filter(|n| n.selected || !any);
            Totals::of(counted.filter_map(|n| Some(&*self.sources.get(n.source)?.measures)))
        })
    }

    /// Kinds of sections of all open tracings.
    pub(crate) fn kinds(&self) -> Arc<BTreeSet<i32>> {
        let derive = || totals::kinds(&self.sources);
        self.derived.kinds.get(self.sources.geometry(), derive)
    }

    /// How often what grows with the neurons was derived: placements, and spheres.
    pub(crate) fn derivations(&self) -> [u64; 2] {
        [
            self.derived.placements.derived(),
            self.derived.spheres.derived(),
        ]
    }

    /// The source of a neuron.
    pub fn source_of(&self, neuron: usize) -> Option<&Source> {
        let neuron = self.document.neurons.get(neuron)?;
        self.sources.get(neuron.source)
    }

    /// Tells how saving ended.
    pub(crate) fn note_saved(&mut self, result: Result<String, String>) {
        match result {
            Ok(saved) => self.status = saved,
            Err(why) => {
                self.status = format!("Not saved: {why}");
                self.problem("save", why);
            }
        }
    }

    /// Notes something that went wrong.
    pub fn problem(&mut self, what: impl Into<String>, why: impl Into<String>) {
        let problem = Problem {
            what: what.into(),
            why: why.into(),
        };
        if !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }
}
