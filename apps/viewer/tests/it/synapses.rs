//! Synapses of circuits and points of tables in the window.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use eframe::egui::{Modifiers, Pos2};
use egui_kittest::kittest::Queryable;
use hdf5_pure::{AttrValue, FileBuilder};
use neurotess::circuit::SynapseSide;
use neurotess::coloring::ColorTarget;
use neurotess::render::MarkerShape;
use neurotess::synth::Kind;
use neurotess::synth::circuit::{EDGES, POPULATION};
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::MarkerOptions;
use neurotess_viewer::markers::MarkerRef;
use neurotess_viewer::partners::Role;
use neurotess_viewer::save::PictureFile;
use neurotess_viewer::{Command, draw_session};

use crate::common::circuit::write_with_synapses;
use crate::common::{
    Window, click, differing, drawn, gpu, picture, pixels, rest, run, set_look, settle, snapshot,
    state, viewer, wait, window, with_samples,
};

/// Cells of the circuit, and synapses onto each.
const CELLS: usize = 6;
const EACH: usize = 20;

/// A window with a circuit whose cells have [`EACH`] chemical synapses and a gap each.
fn with_synapses() -> (Window, tempfile::TempDir) {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_with_synapses(folder.path(), CELLS, 3, EACH);
    let path = folder.path().to_path_buf();
    run(&mut window, Command::Open(vec![path]));
    assert_eq!(state(&mut window).document.neurons.len(), CELLS);
    (window, folder)
}

fn set_markers(window: &mut Window, change: impl FnOnce(&mut MarkerOptions)) {
    let mut markers = state(window).document.markers.clone();
    change(&mut markers);
    run(window, Edit::SetMarkers(Box::new(markers)));
}

/// Number of all synapses and points of the picture.
fn all(window: &mut Window) -> Option<usize> {
    let counters = &state(window).drawing.counters;
    counters.markers.map(|[_, _, all]| all)
}

/// Synapses and points that show, and where.
fn seen(window: &mut Window) -> Vec<(MarkerRef, Pos2)> {
    wait(window, |w| viewer(w).stage.can_pick());
    let rect = picture(window);
    let stage = &viewer(window).stage;
    let (mut known, mut found) = (HashSet::new(), Vec::new());
    for y in 0..rect.height() as usize {
        for x in 0..rect.width() as usize {
            let [x, y] = [x, y].map(|n| n as f32 + 0.5);
            let marker = stage.hit_at(x, y).and_then(|hit| hit.marker());
            if let Some(marker) = marker.filter(|&marker| known.insert(marker)) {
                found.push((marker, rect.min + egui::Vec2::new(x, y)));
            }
        }
    }
    found
}

