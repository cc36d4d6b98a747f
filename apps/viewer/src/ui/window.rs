//! The desktop's window around the viewer.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook, take_hook};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use eframe::egui::{self, ViewportBuilder};
use egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use neurotess::options::Picture;
use neurotess::render::adapter::{device_descriptor, select_adapter};
use neurotess::render::{DeviceError, Gpu};
use thiserror::Error;

use crate::io::background::wait_for_background;
use crate::model::command::Command;
use crate::model::settings::{self, Settings};
use crate::ui::app::{CommandListener, EVERY, Viewer, lost};

/// What the window starts with.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Files, folders, circuits or a session to open.
    pub inputs: Vec<PathBuf>,
    /// How they are shown.
    pub picture: Picture,
    /// Names of the options that the picture is asked for; all others are as the window has them.
    pub given: Vec<String>,
    /// Whether caches of circuits are neither read nor written, whatever the settings say.
    pub without_caches: bool,
    /// Adapter to draw with: a part of its name.
    pub adapter: Option<String>,
    /// Most memory (bytes) of the adapter for the tracings of large scenes.
    pub gpu_memory: Option<u64>,
}

/// Why there is no window, or no more: `what: what to do`.
#[derive(Debug, Error)]
pub enum ViewError {
    /// No desktop.
    #[error(
        "no display ({0}): start it on a desktop (ssh -X, VNC, Xvfb), or draw without a window by \
         neurotess render"
    )]
    NoDisplay(String),
    /// There is no adapter, or its driver reports an error.
    #[error("{0}")]
    NoAdapter(String),
    /// The device was lost.
    #[error("{0}")]
    Lost(String),
}

/// Opens the window and returns when it is closed. `listener` is called with every command before
/// it runs.
///
/// # Errors
/// The window cannot be opened, or had to be closed.
pub fn run(options: Options, listener: Option<CommandListener>) -> Result<(), ViewError> {
    if !has_display() {
        let why = "neither DISPLAY nor WAYLAND_DISPLAY is set";
        return Err(ViewError::NoDisplay(why.into()));
    }
    let fatal: Arc<Mutex<Option<String>>> = Arc::default();
    let refused: Arc<Mutex<Option<String>>> = Arc::default();
    let native = eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("neurotess")
            .with_app_id("neurotess")
            .with_inner_size([1280.0, 820.0])
            .with_min_inner_size([480.0, 320.0])
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: wgpu_setup(options.adapter.clone(), Arc::clone(&refused)),
            ..WgpuConfiguration::default()
        },
        ..eframe::NativeOptions::default()
    };
    let out = Arc::clone(&fatal);
    quiet_once_fatal(&fatal);
    // eframe panics if the device is lost while it draws the panels.
    let ended = catch_unwind(AssertUnwindSafe(|| {
        eframe::run_native(
            "neurotess",
            native,
            Box::new(move |context| Ok(Box::new(Window::new(context, options, listener, out)?))),
        )
    }));
    drop(take_hook());
    wait_for_background(PATIENCE);
    if let Some(why) = taken(&fatal) {
        return Err(ViewError::Lost(why));
    }
    let ended = ended.unwrap_or_else(|panic| resume_unwind(panic));
    ended.map_err(|e| match (taken(&refused), e) {
        (Some(why), _) => ViewError::NoAdapter(why),
        (None, eframe::Error::Winit(e)) => ViewError::NoDisplay(e.to_string()),
        (None, eframe::Error::WinitEventLoop(e)) => ViewError::NoDisplay(e.to_string()),
        (None, e) => ViewError::NoAdapter(format!(
            "the window cannot be drawn ({e}): choose another adapter with --adapter"
        )),
    })
}

fn taken(slot: &Mutex<Option<String>>) -> Option<String> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// Silences panics once the error that ends the program is known.
fn quiet_once_fatal(fatal: &Arc<Mutex<Option<String>>>) {
    let (fatal, usual) = (Arc::clone(fatal), take_hook());
    set_hook(Box::new(move |panic| {
        let known = fatal.lock().unwrap_or_else(PoisonError::into_inner);
        if known.is_none() {
            drop(known);
            usual(panic);
        }
    }));
}

