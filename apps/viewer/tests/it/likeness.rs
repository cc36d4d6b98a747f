//! Saved pictures tell how they were made, in the words of all options.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use neurotess::drawing::{
    DrawOptions, Drawing, DrawingInput, OwnData, Picture, Quiet, open, picture_of_png,
};
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{ColorBy, Look, VisibleParts};
use neurotess_viewer::save::PictureFile;

use crate::common::{Window, gpu, pixels, run, set_look, state, undrawn, with_samples};

fn save(window: &mut Window, out: &Path) -> Picture {
    let picture = PictureFile {
        out: out.to_path_buf(),
        size: [320, 240],
        samples: 4,
        transparent: false,
        replace: true,
        recipe: true,
    };
    run(window, Command::SavePicture(picture));
    picture_of_png(out).expect("told").picture
}

#[neurotess_testing::test(needs(gpu))]
fn a_saved_picture_is_what_the_library_draws_of_what_it_tells() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("saved.png");
    let mut window = with_samples(&[Kind::Star]);
    set_look(&mut window, |look| {
        look.color_by = ColorBy::PathDistance;
        look.background = [10, 20, 30];
        look.own_colors.set_named("soma", [255, 0, 0]);
        look.axes = true;
    });
    let view = state(&mut window).view;
    run(
        &mut window,
        Command::Go(view.orbited(0.5, 0.3, DVec3::Y).zoomed(0.6, DVec3::ZERO)),
    );
    let told = save(&mut window, &out);
    let (_, source) = state(&mut window).sources.iter().next().expect("a cell");
    let (name, morphology) = (source.name.clone(), Arc::clone(&source.morphology));
    let cells = [(&name[..], &*morphology)];
    let drawn = Drawing::new(
        DrawingInput::Cells(&cells),
        DrawOptions::from(told),
        OwnData::default(),
        &open,
        &Quiet::default(),
    );
    let image = drawn
        .expect("drawn")
        .draw(0, &Arc::default())
        .expect("drawn");
    // Opaque pictures are files without alpha.
    let opaque: Vec<u8> = image
        .pixels
        .chunks(4)
        .flat_map(|rgba| &rgba[..3])
        .copied()
        .collect();
    assert!(opaque == pixels(&out), "not a pixel differs");
}

#[neurotess_testing::test(needs(gpu))]
fn a_picture_that_is_opened_gives_its_look_and_view() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("saved.png");
    let mut window = undrawn(&[Kind::Star]);
    let look = Look {
        color_by: ColorBy::BranchOrder,
        background: [0, 0, 0],
        wireframe: true,
        scale_bar: false,
        ..Look::default()
    };
    run(&mut window, Edit::SetLook(Box::new(look.clone())));
    let view = state(&mut window).view.orbited(0.4, 0.2, DVec3::Y);
    run(&mut window, Command::Go(view));
    save(&mut window, &out);
    let mut other = undrawn(&[Kind::Granule]);
    set_look(&mut other, |look| look.parts = VisibleParts::Neurites);
    run(&mut other, Command::Open(vec![out.clone()]));
    assert_eq!(state(&mut other).messages.problems, []);
    let parts = VisibleParts::Neurites;
    assert_eq!(state(&mut other).document.look, Look { parts, ..look });
    assert_eq!(state(&mut other).view, view);
    // It is that of the picture, not of the next start.
    assert!(!state(&mut other).settings.look.wireframe);
    assert_ne!(state(&mut other).settings.look.background, [0, 0, 0]);
    run(&mut other, Command::Undo);
    assert!(!state(&mut other).document.look.wireframe);
    // From a side: another cell is fitted.
    run(&mut window, Command::Home);
    let told = save(&mut window, &out);
    assert_eq!((told.camera.eye, told.camera.fov), (None, view.fov));
    let told = picture_of_png(&out).expect("told");
    assert_eq!(told.warning(&out), None);
}
