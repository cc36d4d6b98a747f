//! The window: state, workers and stage together.

mod autosave;
mod crossings;
mod likeness;
mod loading;
mod messages;
mod palettes;
mod plots;
mod saving;
mod screen;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use eframe::egui;
use egui_wgpu::RenderState;
use neurotess::options::groups::CameraOptions;
use neurotess::render::DeviceError;

use crate::io::single::Single;
use crate::io::worker::Worker;
use crate::model::command::{Command, listed};
use crate::model::crossings::{Crossing, CrossingKey};
use crate::model::document::SomaEdit;
use crate::model::revision::Revision;
use crate::model::save::SaveRequest;
use crate::model::settings::Settings;
use crate::model::state::{Dialog, Effect, State};
use crate::scene::stage::Stage;
use crate::ui::file_panel::FilePanel;
use crate::ui::input::{Input, MAX_PASSES};
use crate::ui::motion::Motion;
use crate::ui::panels::{self, Screen};
use autosave::Autosave;
pub(crate) use autosave::EVERY;
use loading::Loading;
use plots::PlotWork;

/// Usual duration (s) of animations of controls, egui's own.
const ANIMATION: f32 = 0.2;

/// The whole program, without the desktop's window.
pub struct Viewer {
    /// The state.
    pub state: State,
    /// The stage, which draws the picture.
    pub stage: Stage,
    /// That of the right one of two views.
    second: Option<Stage>,
    worker: Worker,
    plots: PlotWork,
    crossing_search: Single<CrossingKey, Vec<Crossing>>,
    /// A loading: what was found, and its cells by file.
    loading: Option<Loading>,
    /// Paths to be opened after it.
    waiting: Vec<PathBuf>,
    motion: Motion,
    files: Option<FilePanel>,
    /// The error that ends the program: the device is lost.
    pub fatal: Option<String>,
    quits: bool,
    /// A picture or film that waits until the stage has the meshes and colors of the document.
    unprepared: Option<SaveRequest>,
    /// A text for the clipboard.
    copied: Option<String>,
    /// Whether the window is to fill the screen, or to leave it.
    full_screen: Option<bool>,
    theme: Option<(bool, u32)>,
    /// Whether frames are too slow for animations, once that is known.
    slow: Option<bool>,
    /// Whether the window has been made to fit the screen.
    fits_screen: bool,
    remembered: Settings,
    /// How the somata of files that are opened first are generated.
    soma: SomaEdit,
    /// Where the cells that are opened first are seen from, if not from the front.
    looked: Option<CameraOptions>,
    /// Whether circuits have no caches, whatever the settings say.
    without_caches: bool,
    /// When the recording's time was last advanced.
    ticked: Instant,
    /// What is not saved, kept in a file.
    autosave: Option<Autosave>,
    /// Folder that the session is saved in when the program must end.
    rescue: PathBuf,
    /// Revisions of neurons, edits of somata and meshes at which all meshes fitted their edits.
    somata_checked: Option<([Revision; 3], bool)>,
    listener: Option<CommandListener>,
}

/// Called with every command before it runs.
pub type CommandListener = Box<dyn Fn(&Command)>;

