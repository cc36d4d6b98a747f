//! What is changed in the window, undone, and kept in sessions.

use std::fs;

use eframe::egui::{self, Event, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::kittest::Queryable;
use neurotess::render::Side;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::{
    Cut, Detail, Keep, LodKind, Look, Method, SomaEdit, SourceId, SpineEdit,
};
use neurotess_viewer::state::CellPart;

use crate::common::{
    Window, differing, gpu, hit_at, run, settle, snapshot, state, viewer, with_samples,
};

/// Middle of the rail of the n-th slider of the panel.
fn slider(window: &mut Window, n: usize) -> egui::Rect {
    let sliders = window.get_all_by_role(egui::accesskit::Role::Slider);
    let rects: Vec<egui::Rect> = sliders.map(|slider| slider.rect()).collect();
    rects[n]
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_ring_follows_its_slider_and_is_shown_while_it_is_touched() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Command::Show(Tab::Soma));
    let close = state(&mut window).view.focused((glam::DVec3::ZERO, 16.0));
    run(&mut window, Command::Go(close));
    let source = |window: &mut Window| {
        let source = state(window).source_of(0).expect("there");
        (source.generated.rings[0], source.generated.somata[0].volume)
    };
    let (before, volume) = source(&mut window);
    // Poisson's ratio and the radius come first.
    let rail = slider(&mut window, 2);
    window.event(Event::PointerMoved(rail.center()));
    window.step();
    window.step();
    settle(&mut window);
    let part = state(&mut window).pointing.hovered.expect("touched").part;
    assert_eq!(part, CellPart::Neurite(0));
    assert!(state(&mut window).pointing.touched.is_some());
    assert!(
        state(&mut window).document.somata.is_empty(),
        "only touched"
    );
    window.event(Event::PointerButton {
        pos: rail.center(),
        button: PointerButton::Primary,
        pressed: true,
        modifiers: Modifiers::NONE,
    });
    window.step();
    for share in [0.6, 0.7, 0.85] {
        let at = rail.min + Vec2::new(share * rail.width(), rail.height() / 2.0);
        window.event(Event::PointerMoved(at));
        window.step();
        settle(&mut window);
    }
    assert!(
        state(&mut window).pointing.touched.is_some(),
        "while it is dragged"
    );
    snapshot(&mut window, "ring");
    window.event(Event::PointerButton {
        pos: rail.min + Vec2::new(0.85 * rail.width(), rail.height() / 2.0),
        button: PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    });
    window.step();
    settle(&mut window);
    let (after, larger) = source(&mut window);
    assert!(after.position > 1.5, "{after:?} after {before:?}");
    assert!(larger > volume, "the surface follows");
    // The whole drag is one edit.
    run(&mut window, Command::Undo);
    assert_eq!(source(&mut window), (before, volume));
    run(&mut window, Command::Redo);
    assert_eq!(source(&mut window), (after, larger));
    window.event(Event::PointerMoved(Pos2::new(600.0, 730.0)));
    window.step();
    assert!(state(&mut window).pointing.touched.is_none());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn every_edit_can_be_undone_and_done_again() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    run(&mut window, Edit::Select(vec![0], false));
    let look = Look {
        cut: Some(Cut {
            axis: 2,
            place: 0.5,
            flipped: false,
        }),
        wireframe: true,
        ..Look::default()
    };
    let detail = Detail {
        criterion: LodKind::Homogeneous,
        level: 2,
        ..Detail::default()
    };
    let soma = SomaEdit {
        poisson: 0.1,
        scale: 1.3,
        ..SomaEdit::default()
    };
    run(&mut window, Edit::SetRing(SourceId(0), 2, Some(1.5)));
    let edits = [
        Edit::Select(vec![1], false),
        Edit::SelectAll,
        Edit::SelectNone,
        Edit::SelectOthers,
        Edit::Isolate,
        Edit::SetHidden(1, true),
        Edit::Hide,
        Edit::SetSoma(vec![SourceId(0)], soma),
        Edit::SetRing(SourceId(0), 1, Some(0.25)),
        Edit::SetRing(SourceId(0), 2, None),
        Edit::ResetRings(SourceId(0)),
        Edit::GrowSpines(Some(SpineEdit::default())),
        Edit::SetSpines(vec![SourceId(0)], Some(SpineEdit::default())),
        Edit::SetLook(Box::new(look)),
        Edit::SetDetail(detail),
        Edit::SetGrid(true),
        Edit::Remove,
    ];
    for edit in edits {
        let before = state(&mut window).document.clone();
        run(&mut window, edit.clone());
        let after = state(&mut window).document.clone();
        assert_ne!(before, after, "{edit:?} does something");
        run(&mut window, Command::Undo);
        assert_eq!(state(&mut window).document, before, "{edit:?} undone");
        run(&mut window, Command::Redo);
        assert_eq!(state(&mut window).document, after, "{edit:?} done again");
        run(&mut window, Command::Undo);
    }
    run(&mut window, Edit::Remove);
    run(&mut window, Edit::ShowAll);
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert!(viewer(&mut window).fatal.is_none() && state(&mut window).messages.problems.is_empty());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn the_surface_follows_the_soma_editor() {
    let mut window = with_samples(&[Kind::Motor]);
    let volume = |window: &mut Window| {
        let source = state(window).source_of(0).expect("a source").clone();
        source.generated.somata[0].volume
    };
    let usual = volume(&mut window);
    for (edit, grows) in [
        (
            SomaEdit {
                scale: 1.5,
                ..SomaEdit::default()
            },
            true,
        ),
        (
            SomaEdit {
                scale: 0.7,
                ..SomaEdit::default()
            },
            false,
        ),
        (
            SomaEdit {
                method: Method::Profile,
                scale: 1.4,
                ..SomaEdit::default()
            },
            true,
        ),
    ] {
        run(&mut window, Edit::SetSoma(vec![SourceId(0)], edit.clone()));
        assert_eq!(volume(&mut window) > usual, grows, "{edit:?}");
    }
    run(&mut window, Command::Undo);
    run(
        &mut window,
        Edit::SetSoma(vec![SourceId(0)], SomaEdit::default()),
    );
    assert_eq!(volume(&mut window), usual);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_was_traced_of_a_soma_lies_over_it_and_stays_as_asked() {
    let mut window = crate::common::window();
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/somata");
    let file = std::path::Path::new(docs).join("outline.asc");
    run(&mut window, Command::Open(vec![file]));
    run(&mut window, Command::Show(Tab::Soma));
    let close = state(&mut window).view.focused((glam::DVec3::ZERO, 22.0));
    run(&mut window, Command::Go(close));
    snapshot(&mut window, "traced_soma");
    let with = window.render().expect("a picture");
    window.get_by_label("Tracing over the surface").click();
    window.step();
    settle(&mut window);
    let without = window.render().expect("a picture");
    // A tenth of a per cent of the window, at least: a line along the outline.
    let line = differing(with.as_raw(), without.as_raw());
    assert!(line > 1000, "{line}");
    let soma = |window: &mut Window| {
        let source = state(window).source_of(0).expect("a source").clone();
        source.generated.somata[0]
    };
    let off = |value: f64, traced: f64| (value / traced - 1.0).abs();
    let kept = soma(&mut window);
    assert!(off(kept.volume, kept.traced_volume) < 5e-3, "{kept:?}");
    let edit = SomaEdit {
        keep: Keep::Area,
        ..SomaEdit::default()
    };
    run(&mut window, Edit::SetSoma(vec![SourceId(0)], edit));
    let kept = soma(&mut window);
    assert!(off(kept.area, kept.traced_area) < 0.03, "{kept:?}");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_rectangle_selects_the_cells_whose_somata_are_inside() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule, Kind::Basket]);
    run(&mut window, Edit::SetGrid(true));
    run(&mut window, Command::Home);
    let view = state(&mut window).view;
    let somata: Vec<Pos2> = (0..3)
        .map(|neuron| {
            let place = state(&mut window).placements()[neuron];
            let source = state(&mut window).source_of(neuron).expect("open");
            let soma = source.morphology.soma().expect("a soma").center;
            let soma = place.world_from_cell(source.morphology.origin + soma.as_dvec3());
            hit_at(&mut window, soma)
        })
        .collect();
    let mut select = |from: Pos2, to: Pos2, shift: bool| {
        let modifiers = Modifiers {
            shift,
            ..Modifiers::COMMAND
        };
        for (pressed, to) in [(Some(true), from), (None, to), (Some(false), to)] {
            window.event_modifiers(Event::PointerMoved(to), modifiers);
            window.step();
            if let Some(pressed) = pressed {
                let event = Event::PointerButton {
                    pos: to,
                    button: PointerButton::Primary,
                    pressed,
                    modifiers,
                };
                window.event_modifiers(event, modifiers);
                window.step();
            }
        }
        settle(&mut window);
        let state = state(&mut window);
        assert_eq!(state.view, view, "the camera stays");
        state.document.neurons.selected().to_vec()
    };
    let around = Vec2::new(20.0, 20.0);
    assert_eq!(select(somata[1] - around, somata[1] + around, false), [1]);
    // From any corner to the other.
    assert_eq!(select(somata[0] + around, somata[0] - around, true), [0, 1]);
    assert_eq!(select(somata[2] - around, somata[2] + around, false), [2]);
    run(&mut window, Edit::Isolate);
    let hidden = (0..3).map(|i| !state(&mut window).document.neurons.shows(i));
    assert!(hidden.eq([true, true, false]));
}

