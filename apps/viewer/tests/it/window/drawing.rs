//! When the window draws, how much, and from where.

use std::time::{Duration, Instant};

use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::kittest::Queryable;
use neurotess::render::Side;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::{RestChoice, SourceId};
use neurotess_viewer::state::{CellPart, Lowered};
use neurotess_viewer::view::View;

use crate::common::{
    SIZE, Window, click, differing, drawn, gpu, hit_at, picture, rest, run, settle, state, viewer,
    with_samples,
};

/// After some frames it asks for no more.
fn assert_idle(window: &mut Window) {
    window.run_steps(40);
    let output = window
        .output()
        .viewport_output
        .values()
        .next()
        .expect("a window");
    assert!(
        output.repaint_delay > Duration::from_secs(1),
        "{:?}",
        output.repaint_delay
    );
}

#[neurotess_testing::test(needs(gpu))]
fn nothing_is_drawn_when_nothing_changes() {
    let mut window = with_samples(&[Kind::Star]);
    rest(&mut window);
    assert_idle(&mut window);
    run(&mut window, Command::Look(Side::Top));
    rest(&mut window);
    assert_idle(&mut window);
}

#[neurotess_testing::test(needs(gpu))]
fn a_lost_device_costs_no_work() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let slot = window.state_mut();
    *slot = slot
        .take()
        .map(|viewer| viewer.with_rescue(folder.path().to_path_buf()));
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Edit::SetRing(SourceId(0), 1, Some(1.5)));
    let before = neurotess_viewer::session::Session::of(state(&mut window), folder.path());
    viewer(&mut window).stage.gpu().device.destroy();
    // Something must be drawn to notice it.
    let turned = state(&mut window).view.orbited(0.1, 0.0, glam::DVec3::Y);
    state(&mut window).view = turned;
    let clock = Instant::now();
    while viewer(&mut window).fatal.is_none() {
        assert!(clock.elapsed() < Duration::from_secs(120), "not noticed");
        window.step();
        std::thread::sleep(Duration::from_millis(3));
    }
    let said = viewer(&mut window).fatal.clone().expect("an error");
    let file = folder.path().join("rescued.neurotess");
    assert!(said.contains("lost") && said.contains(&file.display().to_string()));
    let rescued = neurotess_viewer::session::Session::read(&file).expect("rescued");
    assert_eq!(
        (&rescued.file, &rescued.neuron),
        (&before.file, &before.neuron)
    );
    assert_eq!(rescued.view, turned);
}

#[neurotess_testing::test(needs(gpu))]
fn a_window_of_no_size_loses_nothing() {
    let mut window = with_samples(&[Kind::Star]);
    for size in [
        Vec2::new(1.0, 1.0),
        Vec2::new(300.0, 20.0),
        Vec2::new(640.0, 480.0),
    ] {
        window.set_size(size);
        window.run_steps(6);
    }
    window.set_size(SIZE);
    settle(&mut window);
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert!(viewer(&mut window).fatal.is_none());
}