impl Viewer {
    /// A viewer in a window that has a device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn new(
        ctx: &egui::Context,
        render: RenderState,
        settings: Settings,
    ) -> Result<Self, DeviceError> {
        let waker = ctx.clone();
        ctx.add_plugin(Input::new());
        ctx.options_mut(|options| options.max_passes = MAX_PASSES);
        let stage = Stage::new(render)?;
        let mut state = State::new(settings.clone());
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(move || waker.request_repaint());
        let adapter = &stage.gpu().adapter;
        state.drawing.adapter = (adapter.to_string(), adapter.software);
        Ok(Self {
            state,
            stage,
            second: None,
            plots: PlotWork::new(&wake),
            crossing_search: Single::new(&wake),
            worker: Worker::new(move || wake()),
            loading: None,
            waiting: Vec::new(),
            motion: Motion::new(),
            files: None,
            fatal: None,
            quits: false,
            unprepared: None,
            copied: None,
            full_screen: None,
            theme: None,
            slow: None,
            fits_screen: false,
            remembered: settings,
            soma: SomaEdit::default(),
            looked: None,
            without_caches: false,
            ticked: Instant::now(),
            autosave: None,
            rescue: crate::model::settings::folder().unwrap_or_default(),
            somata_checked: None,
            listener: None,
        })
    }

    /// Sets the folder that the session is saved in when the program must end, instead of the
    /// settings' folder.
    pub fn with_rescue(mut self, folder: PathBuf) -> Self {
        self.rescue = folder;
        self
    }

    /// Neither reads nor writes caches of circuits, whatever the settings say.
    pub fn without_caches(mut self) -> Self {
        self.without_caches = true;
        self
    }

    /// Sets the function that is called with every command before it runs.
    pub fn with_listener(mut self, listener: CommandListener) -> Self {
        self.listener = Some(listener);
        self
    }

    /// Makes views change at once: for tests.
    pub fn without_motion(mut self) -> Self {
        self.motion.set_smooth(false);
        self
    }

    /// Whether no task is running and everything is drawn.
    pub fn is_settled(&self) -> bool {
        let mut stages = [Some(&self.stage), self.second.as_ref()]
            .into_iter()
            .flatten();
        let empty = self.state.document.neurons.is_empty();
        let opened = self.state.views.split.is_some() == self.second.is_some();
        let drawn = empty || opened && stages.all(Stage::is_settled);
        let reads = self.worker.is_busy() || self.plots.is_busy() || self.unprepared.is_some();
        let busy = reads || self.crossing_search.is_busy();
        !busy && !self.motion.is_flying() && self.loading.is_none() && drawn
    }

    /// One frame.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        self.look(&ctx);
        self.fit_screen(&ctx);
        for message in self.worker.messages() {
            self.take(message);
        }
        self.state.writing = self.worker.is_saving() || self.unprepared.is_some();
        self.ask_to_close(&ctx);
        self.take_drops(&ctx);
        self.shortcuts(&ctx);
        if self.motion.advance(&mut self.state) {
            ctx.request_repaint();
        }
        self.tick();
        self.turn(&ctx);
        self.split();
        let waits = ctx.with_plugin(|input: &mut Input| input.waits());
        self.show_panels(waits == Some(true), ui);
        for command in std::mem::take(&mut self.state.requests) {
            self.run(command);
            ctx.request_repaint();
        }
        self.save_prepared();
        self.do_effects(&ctx);
        self.request_somata();
        self.request_markers();
        self.request_meshes();
        self.update_plots();
        self.update_crossings();
        self.note_settings();
        self.autosave(&ctx);
        self.end_input(&ctx);
        if self.quits {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    /// Runs *Quit* when the desktop asks the window to close, which may ask the user.
    fn ask_to_close(&mut self, ctx: &egui::Context) {
        let closes = ctx.input(|input| input.viewport().close_requested());
        if !closes || self.quits {
            return;
        }
        self.run(Command::Quit);
        if matches!(self.state.layout.dialog, Dialog::Unsaved(_)) {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            ctx.request_repaint();
        }
    }

    /// Opens a stage for the second view, or closes it.
    fn split(&mut self) {
        match (self.state.views.split, self.second.take()) {
            (Some(_), Some(stage)) => self.second = Some(stage),
            (Some(_), None) => match self.stage.another() {
                Ok(stage) => self.second = Some(stage),
                Err(e) => {
                    self.state.views.split = None;
                    self.state.problem("two views", e.to_string());
                }
            },
            (None, Some(stage)) => stage.free(),
            (None, None) => {}
        }
    }

    /// Shows all panels; keeps an error that ends the program in `fatal`. `passed_over`: whether another pass of this
    /// frame follows.
    fn show_panels(&mut self, passed_over: bool, ui: &mut egui::Ui) {
        let [reading, saving, marking] = self.worker.progress();
        let searching = self.crossing_search.progress();
        let mut screen = Screen {
            state: &mut self.state,
            stage: &mut self.stage,
            second: self.second.as_mut(),
            motion: &mut self.motion,
            files: &mut self.files,
            tasks: [reading, saving, marking, self.plots.progress(), searching],
            passed_over,
            failed: None,
        };
        panels::show(&mut screen, ui);
        match screen.failed {
            None => {}
            Some(DeviceError::Lost(why)) => {
                self.fatal = Some(self.rescue(&lost(&why)));
                self.quits = true;
            }
            Some(e) => self.state.problem("drawing", e.to_string()),
        }
    }

    fn look(&mut self, ctx: &egui::Context) {
        let zoom = self.state.settings.zoom.clamp(0.5, 3.0);
        let theme = (self.state.settings.dark, (zoom * 100.0) as u32);
        if self.theme != Some(theme) {
            panels::style(ctx, theme.0);
            ctx.set_zoom_factor(zoom);
            self.theme = Some(theme);
            self.slow = None;
        }
        // Below 20 frames a second, a menu that fades in would take seconds.
        let frame = ctx.input(|input| input.stable_dt);
        let slow = frame > if self.slow == Some(true) { 0.04 } else { 0.05 };
        if self.slow != Some(slow) {
            let time = if slow { 0.0 } else { ANIMATION };
            ctx.all_styles_mut(|style| style.animation_time = time);
            self.slow = Some(slow);
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
            self.run(Command::Open(paths));
        }
    }

    /// Advances the recording by the clock.
    fn tick(&mut self) {
        let seconds = self.ticked.elapsed().as_secs_f64();
        self.ticked = Instant::now();
        self.state.playback.advance(seconds);
    }

    /// Turns the scene on the turntable, unless it is held by the mouse.
    fn turn(&mut self, ctx: &egui::Context) {
        let (held, time) = ctx.input(|i| (i.pointer.any_down(), i.stable_dt));
        let turns = self.state.views.turning && !self.state.document.neurons.is_empty();
        if turns && !held && !self.motion.is_flying() {
            self.motion.turn(&mut self.state, f64::from(time));
            ctx.request_repaint();
        }
    }

    fn effect(&mut self, effect: Effect) {
        match effect {
            Effect::Load(paths) => self.load(paths),
            Effect::Reload => self.reload(),
            Effect::Cancel => {
                self.waiting.clear();
                if self.unprepared.take().is_some() {
                    self.state.messages.status = "Stopped before drawing the picture".into();
                }
                let all = self
                    .worker
                    .progress()
                    .into_iter()
                    .chain([self.plots.progress(), self.crossing_search.progress()]);
                for progress in all.flatten() {
                    progress.cancel();
                    self.state.messages.status = format!("Stopped {}", progress.what);
                }
                self.stop_markers();
            }
            Effect::Go(view) => self.motion.fly(&mut self.state, view),
            Effect::Project(orthographic) => {
                self.motion.project(&mut self.state, orthographic);
            }
            Effect::Quit => self.quits = true,
            Effect::Recover(open) => self.recover(open),
            Effect::Copy(text) => self.copied = Some(text),
            Effect::FullScreen(on) => self.full_screen = Some(on),
            Effect::Save(request) => self.save(request),
            Effect::OpenPalette(path) => self.open_palette(&path),
            Effect::SavePalette(path) => self.save_palette(&path),
        }
    }

    /// Carries out the effects of commands.
    fn do_effects(&mut self, ctx: &egui::Context) {
        for effect in std::mem::take(&mut self.state.effects) {
            self.effect(effect);
            ctx.request_repaint();
        }
        if let Some(text) = self.copied.take() {
            ctx.copy_text(text);
        }
        if let Some(on) = self.full_screen.take() {
            ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(on));
        }
    }

    /// Runs the shortcuts of this frame, in their order. A shortcut's effect may change what the
    /// next one does.
    fn shortcuts(&mut self, ctx: &egui::Context) {
        let pressed = ctx.with_plugin(Input::take_pressed).unwrap_or_default();
        for keys in pressed {
            let menus = listed(&self.state.toggles());
            let mut items = menus.into_iter().flat_map(|(_, items)| items);
            if let Some(item) = items.find(|item| item.keys == Some(keys)) {
                self.run(item.command);
                ctx.request_repaint();
            }
        }
    }

    /// Passes on to the input which dialog is open, for the next frame.
    fn end_input(&self, ctx: &egui::Context) {
        let open = (&self.state.layout.dialog).into();
        let waits = ctx.with_plugin(|input: &mut Input| {
            input.set_open(open);
            input.waits()
        });
        if waits == Some(true) {
            ctx.request_repaint();
        }
    }

    /// Calls the listener with a command and runs it.
    fn run(&mut self, command: Command) {
        if let Some(listener) = &self.listener {
            listener(&command);
        }
        self.state.run(command);
    }
}

/// The message for a lost device.
pub(crate) fn lost(why: &str) -> String {
    format!("the graphics device was lost ({why})")
}