#[neurotess_testing::test(needs(gpu))]
fn a_session_comes_back_as_it_was() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    let soma = SomaEdit {
        poisson: 0.05,
        ..SomaEdit::default()
    };
    run(&mut window, Edit::SetSoma(vec![SourceId(1)], soma));
    run(&mut window, Edit::Select(vec![1], false));
    run(&mut window, Edit::SetHidden(0, true));
    run(&mut window, Command::Look(Side::Iso));
    run(&mut window, Command::SetOrthographic(true));
    run(&mut window, Command::SaveView);
    run(&mut window, Command::AddKeyView);
    run(&mut window, Command::SaveSession(file.clone()));
    let (document, view) = (state(&mut window).document.clone(), state(&mut window).view);
    let mut other = crate::common::window();
    other.step();
    run(&mut other, Command::Open(vec![file.clone()]));
    assert_eq!(state(&mut other).document, document);
    assert_eq!(
        (
            state(&mut other).view,
            state(&mut other).views.key_views.len()
        ),
        (view, 1)
    );
    // A broken one loses nothing.
    fs::write(&file, "version = 1\nview = 3\n").expect("written");
    run(&mut other, Command::Open(vec![file]));
    assert_eq!(state(&mut other).document, document);
    assert!(
        state(&mut other).messages.problems[0]
            .why
            .contains("line 2")
    );
}
