//! The window: state, workers and stage together.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eframe::egui::{self, Key};
use egui_wgpu::RenderState;
use neurotess::render::DeviceError;

use crate::command::Command;
use crate::document::{Neuron, SomaEdit, SourceId};
use crate::panels;
use crate::save::{self, MeshPlan, Scenery};
use crate::scene;
use crate::session::{self, Session};
use crate::settings::Settings;
use crate::sources::{Found, Source, Stale};
use crate::stage::Stage;
use crate::state::{Effect, State};
use crate::view::View;
use crate::worker::{Message, Worker};

/// How long going to another view takes.
const GO: Duration = Duration::from_millis(260);

/// The whole program, without its frame.
pub struct Viewer {
    /// All that shows.
    pub state: State,
    /// What draws.
    pub stage: Stage,
    worker: Worker,
    /// A loading: what was found, and its cells by file.
    loading: Option<Loading>,
    going: Option<(View, View, Instant)>,
    /// What is fatal: the device is lost.
    pub fatal: Option<String>,
    quits: bool,
    theme: Option<(bool, u32)>,
    remembered: Settings,
    smooth: bool,
}

#[derive(Default)]
struct Loading {
    found: Found,
    ids: Vec<Option<SourceId>>,
    session: Option<Box<Session>>,
    failed: usize,
    /// Nothing was open before: the camera goes home.
    first: bool,
}

impl Viewer {
    /// In a window that has a device.
    ///
    /// # Errors
    /// The device refuses.
    pub fn new(
        ctx: &egui::Context,
        render: RenderState,
        settings: Settings,
    ) -> Result<Self, DeviceError> {
        let waker = ctx.clone();
        let stage = Stage::new(render)?;
        let mut state = State::new(settings.clone());
        let adapter = &stage.gpu().adapter;
        state.adapter = (adapter.to_string(), adapter.software);
        Ok(Self {
            state,
            stage,
            worker: Worker::new(move || waker.request_repaint()),
            loading: None,
            going: None,
            fatal: None,
            quits: false,
            theme: None,
            remembered: settings,
            smooth: true,
        })
    }

    /// Views change at once: for tests.
    pub fn without_motion(mut self) -> Self {
        self.smooth = false;
        self
    }

    /// Whether nothing is under way: all that is to be read is, and all is drawn.
    pub fn is_settled(&self) -> bool {
        let drawn = self.stage.is_settled() || self.state.document.neurons.is_empty();
        !self.worker.is_busy() && self.going.is_none() && self.loading.is_none() && drawn
    }

    /// Job of reading and of saving, for the status bar.
    pub(crate) fn jobs(&self) -> [Option<crate::worker::Job>; 2] {
        [self.worker.loading.clone(), self.worker.saving.clone()]
    }

    /// One frame.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        self.look(&ctx);
        for message in self.worker.messages() {
            self.take(message);
        }
        self.take_drops(&ctx);
        self.go_on(&ctx);
        panels::show(self, ui);
        for command in std::mem::take(&mut self.state.asked) {
            self.state.run(command);
            ctx.request_repaint();
        }
        let effects = std::mem::take(&mut self.state.effects);
        for effect in effects {
            self.effect(effect);
            ctx.request_repaint();
        }
        self.want_somata();
        if self.quits {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    /// Draws the picture of this size; what cannot go on is kept in `fatal`.
    pub(crate) fn picture(
        &mut self,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Option<egui::TextureId> {
        match self.stage.update(&mut self.state, size, ctx) {
            Ok(texture) => texture,
            Err(DeviceError::Lost(why)) => {
                self.fatal = Some(self.rescue(&why));
                self.quits = true;
                None
            }
            Err(e) => {
                self.state.problem("drawing", e.to_string());
                None
            }
        }
    }

    /// Saves the session before the program ends by itself.
    fn rescue(&self, why: &str) -> String {
        let lost = format!("the graphics device was lost ({why})");
        if self.state.document.neurons.is_empty() {
            return format!("{lost}: start again, or choose another one by NEUROTESS_ADAPTER");
        }
        let folder = crate::settings::folder().unwrap_or_default();
        let file = folder.join(format!("rescued.{}", session::EXTENSION));
        match Session::of(&self.state, &folder).write(&file) {
            Ok(()) => format!("{lost}: your session is in {}", file.display()),
            Err(e) => format!("{lost}, and the session could not be saved: {e}"),
        }
    }

    fn look(&mut self, ctx: &egui::Context) {
        let zoom = self.state.settings.zoom.clamp(0.5, 3.0);
        let theme = (self.state.settings.dark, (zoom * 100.0) as u32);
        if self.theme != Some(theme) {
            panels::style(ctx, theme.0);
            ctx.set_zoom_factor(zoom);
            self.theme = Some(theme);
        }
    }

    fn take_drops(&mut self, ctx: &egui::Context) {
        let paths: Vec<PathBuf> = ctx.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.map(|file| file.path().to_path_buf()).collect()
        });
        let paths: Vec<PathBuf> = paths
            .into_iter()
            .filter(|p| !p.as_os_str().is_empty())
            .collect();
        if !paths.is_empty() {
            self.state.run(Command::Open(paths));
        }
    }

