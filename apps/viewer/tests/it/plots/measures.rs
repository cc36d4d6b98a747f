//! Measures of the selected cells.

use std::fs;

use neurotess::morphology::sholl;
use neurotess::plot::{Data, Measure, Plot};
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, PlotOf, Tab};
use neurotess_viewer::plots::MeasureForm;

use super::traces::morphology;
use crate::common::{Window, gpu, rest, run, snapshot, state, with_samples};

fn plot_of(window: &mut Window, measure: Measure) -> Plot {
    let form = MeasureForm {
        measure: Some(measure),
        step: 25.0,
    };
    run(window, Command::PlotMeasure(form));
    let state = state(window);
    let (plot, current) = state.measure_plot().expect("computed");
    assert!(current);
    Plot::clone(plot.expect("few spheres"))
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn measures_of_selected_cells_are_plotted_and_saved() {
    let mut window = with_samples(&[Kind::Pyramidal, Kind::Granule]);
    run(&mut window, Edit::SelectAll);
    let plot = plot_of(&mut window, Measure::Sholl);
    assert_eq!(plot.series.len(), 2);
    for (neuron, series) in plot.series.iter().enumerate() {
        let cell = morphology(&mut window, neuron);
        let sections = 0..cell.sections.len() as u32;
        let crossings = sholl::crossings(&cell, 25.0, sections).expect("few");
        let Data::Line(points) = &series.data else {
            panic!("{series:?}");
        };
        let counts: Vec<u64> = points.iter().map(|point| point[1] as u64).collect();
        assert_eq!((counts, points[1][0]), (crossings, 50.0));
    }
    rest(&mut window);
    snapshot(&mut window, "sholl");
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    for name in ["sholl.csv", "sholl.svg"] {
        run(&mut window, Command::SavePlot(PlotOf::Measure, path(name)));
    }
    let table = fs::read_to_string(path("sholl.csv")).expect("written");
    assert_eq!(table, plot.csv());
    let figure = fs::read_to_string(path("sholl.svg")).expect("written");
    assert_eq!(figure, plot.svg([900, 480]));
    // One cell: the others of its plots.
    run(&mut window, Edit::Select(vec![0], false));
    let ends = state(&mut window)
        .source_of(0)
        .expect("open")
        .measures
        .n_ends;
    let Data::Spans(bars) = &plot_of(&mut window, Measure::Barcode).series[0].data else {
        panic!("bars");
    };
    assert_eq!(bars.len(), ends);
    // It names a folder of this run.
    state(&mut window).messages.status.clear();
    snapshot(&mut window, "barcode");
    for (measure, _) in Measure::ALL {
        let plot = plot_of(&mut window, measure);
        assert!(!plot.is_empty(), "{measure:?}");
    }
    run(&mut window, Command::Show(Tab::Inspect));
    // Closed again, it is gone.
    run(&mut window, Command::PlotMeasure(MeasureForm::default()));
    assert!(state(&mut window).measure_plot().is_none());
}
