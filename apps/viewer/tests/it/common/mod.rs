//! The window in tests: without a desktop, driven by commands, looked at by snapshots.
#![allow(missing_docs, reason = "tests")]

pub(crate) mod circuit;

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Modifiers, PointerButton, Pos2, Rect, Vec2};
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state};
use egui_kittest::{Harness, SnapshotOptions, image_snapshot_options};
use egui_wgpu::RendererOptions;
use neurotess::render::adapter::adapters;
use neurotess::synth::Kind;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::Look;
use neurotess_viewer::settings::Settings;
use neurotess_viewer::state::State;
use neurotess_viewer::{Command, Viewer, wait_for_background, wgpu_setup};

pub(crate) const SIZE: Vec2 = Vec2::new(1180.0, 740.0);

pub(crate) type Window = Harness<'static, Option<Viewer>>;

/// Waits for the threads of windows that tests have closed: ending the program under them crashes some drivers.
pub(crate) fn wait_for_threads() {
    assert!(
        wait_for_background(Duration::from_secs(60)),
        "threads of closed windows end"
    );
}

/// The need of tests that open a window.
pub(crate) fn gpu() -> Result<(), String> {
    let missing = || "no graphics adapter was found".to_owned();
    adapters().first().map(drop).ok_or_else(missing)
}

/// A window in which pictures are small, for tests that are not about them: a fifth of the pixels is drawn in a fifth
/// of the time.
pub(crate) const SMALL: Vec2 = Vec2::new(640.0, 420.0);

/// The window, on a software adapter where there is one, so that snapshots are drawn as they were.
pub(crate) fn window() -> Window {
    window_of(SIZE)
}

/// A window of this size.
pub(crate) fn window_of(size: Vec2) -> Window {
    let found = adapters();
    let adapter = found.iter().find(|a| a.software).or(found.first());
    let adapter = adapter.expect("the test has needs(gpu)");
    let setup = wgpu_setup(Some(adapter.name.clone()), Arc::default());
    let render = create_render_state(setup, RendererOptions::PREDICTABLE);
    let ours = render.clone();
    let settings = Settings {
        folder: PathBuf::from("/"),
        ..Settings::default()
    };
    Harness::builder()
        .with_size(size)
        .renderer(WgpuTestRenderer::from_render_state(render))
        .build_ui_state(
            move |ui, viewer: &mut Option<Viewer>| {
                let viewer = viewer.get_or_insert_with(|| {
                    let made = Viewer::new(ui.ctx(), ours.clone(), settings.clone());
                    made.expect("a viewer").without_motion()
                });
                viewer.ui(ui);
            },
            None,
        )
}

pub(crate) fn viewer(window: &mut Window) -> &mut Viewer {
    window.state_mut().as_mut().expect("begun")
}

pub(crate) fn state(window: &mut Window) -> &mut State {
    &mut viewer(window).state
}

/// Frames until nothing is under way.
pub(crate) fn settle(window: &mut Window) {
    let begun = Instant::now();
    let mut quiet = 0;
    while quiet < 3 {
        // Usually a second or two.
        assert!(
            begun.elapsed() < Duration::from_secs(120),
            "never settles: {}; {:?}",
            viewer(window).stage.unsettled(),
            viewer(window).state.messages.problems
        );
        window.step();
        quiet = if viewer(window).is_settled() {
            quiet + 1
        } else {
            0
        };
        std::thread::sleep(Duration::from_millis(3));
    }
}

pub(crate) fn run(window: &mut Window, command: impl Into<Command>) {
    state(window).run(command);
    settle(window);
}

pub(crate) fn set_look(window: &mut Window, change: impl FnOnce(&mut Look)) {
    let mut look = state(window).document.look.clone();
    change(&mut look);
    run(window, Edit::SetLook(Box::new(look)));
}

