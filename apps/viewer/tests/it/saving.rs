//! Saving goes on beside the window, says how far it is, and stops at once.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use egui_kittest::kittest::{NodeT, Queryable};
use neurotess::mesh::{Format, check, read};
use neurotess::recipe::{Crossings, MeshOptions};
use neurotess::synth::Kind;
use neurotess_testing::note;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::Look;
use neurotess_viewer::save::PictureFile;

use crate::common::{
    Window, gpu, run, run_undrawn, settle, snapshot, state, undrawn, viewer, with_samples,
};

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// The bands, or the adapter's tiles, that the line at the bottom says are done, and all.
fn bands(window: &Window) -> Option<[usize; 2]> {
    let mut names = [" bands", " tiles"].into_iter();
    let line = names.find_map(|name| window.query_by_label_contains(name))?;
    let node = line.accesskit_node();
    let text = node.value().or(node.label())?;
    let numbers = text.split(' ').filter_map(|word| word.parse().ok());
    let numbers: Vec<usize> = numbers.collect();
    numbers.try_into().ok()
}

fn wait(window: &mut Window, what: &str, until: impl Fn(&mut Window) -> bool) {
    let begun = Instant::now();
    while !until(window) {
        assert!(begun.elapsed() < Duration::from_secs(120), "never: {what}");
        window.step();
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Stops what is saved.
fn stop(window: &mut Window, at: &str) {
    state(window).messages.status.clear();
    state(window).run(Command::Cancel);
    let begun = Instant::now();
    wait(window, "stopped", |w| {
        state(w).messages.status.contains("stopped")
    });
    note!("stopped {at} after {:?}", begun.elapsed());
    settle(window);
}

#[neurotess_testing::test(needs(gpu))]
fn a_picture_says_its_bands_lets_a_session_be_saved_and_stops() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let picture = PictureFile {
        out: folder.path().join("large.png"),
        size: [6000, 6000],
        samples: 16,
        transparent: false,
        replace: false,
        recipe: true,
    };
    state(&mut window).run(Command::SavePicture(picture.clone()));
    wait(&mut window, "the first band", |window| {
        bands(window).is_some_and(|[done, _]| done > 0)
    });
    let [before, all] = bands(&window).expect("said");
    assert!(all > 20, "{all}");
    // The window goes on.
    let turned = state(&mut window).view.orbited(0.3, 0.1, glam::DVec3::Y);
    state(&mut window).view = turned;
    wait(&mut window, "a draft", |window| {
        viewer(window).stage.is_from(&turned.camera())
    });
    let session = folder.path().join("meanwhile.neurotess");
    state(&mut window).run(Command::SaveSession(session));
    window.step();
    assert!(names(folder.path()).contains(&"meanwhile.neurotess".to_owned()));
    let [done, _] = bands(&window).expect("still drawing");
    assert!(done < all && done >= before);
    stop(&mut window, "in a band");
    assert_eq!(
        names(folder.path()),
        ["meanwhile.neurotess"],
        "nothing half written"
    );
    // Before the first band, while the scene is made ready.
    for wait in [0, 30, 150] {
        let again = picture.clone();
        state(&mut window).run(Command::SavePicture(again));
        window.step();
        std::thread::sleep(Duration::from_millis(wait));
        stop(&mut window, "before the first band");
        assert_eq!(names(folder.path()), ["meanwhile.neurotess"]);
    }
    // And the next one is whole.
    let small = PictureFile {
        out: folder.path().join("small.png"),
        size: [64, 48],
        samples: 4,
        transparent: false,
        replace: false,
        recipe: true,
    };
    run(&mut window, Command::SavePicture(small));
    assert_eq!(names(folder.path()), ["meanwhile.neurotess", "small.png"]);
}

#[neurotess_testing::test(needs(gpu))]
fn saved_pictures_have_the_axes_that_show() {
    let mut window = undrawn(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let picture = |window: &mut Window, name: &str| {
        let out = folder.path().join(name);
        let options = PictureFile {
            out: out.clone(),
            size: [200, 160],
            samples: 1,
            transparent: false,
            replace: false,
            recipe: true,
        };
        state(window).run(Command::SavePicture(options));
        // When the file is there, the next one is not taken yet.
        wait(window, "the picture", |w| {
            state(w).messages.status.contains(name)
        });
        fs::read(out).expect("saved")
    };
    let with = picture(&mut window, "with.png");
    assert_eq!(picture(&mut window, "same.png"), with);
    let look = Look {
        axes: false,
        ..Look::default()
    };
    run_undrawn(&mut window, Edit::SetLook(Box::new(look)));
    let without = picture(&mut window, "without.png");
    assert_ne!(without, with);

    // A picture that is asked for in the frame in which a neuron comes has it.
    state(&mut window).run(Command::OpenSample(Kind::Granule));
    wait(&mut window, "the neuron", |w| {
        state(w).document.neurons.len() == 2
    });
    let both = picture(&mut window, "both.png");
    assert_ne!(both, without);
    settle(&mut window);
    assert_eq!(picture(&mut window, "settled.png"), both);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn meshes_for_simulation_are_saved_by_the_panel_and_stop() {
    let mut window = with_samples(&[Kind::Granule]);
    let folder = tempfile::tempdir().expect("a folder");
    run(&mut window, Command::Show(Tab::Save));
    window.get_by_label("simulation").click();
    window.run_steps(3);
    let form = &mut state(&mut window).save;
    assert!(form.mesh.recipe == MeshOptions::simulation());
    form.mesh.files.format = Format::Msh;
    form.mesh.files.walls = true;
    // The folder has another name in each run.
    form.mesh_out = "/granule.msh".into();
    window.run_steps(2);
    snapshot(&mut window, "save_simulation");
    let out = folder.path().join("granule.msh");
    state(&mut window).save.mesh_out = out.display().to_string();
    window.run_steps(2);
    window.get_by_label("Save 1 mesh").click();
    wait(&mut window, "the mesh", |w| {
        state(w).messages.status.contains("faces")
    });
    let checked = check(&read(&out).expect("a mesh"));
    assert_eq!(checked.self_intersections, 0);
    fs::remove_file(&out).expect("there");

    let mut merged = state(&mut window).save.mesh.clone();
    merged.out = out;
    merged.recipe = MeshOptions::default()
        .with_level(32)
        .with_crossings(Crossings::Merge);
    state(&mut window).run(Command::SaveMeshes(merged));
    wait(&mut window, "merging", |window| {
        window.query_by_label_contains("merging").is_some()
    });
    stop(&mut window, "while merging");
    assert!(names(folder.path()).is_empty());
}

#[neurotess_testing::test(needs(gpu))]
fn what_shows_is_saved_as_a_page_for_browsers() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = undrawn(&[Kind::Star, Kind::Granule]);
    run_undrawn(&mut window, Edit::SetHidden(1, true));
    let file = folder.path().join("cells.html");
    run_undrawn(&mut window, Command::SavePage(file.clone()));
    wait(&mut window, "saved", |w| {
        state(w).messages.status.starts_with("Saved ")
    });
    let page = fs::read_to_string(&file).expect("a page");
    assert!(page.to_lowercase().starts_with("<!doctype html>"));
    // One cell, and the program around it.
    assert!((80_000..200_000).contains(&page.len()), "{}", page.len());
    run_undrawn(&mut window, Edit::SetHidden(0, true));
    run_undrawn(
        &mut window,
        Command::SavePage(folder.path().join("no.html")),
    );
    wait(&mut window, "refused", |w| {
        !state(w).messages.problems.is_empty()
    });
    assert_eq!(names(folder.path()), ["cells.html"]);
}
