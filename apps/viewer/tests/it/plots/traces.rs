//! Values of compartments over time.

use std::fs;

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect};
use egui_kittest::kittest::Queryable;
use neurotess::circuit::Report;
use neurotess::morphology::paths::Location;
use neurotess::morphology::{Morphology, Program, SectionNumbers};
use neurotess::plot::Data;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, PlotOf};
use neurotess_viewer::document::TracePlace;
use neurotess_viewer::traces::TraceContent;

use crate::common::circuit::{with_circuit, write_firing};
use crate::common::{Window, click, gpu, hit_at, rest, run, settle, snapshot, state, viewer};

/// A window with a report of seven of nine cells, of which the first one shows.
fn with_report() -> (Window, tempfile::TempDir) {
    let (mut window, folder) = with_circuit();
    let report = folder.path().join("voltage.h5");
    run(&mut window, Edit::SetReport(Some(report)));
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Edit::Isolate);
    run(&mut window, Command::Home);
    (window, folder)
}

pub(crate) fn morphology(window: &mut Window, neuron: usize) -> std::sync::Arc<Morphology> {
    let source = state(window).source_of(neuron).expect("open");
    source.morphology.clone()
}

/// Looks at a place of the first neuron from near, and clicks it.
fn click_near(window: &mut Window, location: Location, modifiers: Modifiers) {
    let at = location.position(&morphology(window, 0));
    let at = state(window).placements()[0].world_from_cell(at);
    let view = state(window).view.focused((at, 15.0));
    run(window, Command::Go(view));
    rest(window);
    let at = hit_at(window, at);
    window.event(Event::ModifiersChanged(modifiers));
    click(window, at, modifiers);
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    window.step();
}