pub(crate) fn wait(window: &mut Window, until: impl Fn(&mut Window) -> bool) {
    // Long enough for a machine that does other things, too.
    let begun = Instant::now();
    while !until(window) {
        let playback = state(window).playback.clone();
        assert!(
            begun.elapsed() < Duration::from_secs(180),
            "never: {playback:?}"
        );
        window.step();
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Frames until the picture can be colored anew.
pub(crate) fn rest(window: &mut Window) {
    settle(window);
    wait(window, |w| viewer(w).stage.is_static());
    settle(window);
}

/// Number of pixels of two pictures that differ by more than 1 of 255.
pub(crate) fn differing(a: &[u8], b: &[u8]) -> usize {
    let far = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 1);
    a.chunks(4).zip(b.chunks(4)).filter(far).count()
}

pub(crate) fn with_samples(kinds: &[Kind]) -> Window {
    samples_in(window(), kinds)
}

/// Opens samples in a small window, for tests that do not wait for the picture.
pub(crate) fn undrawn(kinds: &[Kind]) -> Window {
    let mut window = window_of(SMALL);
    window.step();
    for (&kind, number) in kinds.iter().zip(1..) {
        state(&mut window).run(Command::OpenSample(kind));
        wait(&mut window, |w| state(w).document.neurons.len() == number);
    }
    window.run_steps(2);
    window
}

/// Runs a command without waiting for the picture.
pub(crate) fn run_undrawn(window: &mut Window, command: impl Into<Command>) {
    state(window).run(command);
    window.run_steps(3);
}

/// Opens samples in a window.
pub(crate) fn samples_in(mut window: Window, kinds: &[Kind]) -> Window {
    window.step();
    for &kind in kinds {
        run(&mut window, Command::OpenSample(kind));
    }
    window
}

/// Pixels that may differ from the picture that is kept: single ones.
const FEW_PIXELS: usize = 12;

/// A picture of the window beside the one that is kept; what changes by itself is masked.
pub(crate) fn snapshot(window: &mut Window, name: &str) {
    // A cursor that blinks is there or not.
    window
        .ctx
        .all_styles_mut(|style| style.visuals.text_cursor.blink = false);
    window.step();
    let masks = changing(window);
    let mut image = window.render().expect("a picture");
    for mask in masks {
        let [left, top] = [mask.left(), mask.top()].map(|n| n.max(0.0) as u32);
        for y in top..(mask.bottom() as u32).min(image.height()) {
            for x in left..(mask.right() as u32).min(image.width()) {
                image.get_pixel_mut(x, y).0 = [128, 128, 128, 255];
            }
        }
    }
    let options = SnapshotOptions::new()
        .threshold(0.8)
        .max_failed_pixels(FEW_PIXELS);
    image_snapshot_options(&image, name, &options);
}

/// Where the window shows what depends on the machine's pace: the soma's time, below their heading the times of
/// drawing, and the memory of neurons and images, among which are drafts only if there was time to draw them.
fn changing(window: &Window) -> Vec<Rect> {
    let mut masks = Vec::new();
    let heading = window.query_all_by_label("Drawing times").next();
    if let Some(heading) = heading {
        let rect = heading.rect();
        // The line at the bottom of the window is none of them.
        masks.push(Rect::from_min_max(
            rect.left_bottom(),
            Pos2::new(SIZE.x, SIZE.y - 36.0),
        ));
    }
    for name in ["computed in", "GPU memory, neurons", "GPU memory, images"] {
        let rows = window.query_all_by_label(name).map(|label| label.rect());
        masks.extend(rows.map(|row| {
            let end = Pos2::new(SIZE.x, row.bottom());
            Rect::from_min_max(row.right_top(), end)
        }));
    }
    masks
}

/// Where the picture is.
pub(crate) fn picture(window: &Window) -> Rect {
    window.get_by_role(Role::Canvas).rect()
}

/// Where the picture shows a position of the world.
pub(crate) fn hit_at(window: &mut Window, position: glam::DVec3) -> Pos2 {
    let rect = picture(window);
    let size = [rect.width(), rect.height()].map(|n| n as u32);
    let pixel = state(window).view.camera().pixel_of(position, size);
    let [x, y] = pixel.expect("in front");
    rect.min + Vec2::new(x as f32, y as f32)
}

pub(crate) fn click(window: &mut Window, at: Pos2, modifiers: Modifiers) {
    window.event(Event::PointerMoved(at));
    window.step();
    for pressed in [true, false] {
        window.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers,
        });
        window.step();
    }
    // No double click with the next one.
    window.run_steps(30);
    settle(window);
}

/// The picture alone, without panels.
pub(crate) fn drawn(window: &mut Window) -> Vec<u8> {
    let rect = picture(window);
    let image = window.render().expect("a picture");
    let [left, right] = [rect.left(), rect.right()].map(|x| x as u32);
    let rows = (rect.top() as u32)..(rect.bottom() as u32);
    let pixels = rows.flat_map(|y| (left..right).map(move |x| (x, y)));
    pixels.flat_map(|(x, y)| image.get_pixel(x, y).0).collect()
}

/// The pixels of a saved picture, whose file also tells how it was drawn.
pub(crate) fn pixels(file: &Path) -> Vec<u8> {
    let file = BufReader::new(File::open(file).expect("a file"));
    let mut reader = png::Decoder::new(file).read_info().expect("PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("pixels");
    pixels
}