fn has_display() -> bool {
    let desktop = cfg!(any(target_os = "windows", target_os = "macos"));
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    desktop || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Sets eframe up to open the device that the renderer needs. If no adapter fits, the reason is
/// stored in `refused`.
pub fn wgpu_setup(wanted: Option<String>, refused: Arc<Mutex<Option<String>>>) -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.flags = wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL;
    setup.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        let fits = |a: &&wgpu::Adapter| surface.is_none_or(|s| a.is_surface_supported(s));
        let fitting: Vec<wgpu::Adapter> = adapters.iter().filter(fits).cloned().collect();
        select_adapter(&fitting, wanted.as_deref()).map_err(|e| {
            let why = e.to_string();
            *refused.lock().unwrap_or_else(PoisonError::into_inner) = Some(why.clone());
            why
        })
    }));
    setup.device_descriptor = Arc::new(device_descriptor);
    WgpuSetup::CreateNew(setup)
}

/// Environment variable for tests: once the file that it names exists, the device is lost.
const LOSE: &str = "NEUROTESS_TEST_LOSE_DEVICE";

/// How many times a device that is at work is checked for being lost, every 10 ms.
const LOST_POLLS: usize = 1000;

/// How long threads are waited for at the end; they were asked to stop.
const PATIENCE: Duration = Duration::from_secs(5);

struct Window {
    viewer: Viewer,
    fatal: Arc<Mutex<Option<String>>>,
    lose: Option<PathBuf>,
}

impl Window {
    fn new(
        context: &eframe::CreationContext<'_>,
        options: Options,
        listener: Option<CommandListener>,
        fatal: Arc<Mutex<Option<String>>>,
    ) -> Result<Self, Box<dyn std::error::Error + Send + Sync>> {
        let render = context
            .wgpu_render_state
            .clone()
            .ok_or("the window has no device")?;
        let (settings, said) = Settings::load();
        let mut viewer = Viewer::new(&context.egui_ctx, render, settings)?;
        if let Some(folder) = settings::folder() {
            viewer = viewer.with_autosave(&folder, EVERY);
        }
        viewer.stage.limit_memory(options.gpu_memory);
        if options.without_caches {
            viewer = viewer.without_caches();
        }
        if let Some(listener) = listener {
            viewer = viewer.with_listener(listener);
        }
        if let Some(said) = said {
            viewer.state.problem("settings", said);
        }
        if !options.inputs.is_empty() {
            viewer.state.run(Command::Open(options.inputs));
        }
        viewer.show_as(&options.picture, &options.given);
        Ok(Self {
            viewer,
            fatal,
            lose: std::env::var_os(LOSE).map(PathBuf::from),
        })
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if self.lose.as_ref().is_some_and(|file| file.exists()) {
            self.viewer.stage.gpu().device.destroy();
            self.lose = None;
        }
        self.viewer.ui(ui);
        if let Some(why) = self.viewer.fatal.take() {
            *self.fatal.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
        }
    }

    fn on_exit(&mut self) {
        self.viewer.leave();
        self.viewer.remember();
    }
}

impl Drop for Window {
    /// If eframe panics because panels cannot be drawn any more, the session is saved.
    fn drop(&mut self) {
        let mut fatal = self.fatal.lock().unwrap_or_else(PoisonError::into_inner);
        if !std::thread::panicking() || fatal.is_some() {
            return;
        }
        let why = why_lost(self.viewer.stage.gpu());
        let bug = || "a bug in neurotess ended it, please report what stands above".into();
        let why = why.unwrap_or_else(bug);
        *fatal = Some(self.viewer.rescue(&why));
    }
}

/// Why a device is lost; none if it is not. It says so once its running work has ended.
fn why_lost(gpu: &Gpu) -> Option<String> {
    for _ in 0..LOST_POLLS {
        let polled = gpu.device.poll(wgpu::PollType::Poll);
        // Other errors of a lost device do not explain anything.
        if let Err(DeviceError::Lost(why)) = gpu.check() {
            return Some(lost(&why));
        }
        if polled.is_ok_and(|status| status.is_queue_empty()) {
            return None;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    None
}
