//! Panels show the document; only somebody's hand changes it.

use std::fs;

use egui_kittest::kittest::Queryable;
use neurotess::render::Side;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::{
    ColorBy, Cut, Detail, Document, Lighting, LodKind, Look, SomaEdit, SourceId,
};

use crate::common::{Window, gpu, run, settle, state, window, with_samples};

/// A soma whose neurites leave it anywhere but at round places.
const UNEVEN: &str = "1 1 0 0 0 5.123 -1\n2 3 0.37 9.11 0.2 1 1\n3 3 1 30 0 1 2\n\
                      4 3 -7.7 -6.1 1.3 0.8 1\n5 3 -30 -31 2 0.7 4\n6 2 8.9 -0.77 -4.1 0.6 1\n\
                      7 2 40 -3 -9 0.5 6\n";

/// What is the document's must be so still; nothing can be undone.
fn look_at_all_panels(window: &mut Window, what: &str) {
    let before = state(window).document.clone();
    let edits = state(window).history.names();
    for (tab, name) in Tab::ALL {
        run(window, Command::Show(tab));
        window.run_steps(4);
        settle(window);
        let after = &state(window).document;
        assert_eq!(*after, before, "{what}: {name} was only looked at");
        assert_eq!(state(window).history.names(), edits, "{what}: {name}");
    }
}

/// A document with no number that a panel would show as it is.
fn uneven(document: &Document) -> (Look, Detail, SomaEdit) {
    let look = Look {
        light: Lighting::From {
            right: -33.333_33,
            up: 200.7,
        },
        ghost_others: true,
        ghost_opacity: 0.987_654_3,
        decay: 4_321.098_765,
        range: Some([0.123_456_79, 7654.321]),
        cut: Some(Cut {
            axis: 1,
            place: 0.345_678_9,
            flipped: false,
        }),
        ..document.look.clone()
    };
    let detail = Detail {
        error: 0.765_432_1,
        size: 123.456_7,
        level: 3,
        far: 1_234_567.9,
        smallest: 0.123_456_7,
        ..document.detail
    };
    let soma = SomaEdit {
        poisson: 0.123_456_789,
        scale: 5.432_109_8,
        level: 77,
        rings: [(0, 0.123_456_789), (1, 1.987_654_321)].into(),
        ..SomaEdit::default()
    };
    (look, detail, soma)
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn looking_at_panels_changes_nothing() {
    for kind in Kind::ALL {
        let mut window = with_samples(&[kind]);
        look_at_all_panels(&mut window, kind.name());
        run(&mut window, Edit::Select(vec![0], false));
        look_at_all_panels(&mut window, kind.name());
        assert_eq!(state(&mut window).history.names(), [Some("Select"), None]);
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn looking_at_numbers_that_are_not_round_changes_nothing() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("uneven.swc");
    fs::write(&file, UNEVEN).expect("written");
    run(&mut window, Command::Open(vec![file]));
    run(&mut window, Edit::Select(vec![0], false));
    let source = state(&mut window).source_of(0).expect("there");
    let rings: Vec<f64> = source.generated.rings.iter().map(|r| r.position).collect();
    let uneven_ring = |p: &f64| (p * 100.0 - (p * 100.0).round()).abs() > 1e-3;
    assert!(rings.iter().any(uneven_ring), "{rings:?}");
    look_at_all_panels(&mut window, "uneven rings");
    let (look, detail, soma) = uneven(&state(&mut window).document);
    run(&mut window, Edit::SetSoma(vec![SourceId(0)], soma.clone()));
    for (&neurite, &position) in &soma.rings {
        run(
            &mut window,
            Edit::SetRing(SourceId(0), neurite, Some(position)),
        );
    }
    for criterion in [
        LodKind::Error,
        LodKind::Size,
        LodKind::Homogeneous,
        LodKind::Distance,
    ] {
        run(
            &mut window,
            Edit::SetDetail(Detail {
                criterion,
                ..detail
            }),
        );
        look_at_all_panels(&mut window, "uneven detail");
    }
    for (color_by, _) in ColorBy::ALL {
        let look = Look {
            color_by,
            attribute: "none such".into(),
            ..look.clone()
        };
        run(&mut window, Edit::SetLook(Box::new(look)));
        look_at_all_panels(&mut window, "uneven look");
    }
    assert_eq!(state(&mut window).document.soma(SourceId(0)), soma);
    run(&mut window, Command::Look(Side::Front));
    window.get_by_label("Save session…");
}