/// A location a fifth along the longest section.
fn along_the_longest(morphology: &Morphology) -> (u32, Location) {
    let lengths = neurotess::morphology::shape::section_lengths(morphology);
    let longest = (0..lengths.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
    let section = longest.expect("sections") as u32;
    let location = TracePlace::location(Some(section), 0.2, morphology);
    (section, location.expect("on it"))
}

/// What the report has of a place of the first neuron, read frame by frame.
fn expected(folder: &std::path::Path, place: TracePlace, morphology: &Morphology) -> Vec<f32> {
    let report = Report::open(folder.join("voltage.h5")).expect("a report");
    let cells = &report.populations[0];
    let numbers = SectionNumbers::of(morphology, Program::Neuron).of_sections();
    let number = place.section.map_or(0, |section| numbers[section as usize]);
    let own = cells.compartments(0).expect("compartments");
    let far = |i: &usize| (own[*i].along - place.along).abs();
    let there = (0..own.len()).filter(|&i| own[i].section == number);
    let nearest = there.min_by(|a, b| far(a).total_cmp(&far(b)));
    let column = cells.compartment_range(0).start + nearest.expect("one") as u64;
    let values = (0..cells.time.frames).map(|frame| cells.values(frame, &[column]));
    values.flat_map(|values| values.expect("values")).collect()
}

fn values(window: &mut Window, place: TracePlace) -> Vec<f32> {
    let read = state(window).traces.of(place).expect("read").clone();
    match &read.content {
        TraceContent::Values { values, .. } => values.clone(),
        other => panic!("{other:?}"),
    }
}

fn places(window: &mut Window) -> Vec<TracePlace> {
    let traces = state(window).document.traces.iter();
    traces.map(|trace| trace.place).collect()
}

/// Drags with the left button.
fn drag(window: &mut Window, from: Pos2, to: Pos2) {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.event(Event::PointerMoved(from));
    window.step();
    window.event(button(from, true));
    window.step();
    for share in [0.3, 0.6, 1.0] {
        window.event(Event::PointerMoved(from.lerp(to, share)));
        window.step();
    }
    window.event(button(to, false));
    window.step();
    settle(window);
}

/// Where the plot of traces has a time of 0 to 9.5 ms.
fn x_of(rect: Rect, time: f64) -> f32 {
    let margin = 0.01 * 9.5;
    let share = (time + margin) / (9.5 + 2.0 * margin);
    rect.left() + share as f32 * rect.width()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn clicked_compartments_are_plotted_and_the_line_is_the_time() {
    let (mut window, folder) = with_report();
    window.key_press(Key::T);
    window.step();
    settle(&mut window);
    assert!(state(&mut window).traces.open);
    let cell = morphology(&mut window, 0);
    click_near(&mut window, Location::Soma(0), Modifiers::NONE);
    let (section, location) = along_the_longest(&cell);
    click_near(&mut window, location, Modifiers::SHIFT);
    let places = places(&mut window);
    assert_eq!(places.len(), 2, "{:?}", state(&mut window).messages.status);
    assert_eq!(
        (places[0].section, places[1].section),
        (None, Some(section))
    );
    assert!((places[1].along - 0.2).abs() < 0.1, "{places:?}");
    for place in &places {
        let expected = expected(folder.path(), *place, &cell);
        assert_eq!(expected.len(), 20);
        assert_eq!(values(&mut window, *place), expected);
    }
    assert_eq!(state(&mut window).messages.problems, []);
    let names = state(&mut window).trace_plot();
    let names: Vec<&str> = names.series.iter().map(|s| s.name.as_str()).collect();
    assert!(names[0].ends_with(", soma"), "{names:?}");
    let part = format!(", section {section}");
    assert!(names[1].contains(&part), "{names:?}");
    window.get_by_label(&format!("Remove {}", names[1]));
    // The same compartment once more takes it away; undo brings it back.
    click_near(&mut window, location, Modifiers::SHIFT);
    assert_eq!(state(&mut window).document.traces.len(), 1);
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.traces.len(), 2);
    // While the cursor rests, its compartment's value is told.
    wait_for_tip(&mut window);
    assert_eq!(window.query_all_by_label("compartment").count(), 1);
    // The line is dragged; elsewhere a drag moves the plot, and the time stays.
    run(&mut window, Command::Home);
    let rect = window.get_by_label("Plot of traces").rect();
    let at = |time| Pos2::new(x_of(rect, time), rect.center().y);
    drag(&mut window, at(0.0), at(6.0));
    let time = state(&mut window).playback.pace.time;
    assert!((time - 6.0).abs() < 0.1, "{time}");
    drag(&mut window, at(3.0), at(4.5));
    assert_eq!(state(&mut window).playback.pace.time, time);
    let button = format!("Remove {}", names[0]);
    window.get_by_label(&button).click();
    window.step();
    settle(&mut window);
    assert_eq!(self::places(&mut window), places[1..]);
    run(&mut window, Command::Undo);
    // A cell that the report does not have is only selected.
    run(&mut window, Edit::ShowAll);
    let at = state(&mut window).placements()[8].world_from_cell(Default::default());
    let view = state(&mut window).view.focused((at, 15.0));
    run(&mut window, Command::Go(view));
    rest(&mut window);
    let at = hit_at(&mut window, at);
    click(&mut window, at, Modifiers::NONE);
    assert_eq!(state(&mut window).document.traces.len(), 2);
    assert!(
        state(&mut window).messages.status.contains("no values"),
        "{}",
        state(&mut window).messages.status
    );
}

/// Steps until the cursor has rested and a value was read.
fn wait_for_tip(window: &mut Window) {
    for _ in 0..20 {
        window.step();
        settle(window);
    }
}

fn two_traces(window: &mut Window) -> Vec<TracePlace> {
    let cell = morphology(window, 0);
    let soma = TracePlace {
        neuron: 0,
        section: None,
        along: 0.0,
    };
    let (section, _) = along_the_longest(&cell);
    let dendrite = TracePlace {
        section: Some(section),
        along: 0.2,
        ..soma
    };
    run(window, Command::ShowTraces(true));
    run(window, Edit::Plot(soma, false));
    run(window, Edit::Plot(dendrite, true));
    places(window)
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn traces_are_saved_and_come_back_with_sessions() {
    let (mut window, folder) = with_report();
    let places = two_traces(&mut window);
    let path = |name: &str| folder.path().join(name);
    run(
        &mut window,
        Command::SavePlot(PlotOf::Traces, path("t.csv")),
    );
    run(
        &mut window,
        Command::SavePlot(PlotOf::Traces, path("t.svg")),
    );
    assert_eq!(state(&mut window).messages.problems, []);
    let table = fs::read_to_string(path("t.csv")).expect("written");
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!((rows.len(), rows[0][0]), (21, "time_ms"));
    assert!(
        table
            .lines()
            .next()
            .expect("a heading")
            .contains("soma (mV)")
    );
    for (k, place) in places.iter().enumerate() {
        let values = values(&mut window, *place);
        for (i, value) in values.iter().enumerate() {
            // The names have commas, and are in quotes.
            let written: f32 = rows[i + 1][k + 1].parse().expect("a number");
            assert_eq!(
                (written, rows[i + 1][0]),
                (*value, &*(0.5 * i as f64).to_string())
            );
        }
    }
    let figure = fs::read_to_string(path("t.svg")).expect("written");
    for part in [
        "<svg",
        "time (ms)",
        "voltage (mV)",
        ", soma</text>",
        "#d55e00",
    ] {
        assert!(figure.contains(part), "{part}");
    }
    let session = path("a.neurotess");
    run(&mut window, Command::SaveSession(session.clone()));
    let before = state(&mut window).document.traces.to_vec();
    let mut other = crate::common::window();
    other.step();
    run(&mut other, Command::Open(vec![session.clone()]));
    assert_eq!(state(&mut other).document.traces.to_vec(), before);
    assert!(state(&mut other).traces.open);
    for place in &places {
        assert_eq!(values(&mut other, *place), values(&mut window, *place));
    }
    // Neurons that are removed take their traces with them.
    run(&mut other, Edit::Select(vec![0], false));
    run(&mut other, Edit::Remove);
    assert_eq!(self::places(&mut other), []);
    run(&mut other, Command::Undo);
    assert_eq!(self::places(&mut other), places);
    // Without the report, the traces wait for it.
    fs::remove_file(path("voltage.h5")).expect("removed");
    let mut third = crate::common::window();
    third.step();
    run(&mut third, Command::Open(vec![session]));
    let problems = state(&mut third).messages.problems.clone();
    assert!(problems[0].why.contains("no such report"), "{problems:?}");
    assert_eq!(self::places(&mut third), places);
    assert!(state(&mut third).trace_plot().is_empty() && viewer(&mut third).fatal.is_none());
    run(
        &mut third,
        Command::SavePlot(PlotOf::Traces, path("no.csv")),
    );
    assert!(!path("no.csv").exists());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn traces_look_as_they_should() {
    let (mut window, folder) = with_circuit();
    let neuron = write_firing(folder.path());
    run(
        &mut window,
        Edit::SetReport(Some(folder.path().join("firing.h5"))),
    );
    run(&mut window, Edit::Select(vec![neuron], false));
    run(&mut window, Edit::Isolate);
    run(&mut window, Command::Home);
    run(&mut window, Command::ShowTraces(true));
    let cell = morphology(&mut window, neuron);
    let (section, _) = along_the_longest(&cell);
    for (section, along) in [(None, 0.0), (Some(0), 0.9), (Some(section), 0.5)] {
        let place = TracePlace {
            neuron,
            section,
            along,
        };
        run(&mut window, Edit::Plot(place, true));
    }
    run(&mut window, Command::Seek(30.0));
    run(&mut window, Edit::SelectNone);
    rest(&mut window);
    snapshot(&mut window, "traces");
    run(&mut window, Command::SetDark(false));
    snapshot(&mut window, "traces_light");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_report_that_ends_early_is_told_and_what_there_is_shows() {
    let (mut window, folder) = with_report();
    let file = folder.path().join("voltage.h5");
    let whole = fs::read(&file).expect("there");
    // The disk has lost a part of the open file, in which the last frames are.
    let copy = folder.path().join("copy.h5");
    let broken = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at..at + 16].fill(0);
        bytes
    };
    let ends_early = |at: &usize| {
        fs::write(&copy, broken(*at)).expect("written");
        let Ok(report) = Report::open(&copy) else {
            return false;
        };
        let cells = &report.populations[0];
        let reads = |frame| cells.series(frame..frame + 1, &[0]).is_ok();
        reads(0) && !reads(19) && cells.compartments(0).is_ok()
    };
    let mut places = (0..whole.len() - 16).step_by(16);
    let lost = places
        .find(ends_early)
        .expect("chunks lie one after another");
    fs::write(&file, broken(lost)).expect("broken");
    let places = two_traces(&mut window);
    let read = state(&mut window)
        .traces
        .of(places[0])
        .expect("read")
        .clone();
    let why = read.problem.clone().expect("a reason");
    let problems = state(&mut window).messages.problems.clone();
    assert!(problems.iter().any(|p| p.why == why), "{problems:?}");
    let read = values(&mut window, places[0]).len();
    assert!((1..20).contains(&read), "{read}");
    // All else goes on.
    fs::write(&file, &whole).expect("whole again");
    run(&mut window, Edit::SetReport(None));
    run(&mut window, Edit::SetReport(Some(file)));
    assert_eq!(values(&mut window, places[0]).len(), 20);
    // Spikes have a row for each neuron.
    let spikes = folder.path().join("spikes.h5");
    run(&mut window, Edit::SetReport(Some(spikes)));
    let plot = state(&mut window).trace_plot();
    assert!(
        matches!(plot.series[0].data, Data::Ticks { .. }),
        "{plot:?}"
    );
    // Values are those of a report that shows.
    run(&mut window, Edit::SetReport(None));
    assert!(state(&mut window).trace_plot().is_empty());
}