#[neurotess_testing::test(needs(gpu))]
fn mouse_and_keys_move_the_camera() {
    let mut window = with_samples(&[Kind::Star]);
    let view = |window: &mut Window| -> View { state(window).view };
    let at = Pos2::new(500.0, 350.0);
    let first = view(&mut window);
    for (button, pressed, to) in [
        (PointerButton::Primary, true, at),
        (PointerButton::Primary, false, at + Vec2::new(60.0, 20.0)),
        (PointerButton::Middle, true, at),
        (PointerButton::Middle, false, at + Vec2::new(-40.0, 20.0)),
    ] {
        window.event(Event::PointerMoved(to));
        window.step();
        window.event(Event::PointerButton {
            pos: to,
            button,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    let dragged = view(&mut window);
    assert_ne!(dragged.eye, first.eye);
    assert_ne!(dragged.target, first.target, "the middle button moves");
    window.event(Event::PointerMoved(at));
    window.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 60.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(20);
    let distance = |view: View| view.camera().eye().distance(view.camera().target());
    assert!(
        distance(view(&mut window)) < 0.95 * distance(dragged),
        "the wheel comes nearer"
    );
    let before = view(&mut window);
    window.key_down(Key::W);
    window.run_steps(6);
    window.key_up(Key::W);
    window.step();
    assert_ne!(view(&mut window).eye, before.eye, "W flies");
    for (key, axis) in [(Key::Num1, 2), (Key::Num2, 0), (Key::Num3, 1)] {
        window.key_press(key);
        window.step();
        settle(&mut window);
        let backward = view(&mut window).camera().axes()[2];
        assert!(backward[axis] > 0.99, "{key:?}: {backward}");
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn without_perspective_things_keep_their_size_and_their_names() {
    let mut window = with_samples(&[Kind::Star]);
    let view = |window: &mut Window| -> View { state(window).view };
    let first = view(&mut window);
    window.key_press(Key::O);
    window.step();
    settle(&mut window);
    let parallel = view(&mut window);
    assert!(parallel.orthographic);
    assert_eq!(
        View {
            orthographic: false,
            ..parallel
        },
        first,
        "nothing else has changed"
    );
    // What is drawn where the soma is can be picked, and a double click comes nearer to it.
    let soma = state(&mut window).sources.iter().next().expect("a cell").1;
    let soma = soma.morphology.soma().expect("a soma").center.as_dvec3();
    let at = hit_at(&mut window, soma);
    click(&mut window, at, Modifiers::NONE);
    assert!(state(&mut window).pointing.picked.is_some());
    let height = |view: View| view.camera().height();
    // At once: the window handles them in their order, as one double click.
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let events = &mut window.input_mut().events;
    events.push(Event::PointerMoved(at));
    events.extend([true, false, true, false].map(button));
    for _ in 0..12 {
        let time = window.ctx.input(|input| input.time) + 0.5;
        window.input_mut().time = Some(time);
        window.step();
    }
    settle(&mut window);
    let near = view(&mut window);
    assert!(height(near) < 0.6 * height(parallel), "{}", height(near));
    assert!(
        near.orthographic && hit_at(&mut window, soma).distance(picture(&window).center()) < 90.0
    );
    // From the other side, behind the eye of before, all is still there.
    run(&mut window, Command::SaveView);
    run(&mut window, Command::Look(Side::Back));
    state(&mut window).pointing.picked = None;
    let at = hit_at(&mut window, soma);
    click(&mut window, at, Modifiers::NONE);
    assert!(
        state(&mut window).pointing.picked.is_some(),
        "seen from behind"
    );
    window.key_press(Key::Num5);
    window.step();
    settle(&mut window);
    assert_eq!(view(&mut window), near, "the saved view");
    window.key_press(Key::O);
    window.step();
    assert!(!view(&mut window).orthographic);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_is_too_expensive_is_explored_says_so_and_comes_back() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    run(&mut window, Command::Show(Tab::Detail));
    let one = state(&mut window).drawing.counters.patches[1];
    assert!(one > 0, "counted");
    // Three are too many, one is not.
    viewer(&mut window).stage.limit_patches(Some(2 * one));
    let state_of = state(&mut window);
    for name in ["b", "c"] {
        let neuron = neurotess_viewer::document::Neuron::new(SourceId(0), name.into());
        state_of.document.neurons.push(neuron);
    }
    state_of.document.grid = true;
    state_of.document.detail.at_rest = RestChoice::Budget;
    run(&mut window, Command::Home);
    assert!(viewer(&mut window).stage.is_sharp(), "no draft");
    let Some(Lowered::Triangles(Some([drawn, needed]))) =
        state(&mut window).drawing.counters.lowered
    else {
        panic!(
            "explored: {:?}",
            state(&mut window).drawing.counters.lowered
        );
    };
    assert!(drawn > 0 && drawn <= needed);
    window.get_by_label_contains("reduced: ");
    // One may ask for all detail all the same, and for a budget where there is no need.
    // By itself, the processor completes what an adapter would have to block the window for.
    let mut detail = state(&mut window).document.detail;
    let by_adapter = !software(&mut window);
    for (at_rest, budget) in [
        (RestChoice::Full, false),
        (RestChoice::Automatic, by_adapter),
        (RestChoice::Budget, true),
    ] {
        detail.at_rest = at_rest;
        run(&mut window, Edit::SetDetail(detail));
        let lowered = state(&mut window).drawing.counters.lowered;
        assert_eq!(
            matches!(lowered, Some(Lowered::Triangles(_))),
            budget,
            "{at_rest:?}"
        );
    }
    // What is seen is known there too: somata, and a section by its number.
    let parts = seen_parts(&mut window);
    assert!(parts.contains(&(0, CellPart::Soma)) && parts.contains(&(2, CellPart::Soma)));
    let neurites = parts
        .iter()
        .filter(|(_, p)| matches!(p, CellPart::Section(_)));
    assert!(neurites.count() > 10, "{parts:?}");
    // Exploration mode draws no wireframe: the picture is coarser, and the window says so.
    let mut look = state(&mut window).document.look.clone();
    look.wireframe = true;
    run(&mut window, Edit::SetLook(Box::new(look.clone())));
    assert!(matches!(
        state(&mut window).drawing.counters.lowered,
        Some(Lowered::Error(_))
    ));
    look.wireframe = false;
    run(&mut window, Edit::SetLook(Box::new(look)));
    detail.at_rest = RestChoice::Automatic;
    run(&mut window, Edit::SetDetail(detail));
    // Alone, it is whole again, and the window no longer says so.
    run(&mut window, Edit::Select(vec![1], false));
    run(&mut window, Edit::Isolate);
    assert_eq!(state(&mut window).drawing.counters.lowered, None);
    assert!(window.query_by_label_contains("reduced: ").is_none());
    assert!(
        seen_parts(&mut window)
            .iter()
            .all(|(neuron, _)| *neuron == 1)
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn tracings_that_do_not_fit_the_memory_are_there_where_they_show() {
    let kinds = [Kind::Motor, Kind::Star, Kind::Pyramidal];
    let opened = |memory: Option<u64>| {
        let mut window = with_samples(&[]);
        viewer(&mut window).stage.limit_memory(memory);
        for kind in kinds {
            run(&mut window, Command::OpenSample(kind));
        }
        // The last of them alone, then all of them in a row, then the first.
        run(&mut window, Edit::Select(vec![2], false));
        run(&mut window, Edit::Isolate);
        settle(&mut window);
        let alone = (
            drawn(&mut window),
            state(&mut window).drawing.counters.lowered,
        );
        run(&mut window, Edit::ShowAll);
        state(&mut window).document.grid = true;
        run(&mut window, Command::Home);
        settle(&mut window);
        let row = (
            drawn(&mut window),
            state(&mut window).drawing.counters.lowered,
        );
        run(&mut window, Edit::Select(vec![0], false));
        run(&mut window, Edit::Isolate);
        settle(&mut window);
        let first = (
            drawn(&mut window),
            state(&mut window).drawing.counters.lowered,
        );
        let points = state(&mut window).sources.iter();
        let points = points.map(|(_, source)| source.generated.mesh.tracing.len() as u64);
        let points = points.max().expect("opened");
        let bytes = state(&mut window).drawing.counters.bytes[0];
        ([alone, row, first], bytes, points)
    };
    let (whole, bytes, points) = opened(None);
    assert!(whole.iter().all(|(_, lowered)| lowered.is_none()));
    // Of refined tracings, half of the memory has the largest.
    let (limited, fewer, _) = opened(Some(2 * 33 * points));
    assert!(fewer < bytes, "{fewer} of {bytes}");
    for (place, ((expected, _), (pixels, _))) in whole.iter().zip(&limited).enumerate() {
        let share = differing(expected, pixels) as f64 / (pixels.len() / 4) as f64;
        // Refined ones are the same; what is explored is off by up to half a pixel, which all outlines show.
        let most = if place == 1 { 0.05 } else { 0.001 };
        assert!(share < most, "{share} of the pixels, {place}");
    }
    let lowered = limited.map(|(_, lowered)| lowered.is_some());
    // The processor completes what is explored.
    let explored = !software(&mut with_samples(&[]));
    assert_eq!(
        lowered,
        [false, explored, false],
        "together they are explored"
    );
}

/// Whether the window's adapter is software.
fn software(window: &mut Window) -> bool {
    viewer(window).stage.gpu().adapter.software
}

/// What is seen at pixels all over the picture.
fn seen_parts(window: &mut Window) -> std::collections::HashSet<(usize, CellPart)> {
    let stage = &viewer(window).stage;
    let pixels = (0..700).flat_map(|y| (0..900).map(move |x| (x as f32, y as f32)));
    let seen = pixels.filter_map(|(x, y)| stage.hit_at(x, y));
    let parts = seen.filter_map(|seen| seen.picked());
    parts.map(|picked| (picked.neuron, picked.part)).collect()
}
