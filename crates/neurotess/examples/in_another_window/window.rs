//! The program's window, whose camera goes around the cells.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use neurotess::render::wgpu;
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

use crate::cells::Cells;
use crate::host::{Host, open};

/// Opens the window, until it is closed.
pub(crate) fn show(cell: PathBuf) -> Result<(), Box<dyn Error>> {
    let mut program = Program {
        cell,
        shown: None,
        failed: None,
    };
    EventLoop::new()?.run_app(&mut program)?;
    program.failed.map_or(Ok(()), Err)
}

struct Program {
    cell: PathBuf,
    shown: Option<Shown>,
    failed: Option<Box<dyn Error>>,
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Shown::new(events, &self.cell) {
            Ok(shown) => self.shown = Some(shown),
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else {
            return;
        };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(_) => shown.configure(),
            WindowEvent::RedrawRequested => {
                if let Err(error) = shown.draw() {
                    self.fail(events, error);
                }
            }
            _ => {}
        }
    }
}

impl Program {
    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn Error>) {
        self.failed = Some(error);
        events.exit();
    }
}

/// The window, and what is drawn in it.
struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    host: Host,
    cells: Cells,
    began: Instant,
}

impl Shown {
    fn new(events: &ActiveEventLoop, cell: &std::path::Path) -> Result<Self, Box<dyn Error>> {
        let title = Window::default_attributes().with_title("A window that is not neurotess's");
        let window = Arc::new(events.create_window(title)?);
        let display = Box::new(events.owned_display_handle());
        let instance =
            wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(display));
        let surface = instance.create_surface(Arc::clone(&window))?;
        let (adapter, gpu) = open(&instance, Some(&surface))?;
        let size = window.inner_size();
        let config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or("the adapter cannot draw into this window")?;
        let (device, queue) = (gpu.device.clone(), gpu.queue.clone());
        let host = Host::new(&gpu, config.format);
        let cells = Cells::new(gpu, cell, host.pass())?;
        surface.configure(&device, &config);
        Ok(Self {
            window,
            surface,
            config,
            device,
            queue,
            host,
            cells,
            began: Instant::now(),
        })
    }

    /// Fits the surface to the window.
    fn configure(&mut self) {
        let size = self.window.inner_size();
        (self.config.width, self.config.height) = (size.width.max(1), size.height.max(1));
        self.surface.configure(&self.device, &self.config);
        self.window.request_redraw();
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        use wgpu::CurrentSurfaceTexture::{Lost, Outdated, Suboptimal, Success};
        self.window.request_redraw();
        let frame = match self.surface.get_current_texture() {
            Success(frame) | Suboptimal(frame) => frame,
            Outdated => {
                self.configure();
                return Ok(());
            }
            Lost => return Err("the window's surface was lost".into()),
            _ => return Ok(()),
        };
        let angle = 0.35 + 0.3 * self.began.elapsed().as_secs_f64();
        self.host.draw(&frame.texture, &mut self.cells, angle)?;
        self.window.pre_present_notify();
        self.queue.present(frame);
        Ok(())
    }
}