    /// The camera on its way.
    fn go_on(&mut self, ctx: &egui::Context) {
        let Some((from, to, begun)) = self.going else {
            return;
        };
        let t = begun.elapsed().as_secs_f64() / GO.as_secs_f64();
        if t >= 1.0 {
            (self.state.view, self.going) = (to, None);
        } else {
            self.state.view = from.between(&to, t * t * (3.0 - 2.0 * t));
        }
        ctx.request_repaint();
    }

    /// Moves the camera by hand.
    pub(crate) fn steer(&mut self, view: View) {
        self.going = None;
        self.state.view = view;
    }

    fn effect(&mut self, effect: Effect) {
        match effect {
            Effect::Load(paths) => self.load(paths),
            Effect::Reload => self.reload(),
            Effect::Cancel => {
                for job in self.jobs().into_iter().flatten() {
                    job.cancelled
                        .store(true, std::sync::atomic::Ordering::Relaxed);
                    self.state.said = format!("Stopped {}", job.what);
                }
            }
            Effect::Go(view) => {
                if self.smooth && !self.state.document.neurons.is_empty() {
                    self.going = Some((self.state.view, view, Instant::now()));
                } else {
                    self.state.view = view;
                }
            }
            Effect::Quit => self.quits = true,
            Effect::Save(command) => self.save(command),
        }
    }

    fn load(&mut self, paths: Vec<PathBuf>) {
        if self.loading.is_some() {
            self.state
                .problem("open", "wait until what is being read is there, or stop it");
            return;
        }
        let sessions: Vec<&PathBuf> = paths.iter().filter(|p| session::is_session(p)).collect();
        let session = match &sessions[..] {
            [] => None,
            [one] => match Session::read(one) {
                Ok(session) => Some((one.to_path_buf(), session)),
                Err(why) => {
                    self.state.problem(one.display().to_string(), why);
                    self.state.said = "The session was not opened".into();
                    return;
                }
            },
            _ => {
                self.state
                    .problem("open", "one session at a time: open one of them");
                return;
            }
        };
        let mut loading = Loading {
            first: self.state.document.neurons.is_empty(),
            ..Loading::default()
        };
        let (files, somata) = match session {
            Some((file, session)) => {
                self.take_session(&file, &session);
                let files: Vec<PathBuf> = session.file.iter().map(|f| f.path.clone()).collect();
                let somata = session
                    .file
                    .iter()
                    .filter_map(|f| Some((f.path.clone(), f.soma?)));
                let somata: Vec<(PathBuf, SomaEdit)> = somata.collect();
                loading.session = Some(Box::new(session));
                (files, somata)
            }
            None => (paths, Vec::new()),
        };
        self.loading = Some(loading);
        self.worker.load(files, somata);
    }

    /// All but the cells.
    fn take_session(&mut self, file: &Path, session: &Session) {
        let state = &mut self.state;
        let settings = std::mem::take(&mut state.settings);
        let (adapter, aspect) = (state.adapter.clone(), state.aspect);
        *state = State::new(settings);
        (state.adapter, state.aspect) = (adapter, aspect);
        state.settings.y_down = session.y_down;
        state.document.look = session.look.clone();
        state.document.detail = session.detail;
        state.document.grid = session.grid;
        state.view = session.view;
        state.key_views = session.key_view.clone();
        state.session = Some(file.to_path_buf());
        self.going = None;
    }

    fn reload(&mut self) {
        let stale: Vec<_> = self
            .state
            .sources
            .iter()
            .filter(|(_, s)| s.stale == Some(Stale::Changed))
            .map(|(id, s)| (id, s.file.clone(), s.soma))
            .collect();
        if stale.is_empty() {
            self.state.said = "No file has changed".into();
        }
        for (id, file, soma) in stale {
            self.worker.reload(id, file, soma);
        }
    }

