//! Menus in windows that are lower than they are.

use eframe::egui::{Event, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, Vec2};
use egui_kittest::kittest::Queryable;

use crate::common::{gpu, snapshot, window};

#[neurotess_testing::test(needs(gpu))]
fn a_menu_scrolls_where_the_window_is_low() {
    let mut window = window();
    let size = Vec2::new(800.0, 560.0);
    window.set_size(size);
    window.run_steps(2);
    window.get_by_label("View").click();
    window.run_steps(6);
    let last = "Save this view under a name (5 to 9 go to the first)";
    let first = window.get_by_label_contains("Home: everything").rect();
    assert!(first.bottom() < size.y);
    window.event(Event::PointerMoved(first.center()));
    for _ in 0..30 {
        window.event(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: Vec2::new(0.0, -200.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    window.run_steps(20);
    let shown = window.get_by_label_contains(last).rect();
    assert!(shown.bottom() < size.y, "{shown:?}");
    snapshot(&mut window, "menu_scrolled");
    window.get_by_label_contains(last).click();
    window.run_steps(3);
    let views = &window
        .state()
        .as_ref()
        .expect("begun")
        .state
        .document
        .saved_views;
    assert_eq!(views.len(), 1);
}