fn legend_names(window: &mut Window) -> Vec<String> {
    let things = viewer(window).stage.colored_things();
    things
        .iter()
        .map(|thing| thing.target.to_string())
        .collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn synapses_show_and_are_undone() {
    let (mut window, _folder) = with_synapses();
    rest(&mut window);
    let without = drawn(&mut window);
    assert_eq!(all(&mut window), None);
    run(&mut window, Edit::ShowSynapses(true));
    rest(&mut window);
    assert_eq!(all(&mut window), Some(CELLS * (EACH + 1)));
    let with = drawn(&mut window);
    let shown = differing(&without, &with);
    assert!(shown > 300, "{shown} pixels");
    let names = legend_names(&mut window);
    assert!(
        names.contains(&EDGES.to_owned()) && names.contains(&"gaps".to_owned()),
        "{names:?}"
    );
    // One of the populations; a side that the file does not have.
    set_markers(&mut window, |markers| markers.edges = vec!["gaps".into()]);
    assert_eq!(all(&mut window), Some(CELLS));
    set_markers(&mut window, |markers| markers.side = SynapseSide::Efferent);
    assert_eq!(all(&mut window), None);
    let problem = state(&mut window)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(problem.why.contains("efferent_surface_x"), "{problem:?}");
    run(&mut window, Command::Undo);
    run(&mut window, Command::Undo);
    rest(&mut window);
    assert_eq!(all(&mut window), None);
    let left = differing(&without, &drawn(&mut window));
    assert!(left < shown / 4, "{left} of {shown} pixels");
    assert!(state(&mut window).messages.problems.is_empty());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn only_those_of_cells_that_are_shown_and_selected() {
    let (mut window, _folder) = with_synapses();
    run(&mut window, Edit::ShowSynapses(true));
    rest(&mut window);
    let before = state(&mut window).drawing.counters.rebuilds;
    run(&mut window, Edit::Select(vec![2], false));
    assert_eq!(all(&mut window), Some(EACH + 1));
    // Markers at other places are another picture, of the same cells.
    rest(&mut window);
    let after = state(&mut window).drawing.counters.rebuilds;
    assert_eq!(
        (after.templates, after.proxies),
        (before.templates, before.proxies)
    );
    set_markers(&mut window, |markers| markers.of_selected = false);
    assert_eq!(all(&mut window), Some(CELLS * (EACH + 1)));
    run(&mut window, Edit::Hide);
    assert_eq!(all(&mut window), Some((CELLS - 1) * (EACH + 1)));
    run(&mut window, Edit::ShowAll);
    assert_eq!(all(&mut window), Some(CELLS * (EACH + 1)));
    // Side by side, synapses go with their cells.
    let origins = |window: &mut Window| -> Vec<glam::DVec3> {
        let stage = &viewer(window).stage;
        stage.marker_positions().to_vec()
    };
    let traced = origins(&mut window);
    run(&mut window, Edit::SetGrid(true));
    let moved = origins(&mut window);
    let placements = state(&mut window).placements();
    let neurons = &state(&mut window).document.neurons;
    let way = |i: usize| placements[i].translation - neurons[i].placement.translation;
    let ways: Vec<glam::DVec3> = (0..CELLS).map(way).collect();
    for (from, to) in traced.iter().zip(&moved) {
        let fits = ways.iter().any(|way| (*to - *from).distance(*way) < 1e-6);
        assert!(fits, "{from} to {to}");
    }
    assert!(ways.iter().any(|way| way.length() > 1.0));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn colors_of_synapses_change_without_drawing() {
    let (mut window, _folder) = with_synapses();
    run(&mut window, Edit::ShowSynapses(true));
    set_markers(&mut window, |markers| markers.size = 12.0);
    rest(&mut window);
    let before = state(&mut window).drawing.counters.rebuilds;
    let pure = |window: &mut Window| {
        let image = window.render().expect("a picture");
        let is = |p: &&[u8]| p[0] > 180 && p[1] < 90 && p[2] > 180;
        image.as_raw().chunks(4).filter(is).count()
    };
    let few = pure(&mut window);
    set_look(&mut window, |look| {
        let target = ColorTarget::Category(EDGES.to_owned());
        look.own_colors.set(target, [255, 0, 255]);
    });
    assert!(viewer(&mut window).stage.is_static() && viewer(&mut window).stage.is_sharp());
    let after = state(&mut window).drawing.counters.rebuilds;
    assert_eq!(
        (after.templates, after.instances),
        (before.templates, before.instances)
    );
    assert!(pure(&mut window) > few + 500);
    // Other colors of the cells leave synapses as they are.
    let positions = viewer(&mut window).stage.marker_positions().len();
    set_look(&mut window, |look| {
        look.color_by = neurotess_viewer::document::ColorBy::Neuron;
    });
    rest(&mut window);
    assert_eq!(
        viewer(&mut window).stage.marker_positions().len(),
        positions
    );
    assert!(pure(&mut window) > few + 500);
    // By a number: all populations have it, or it is an error that is told.
    set_markers(&mut window, |markers| {
        markers.property = Some("delay".into());
    });
    assert_eq!(all(&mut window), Some(CELLS * (EACH + 1)));
    assert!(!legend_names(&mut window).contains(&EDGES.to_owned()));
    set_markers(&mut window, |markers| {
        markers.property = Some("conductance".into());
    });
    let problem = state(&mut window)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(
        problem.why.contains("has no number 'conductance'"),
        "{problem:?}"
    );
    assert_eq!(all(&mut window), None);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_click_tells_which_synapse_it_is() {
    let (mut window, _folder) = with_synapses();
    set_markers(&mut window, |markers| {
        markers.synapses = true;
        markers.edges = vec![EDGES.into()];
        markers.property = Some("conductance".into());
        markers.size = 12.0;
    });
    run(&mut window, Command::Show(Tab::Look));
    rest(&mut window);
    snapshot(&mut window, "synapses");
    let found = seen(&mut window);
    assert!(found.len() > CELLS * EACH / 2, "{} are seen", found.len());
    let (marker, at) = found[found.len() / 2];
    click(&mut window, at, Modifiers::NONE);
    assert_eq!(state(&mut window).pointing.picked_marker, Some(marker));
    assert_eq!(
        state(&mut window).document.selected().count(),
        0,
        "a synapse is no cell"
    );
    let facts = state(&mut window).marker_facts(marker).expect("facts");
    let MarkerRef::Synapse(row) = marker else {
        panic!("{marker:?}");
    };
    assert_eq!(facts.title, format!("Synapse {}", row.row));
    // Synapses are written cell by cell.
    let cell = row.row as usize / EACH;
    assert_eq!(facts.neurons[0], Some(cell));
    let number = facts.rows.iter().find(|(name, _)| name == "conductance");
    let number = number.and_then(|(_, text)| text.parse::<f64>().ok());
    assert!(number.is_some_and(|n| n > 0.0), "{facts:?}");
    assert!(state(&mut window).messages.status.starts_with("Synapse"));
    // Paths of both cells to their somata.
    let paths = state(&mut window).partner_paths();
    let roles: Vec<Role> = paths.iter().map(|path| path.role).collect();
    assert_eq!(roles, [Role::Postsynaptic, Role::Presynaptic]);
    assert_eq!(
        [Some(paths[0].neuron), Some(paths[1].neuron)],
        facts.neurons
    );
    assert!(paths[0].gap < 0.5 && paths[0].length > 0.0, "{paths:?}");
    rest(&mut window);
    snapshot(&mut window, "synapse_picked");
    window.get_by_label("Select its cell").click();
    window.run_steps(2);
    settle(&mut window);
    assert_eq!(
        state(&mut window).document.selected().collect::<Vec<_>>(),
        [cell]
    );
    assert_eq!(all(&mut window), Some(EACH));
    // In exploration mode the same ones are picked.
    run(&mut window, Edit::SelectNone);
    viewer(&mut window).stage.limit_patches(Some(0));
    let turned = state(&mut window).view.orbited(0.2, 0.0, glam::DVec3::Y);
    run(&mut window, Command::Go(turned));
    assert!(state(&mut window).drawing.counters.lowered.is_some());
    assert!(seen(&mut window).len() > CELLS * EACH / 2);
    // Switched off, it is forgotten.
    run(&mut window, Edit::ShowSynapses(false));
    assert_eq!(state(&mut window).pointing.picked_marker, None);
    assert!(state(&mut window).partner_paths().is_empty());
    assert!(window.query_by_label("Select its cell").is_none());
}

/// Replaces `edges.h5` by one that only says sections: one onto each cell's soma and one onto its first section,
/// but for the last cell a section that it does not have.
fn write_sections(folder: &Path) {
    let targets: Vec<u64> = (0..CELLS as u64).chain(0..CELLS as u64).collect();
    let of_row = |row| row / CELLS as u64;
    let mut sections: Vec<u64> = (0..2 * CELLS as u64).map(of_row).collect();
    sections[2 * CELLS - 1] = 100_000;
    let mut file = FileBuilder::new();
    let mut edges = file.create_group("edges");
    let mut population = edges.create_group(EDGES);
    for end in ["source_node_id", "target_node_id"] {
        population
            .create_dataset(end)
            .with_u64_data(&targets)
            .set_attr(
                "node_population",
                AttrValue::VarLenString(POPULATION.into()),
            );
    }
    let mut group = population.create_group("0");
    group
        .create_dataset("afferent_section_id")
        .with_u64_data(&sections);
    group
        .create_dataset("afferent_section_pos")
        .with_f64_data(&[0.5; 2 * CELLS]);
    population.add_group(group.finish());
    edges.add_group(population.finish());
    file.add_group(edges.finish());
    let bytes = file.finish().expect("bytes");
    fs::write(folder.join("edges.h5"), bytes).expect("written");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn synapses_that_only_name_sections_are_shown_picked_and_moved() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_with_synapses(folder.path(), CELLS, 3, EACH);
    write_sections(folder.path());
    run(
        &mut window,
        Command::Open(vec![folder.path().to_path_buf()]),
    );
    set_markers(&mut window, |markers| {
        markers.synapses = true;
        markers.edges = vec![EDGES.into()];
        markers.size = 12.0;
    });
    assert_eq!(all(&mut window), Some(2 * CELLS - 1));
    let problem = state(&mut window)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(problem.why.contains("name sections"), "{problem:?}");
    // The first ones are on the somata.
    let places = viewer(&mut window).stage.marker_positions();
    for (cell, place) in places.iter().take(CELLS).enumerate() {
        let soma = state(&mut window).middle_of(cell).expect("a soma");
        let away = soma.distance(*place);
        assert!((1.0..20.0).contains(&away), "{away} µm");
    }
    let (marker, at) = seen(&mut window)[0];
    click(&mut window, at, Modifiers::NONE);
    assert_eq!(state(&mut window).pointing.picked_marker, Some(marker));
    let facts = state(&mut window).marker_facts(marker).expect("facts");
    assert!(facts.neurons[0].is_some(), "{facts:?}");
    // They go along with a cell that is moved.
    let mut placement = state(&mut window).document.neurons[0].placement;
    placement.translation.z += 50.0;
    run(&mut window, Edit::Place(vec![(0, placement)]));
    let moved = viewer(&mut window).stage.marker_positions();
    let way = moved[0] - places[0];
    assert!(way.distance(glam::DVec3::Z * 50.0) < 1e-6, "{way}");
    assert_eq!(moved[1], places[1]);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn contact_discs_are_picked_and_undone() {
    let (mut window, _folder) = with_synapses();
    set_markers(&mut window, |markers| {
        markers.synapses = true;
        markers.edges = vec![EDGES.into()];
        markers.size = 4.0;
    });
    // Near enough for discs.
    run(&mut window, Edit::Select(vec![5], false));
    run(&mut window, Edit::Isolate);
    run(&mut window, Command::Focus);
    run(&mut window, Command::Show(Tab::Look));
    rest(&mut window);
    let spheres = drawn(&mut window);
    let places = viewer(&mut window).stage.marker_positions();
    window.get_by_label("Contact discs").click();
    window.run_steps(2);
    settle(&mut window);
    rest(&mut window);
    assert_eq!(
        state(&mut window).document.markers.shape,
        MarkerShape::Contact
    );
    let contacts = drawn(&mut window);
    assert!(differing(&spheres, &contacts) > 500);
    // Synthetic synapses lie on the membrane already.
    let laid = viewer(&mut window).stage.marker_positions();
    assert_eq!(laid.len(), EACH);
    let way = |(a, b): (&glam::DVec3, &glam::DVec3)| a.distance(*b);
    let most = places.iter().zip(&laid).map(way).fold(0.0, f64::max);
    assert!(most < 0.5, "{most} µm");
    snapshot(&mut window, "contacts");
    // A disc is its synapse: some are seen where their sphere is not.
    let found = seen(&mut window);
    assert!(found.len() > EACH / 2, "{} are seen", found.len());
    let (marker, at) = found[0];
    click(&mut window, at, Modifiers::NONE);
    assert_eq!(state(&mut window).pointing.picked_marker, Some(marker));
    run(&mut window, Command::Undo);
    rest(&mut window);
    assert_eq!(
        state(&mut window).document.markers.shape,
        MarkerShape::Sphere
    );
    // By the palette, with synapses that are shown by it.
    run(&mut window, Edit::ShowSynapses(false));
    run(&mut window, Edit::ShowContacts(true));
    assert_eq!(all(&mut window), Some(EACH));
}

fn write_points(file: &Path) {
    let rows = (0..40).map(|i| format!("{},{},{},{}\n", 3 * i - 60, i, 30, f64::from(i) / 10.0));
    let text: String = std::iter::once("x,y,z,weight\n".to_owned())
        .chain(rows)
        .collect();
    fs::write(file, text).expect("written");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn points_of_a_table_show_beside_any_cell() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("spines.csv");
    write_points(&file);
    // As a drop opens it.
    run(&mut window, Command::Open(vec![file.clone()]));
    assert_eq!(all(&mut window), Some(40));
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert!(legend_names(&mut window).contains(&"spines".to_owned()));
    set_markers(&mut window, |markers| {
        markers.column = Some("weight".into());
        markers.size = 4.0;
    });
    assert!(!legend_names(&mut window).contains(&"spines".to_owned()));
    let (marker, at) = seen(&mut window)[0];
    click(&mut window, at, Modifiers::NONE);
    assert_eq!(state(&mut window).pointing.picked_marker, Some(marker));
    let facts = state(&mut window).marker_facts(marker).expect("facts");
    assert!(facts.title.starts_with("Point ") && facts.neurons == [None; 2]);
    assert!(facts.rows.iter().any(|(name, _)| name == "weight"));
    // They may lie away from all cells.
    fs::write(&file, "x,y,z\n3000,0,0\n").expect("written");
    run(&mut window, Command::OpenPoints(file.clone()));
    set_markers(&mut window, |markers| {
        (markers.column, markers.size) = (None, 60.0);
    });
    run(&mut window, Command::Home);
    rest(&mut window);
    assert_eq!(seen(&mut window).len(), 1);
    // Broken ones are told of, and nothing else is lost.
    fs::write(&file, "x,y,z\n1,2,up\n").expect("written");
    run(&mut window, Command::OpenPoints(file.clone()));
    let problem = state(&mut window)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(
        problem.why.starts_with("line 2: ") && problem.what.ends_with("spines.csv"),
        "{problem:?}"
    );
    assert_eq!(all(&mut window), None);
    run(&mut window, Edit::SetPoints(None));
    assert_eq!(
        state(&mut window).document.markers,
        MarkerOptions {
            size: 60.0,
            ..MarkerOptions::default()
        }
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn sessions_and_saved_pictures_have_synapses_and_points() {
    let (mut window, folder) = with_synapses();
    let at = |name: &str| folder.path().join(name);
    write_points(&at("spines.csv"));
    run(&mut window, Command::OpenPoints(at("spines.csv")));
    set_markers(&mut window, |markers| {
        markers.synapses = true;
        markers.column = Some("weight".into());
        markers.size = 9.0;
    });
    assert_eq!(all(&mut window), Some(CELLS * (EACH + 1) + 40));
    let save = |name: &str| PictureFile {
        out: at(name),
        size: [320, 240],
        samples: 4,
        transparent: false,
        replace: false,
        recipe: true,
    };
    run(&mut window, Command::SavePicture(save("saved.png")));
    run(&mut window, Command::SaveSession(at("mine.neurotess")));
    let text = fs::read_to_string(at("mine.neurotess")).expect("written");
    assert!(text.contains("points = \"spines.csv\""), "{text}");
    let drawn = draw_session(
        &at("mine.neurotess"),
        &save("drawn.png"),
        None,
        &|_| Ok(None),
        false,
    )
    .expect("drawn");
    assert!(drawn.failures.is_empty(), "{:?}", drawn.failures);
    let pixels = |name: &str| pixels(&at(name));
    assert!(
        pixels("saved.png") == pixels("drawn.png"),
        "the same picture"
    );
    run(&mut window, Edit::ShowSynapses(false));
    run(&mut window, Command::SavePicture(save("without.png")));
    assert!(pixels("saved.png") != pixels("without.png"));

    let mut other = self::window();
    other.step();
    run(&mut other, Command::Open(vec![at("mine.neurotess")]));
    assert_eq!(all(&mut other), Some(CELLS * (EACH + 1) + 40));
    assert!(
        state(&mut other).messages.problems.is_empty(),
        "{:?}",
        state(&mut other).messages.problems
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn too_many_for_the_pixels_are_thinned_out_and_counted() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("many.csv");
    let rows = (0..60_000).map(|i| format!("{},{},0\n", f64::from(i % 245) * 1e-3, i / 245));
    let text: String = std::iter::once("x,y,z\n".to_owned()).chain(rows).collect();
    fs::write(&file, text).expect("written");
    run(&mut window, Command::OpenPoints(file));
    let far = state(&mut window).view.zoomed(12.0, glam::DVec3::ZERO);
    run(&mut window, Command::Go(far));
    rest(&mut window);
    let [drawn, in_view, all] = state(&mut window)
        .drawing
        .counters
        .markers
        .expect("markers");
    assert_eq!((in_view, all), (60_000, 60_000));
    assert!(drawn < in_view / 2, "{drawn}");
    let said = format!("{} of 60\u{a0}000 markers drawn", grouped(drawn));
    window.run_steps(2);
    window.get_by_label(&said);
}

fn grouped(number: usize) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{}\u{a0}{:03}", number / 1000, number % 1000),
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn reading_can_be_stopped() {
    let (mut window, _folder) = with_synapses();
    state(&mut window).run(Edit::ShowSynapses(true));
    window.step();
    state(&mut window).run(Command::Cancel);
    window.step();
    settle(&mut window);
    // Whether it was in time or not: what is shown is what the panel says.
    let shows = state(&mut window).document.markers.synapses;
    assert_eq!(all(&mut window).is_some(), shows);
    run(&mut window, Edit::ShowSynapses(true));
    assert_eq!(all(&mut window), Some(CELLS * (EACH + 1)));
    // Without a circuit there are none: told once.
    let mut other = with_samples(&[Kind::Star]);
    run(&mut other, Edit::ShowSynapses(true));
    other.run_steps(5);
    let [problem] = &state(&mut other).messages.problems[..] else {
        panic!("{:?}", state(&mut other).messages.problems);
    };
    assert!(problem.why.contains("SONATA circuit"), "{problem:?}");
}