    fn take(&mut self, message: Message) {
        match message {
            Message::Found(found) => {
                for (file, why) in &found.failures {
                    self.state.problem(file.display().to_string(), why);
                }
                if let Some(loading) = &mut self.loading {
                    loading.ids = vec![None; found.files.len()];
                    loading.failed += found.failures.len();
                    loading.found = *found;
                }
            }
            Message::Loaded(index, loaded) => self.loaded(index, *loaded),
            Message::LoadingDone => self.end_loading(),
            Message::Reloaded(id, source) => match *source {
                Ok(source) => {
                    self.state.said = format!("{} was read again", source.name);
                    if let Some(there) = self.state.sources.get_mut(id) {
                        *there = source;
                    }
                    self.watch();
                }
                Err(why) => {
                    let file = self
                        .state
                        .sources
                        .get(id)
                        .map(|s| s.file.display().to_string());
                    let kept = format!("{why}: what was read before still shows");
                    self.state.problem(file.unwrap_or_default(), kept);
                }
            },
            Message::Soma(id, edit, generated) => {
                if let Some(source) = self.state.sources.get_mut(id)
                    && !generated.mesh.patches.is_empty()
                {
                    source.balls = neurotess::render::bounds(&generated.mesh);
                    source.generated = (*generated).into();
                    source.soma = edit;
                } else if let Some(source) = self.state.sources.get_mut(id) {
                    source.soma = edit;
                    let name = source.name.clone();
                    self.state.problem(
                        name,
                        "this soma leaves nothing to draw: choose another method",
                    );
                }
            }
            Message::Files(files) => {
                for (id, stale) in files {
                    if let Some(source) = self.state.sources.get_mut(id) {
                        source.stale = stale;
                    }
                }
            }
            Message::Saved(Ok(said)) => self.state.said = said,
            Message::Saved(Err(why)) => {
                self.state.said = format!("Not saved: {why}");
                self.state.problem("save", why);
            }
        }
    }

    fn loaded(&mut self, index: usize, loaded: Result<Source, (PathBuf, String)>) {
        let source = match loaded {
            Ok(source) => source,
            Err((file, why)) => {
                self.state.problem(file.display().to_string(), why);
                if let Some(loading) = &mut self.loading {
                    loading.failed += 1;
                }
                return;
            }
        };
        let soma = source.soma;
        let name = source.name.clone();
        let id = self.state.sources.add(source);
        self.state.document.set_soma(id, soma);
        let Some(loading) = &mut self.loading else {
            return;
        };
        if let Some(place) = loading.ids.get_mut(index) {
            *place = Some(id);
        }
        // Cells of circuits and sessions come together, in their order, when all files are read.
        let stands = loading.session.is_some()
            || loading
                .found
                .standing
                .iter()
                .any(|standing| standing.file == index);
        if !stands {
            let first = loading.first;
            self.open(Neuron::new(id, name));
            if first && self.state.document.neurons.len() == 1 {
                self.home();
            }
        }
    }

    fn open(&mut self, neuron: Neuron) {
        self.state.history.opened(&neuron);
        self.state.document.neurons.push(neuron);
    }

    fn home(&mut self) {
        let smooth = std::mem::replace(&mut self.smooth, false);
        self.state.run(Command::Home);
        for effect in std::mem::take(&mut self.state.effects) {
            self.effect(effect);
        }
        self.smooth = smooth;
    }

    fn end_loading(&mut self) {
        let Some(loading) = self.loading.take() else {
            return;
        };
        match &loading.session {
            Some(session) => {
                for entry in &session.neuron {
                    let id = loading.ids.get(entry.file).copied().flatten();
                    if let Some(id) = id {
                        self.open(Neuron::of_session(id, entry));
                    }
                }
            }
            None => {
                for standing in &loading.found.standing {
                    let id = loading.ids.get(standing.file).copied().flatten();
                    if let Some((id, source)) =
                        id.and_then(|id| Some((id, self.state.sources.get(id)?)))
                    {
                        let (name, placement) = standing.place(source);
                        self.open(Neuron {
                            placement,
                            ..Neuron::new(id, name)
                        });
                    }
                }
                if loading.first {
                    self.home();
                }
            }
        }
        let read = loading.ids.iter().flatten().count();
        let failed = match loading.failed {
            0 => String::new(),
            n => format!(", {n} failed"),
        };
        let neurons = self.state.document.neurons.len();
        self.state.said = format!("{read} read{failed}; {neurons} in the list");
        self.watch();
    }

    fn watch(&mut self) {
        let files = self.state.sources.iter();
        let files = files.filter(|(_, s)| s.written.is_some());
        self.worker.watch(
            files
                .map(|(id, s)| (id, s.file.clone(), s.written))
                .collect(),
        );
    }

