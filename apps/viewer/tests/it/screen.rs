//! The window fits the screen.

use eframe::egui::{Vec2, ViewportCommand, ViewportId};

use crate::common::{SIZE, Window, gpu, window};

/// The size that a frame asks the desktop for.
fn resized(window: &Window) -> Option<Vec2> {
    let viewports = window.output().viewport_output.values();
    let mut commands = viewports.flat_map(|v| &v.commands);
    commands.find_map(|command| match command {
        ViewportCommand::InnerSize(size) => Some(*size),
        _ => None,
    })
}

#[neurotess_testing::test(needs(gpu))]
fn a_window_larger_than_the_screen_becomes_smaller_once() {
    let mut window = window();
    let viewports = &mut window.input_mut().viewports;
    let root = viewports.entry(ViewportId::ROOT).or_default();
    // As many laptops are.
    root.monitor_size = Some(Vec2::new(SIZE.x, 768.0));
    window.step();
    assert_eq!(resized(&window), Some(Vec2::new(SIZE.x - 16.0, 668.0)));
    // Somebody who makes it larger wants it so.
    window.step();
    assert_eq!(resized(&window), None);
}