    /// Somata that are not as the document wants them are made again, one at a time, the newest wish.
    fn want_somata(&mut self) {
        if self.worker.makes_soma() {
            return;
        }
        let document = &self.state.document;
        let mut used = document.neurons.iter().map(|n| n.source);
        let wanted = used.find_map(|id| {
            let source = self.state.sources.get(id)?;
            let edit = document.soma(id);
            (source.soma != edit).then(|| (id, source.morphology.clone(), edit))
        });
        if let Some((id, morphology, edit)) = wanted {
            self.worker.soma(id, morphology, edit);
        }
    }

    fn save(&mut self, command: Command) {
        if self.worker.saving.is_some() {
            self.state
                .problem("save", "wait until the last one is written, or stop it");
            return;
        }
        match command {
            Command::SaveSession(path) => self.save_session(&path),
            Command::SaveMeshes(options) => {
                let plans = self.mesh_plans(options.all);
                let (view, detail) = (self.state.view, self.state.document.detail);
                let height = self.stage.height();
                self.worker.save("writing meshes", plans.len(), move |job| {
                    save::meshes(&plans, &options, &view, &detail, height, job)
                });
            }
            Command::SavePicture(options) => {
                self.state.settings.picture_size = options.size;
                let (scenery, view) = (self.scenery(), self.state.view);
                self.worker.save("drawing the picture", 1, move |job| {
                    let files = save::pictures(&scenery, &[view], &options, job)?;
                    let file = files.first().map(|f| f.display().to_string());
                    Ok(format!("Saved {}", file.unwrap_or_default()))
                });
            }
            Command::SaveFilm(film) => {
                let views = save::film_views(&self.state.key_views, film.frames);
                let scenery = self.scenery();
                self.worker
                    .save("drawing the film", views.len(), move |job| {
                        let files = save::pictures(&scenery, &views, &film.picture, job)?;
                        let (count, first) =
                            (files.len(), files.first().cloned().unwrap_or_default());
                        let also = match film.video && count > 1 {
                            true => format!(" and {}", save::video(&first)?.display()),
                            false => String::new(),
                        };
                        Ok(format!(
                            "Saved {count} pictures from {}{also}",
                            first.display()
                        ))
                    });
            }
            _ => {}
        }
    }

    fn save_session(&mut self, path: &Path) {
        let folder = path.parent().unwrap_or(Path::new(""));
        match Session::of(&self.state, folder).write(path) {
            Ok(()) => {
                self.state.said = format!("Saved {}", path.display());
                self.state.session = Some(path.to_path_buf());
                self.state.settings.remember_files(&[path.to_path_buf()]);
            }
            Err(why) => {
                self.state.said = "The session was not saved".into();
                self.state.problem(path.display().to_string(), why);
            }
        }
    }

    fn mesh_plans(&self, all: bool) -> Vec<MeshPlan> {
        let state = &self.state;
        let neurons = state.document.neurons.iter().zip(state.placements());
        let wanted = neurons.filter(|(n, _)| if all { !n.hidden } else { n.selected });
        let plan = |(neuron, placement): (&Neuron, _)| {
            Some(MeshPlan {
                name: neuron.name.clone(),
                generated: state.sources.get(neuron.source)?.generated.clone(),
                placement,
            })
        };
        wanted.filter_map(plan).collect()
    }

    fn scenery(&self) -> Scenery {
        Scenery {
            gpu: self.stage.gpu().clone(),
            shown: self.stage.shown().clone(),
            look: self.state.document.look.clone(),
            states: scene::states(&self.state.document),
            balls: self.state.balls(|_| true),
        }
    }

    /// Writes what is remembered, if it has changed.
    pub fn remember(&mut self) {
        if self.state.settings != self.remembered {
            self.remembered = self.state.settings.clone();
            if let Err(why) = self.remembered.save() {
                self.state.problem("settings", why);
            }
        }
    }

    /// Keys that are commands; not while somebody types.
    pub(crate) fn shortcuts(&mut self, ctx: &egui::Context) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        for (_, items) in crate::command::listed(&self.state.toggles()) {
            for item in items {
                if let Some(keys) = item.keys
                    && ctx.input_mut(|input| input.consume_shortcut(&keys))
                {
                    self.state.asked.push(item.command);
                }
            }
        }
        // Some keyboards send ? as a text only.
        let asks = ctx.input(|input| {
            input
                .events
                .iter()
                .any(|e| matches!(e, egui::Event::Text(t) if t == "?"))
                && !input.key_pressed(Key::Questionmark)
        });
        if asks {
            self.state.asked.push(Command::ToggleKeys);
        }
    }
}
