//! The list of dimensions in *Inspect*.

use eframe::egui::{Button, Label, RichText, Ui};

use crate::model::command::{Command, Edit};
use crate::model::document::{Anchor, Dimension};
use crate::model::measuring::{Figure, Measured};
use crate::model::state::State;
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{heading, measured};

/// Shows the list, if there is something in it or measuring is on.
pub(crate) fn show(state: &mut State, ui: &mut Ui) {
    let on = state.tools.measuring.is_some();
    if !on && state.document.dimensions.is_empty() {
        return;
    }
    heading(ui, "Dimensions");
    ui.horizontal_wrapped(|ui| {
        let title = if on { "Stop measuring" } else { "Measure" };
        let tip = "Distances, paths, diameters and angles, by clicks in the picture (M)";
        let mut commands = vec![(title, Command::SetMeasuring(!on), tip)];
        if !state.document.dimensions.is_empty() {
            let copy = "Copy a table of all, separated by tabs, for a spreadsheet (Ctrl Shift C)";
            commands.push(("Copy all", Command::CopyDimensions(None), copy));
            let clear = "Remove all dimensions from the picture";
            commands.push(("Clear", Edit::ClearDimensions.into(), clear));
        }
        for (title, command, says) in commands {
            if ui.button(title).tip(says).clicked() {
                state.requests.push(command);
            }
        }
    });
    if state.document.dimensions.is_empty() {
        ui.weak("Nothing is kept yet.");
    }
    let figures = state.figures();
    for (index, figure) in figures.iter().enumerate() {
        let Some(&dimension) = state.document.dimensions.get(index) else {
            break;
        };
        row(state, index, dimension, figure.as_ref(), ui);
    }
    ui.add_space(4.0);
    ui.separator();
}

fn row(
    state: &mut State,
    index: usize,
    dimension: Dimension,
    figure: Option<&Figure>,
    ui: &mut Ui,
) {
    let shown = ui.scope(|ui| {
        ui.horizontal(|ui| {
            let text = figure.map_or_else(|| "not there".into(), |f| f.label.join(" · "));
            let text = RichText::new(text).strong();
            ui.label(match figure.is_some() && state.shows(&dimension) {
                true => text,
                false => text.weak(),
            });
            let small = |text| Button::new(text).small();
            let copy = ui.add_enabled(figure.is_some(), small("Copy"));
            if copy.tip("Copy the numbers, separated by tabs").clicked() {
                state.requests.push(Command::CopyDimensions(Some(index)));
            }
            let delete = ui.add(small("Delete"));
            if delete.tip("Remove it from the picture").clicked() {
                state.requests.push(Edit::RemoveDimension(index).into());
            }
        });
        let details = RichText::new(details(state, dimension, figure)).size(11.0);
        ui.add(Label::new(details.weak()).wrap());
    });
    if shown.response.contains_pointer() {
        state.pointing.dimension = Some(index);
    }
}

fn details(state: &State, dimension: Dimension, figure: Option<&Figure>) -> String {
    let neurons = &state.document.neurons;
    let name = |a: Anchor| neurons.get(a.neuron).map_or("", |n| &n.name).to_owned();
    let sample = |a: Anchor| {
        state
            .sample_of(a)
            .map_or(String::new(), |id| id.to_string())
    };
    let Some(figure) = figure else {
        return "The tracing has changed there, or is no longer open.".into();
    };
    match (dimension, &figure.measured) {
        (Dimension::Distance { from, to }, Measured::Distance { path, .. }) => {
            let ends = match from.neuron == to.neuron {
                true => format!(
                    "{}, samples {} and {}",
                    name(from),
                    sample(from),
                    sample(to)
                ),
                false => {
                    let end = |a| format!("{}, sample {}", name(a), sample(a));
                    format!("{}; {}", end(from), end(to))
                }
            };
            let Some(path) = path else {
                return ends;
            };
            let mut parts = vec![ends];
            if let Some(tortuosity) = path.tortuosity {
                parts.push(format!("tortuosity {tortuosity:.2}"));
            }
            parts.push(crate::ui::panels::cells::count(path.forks, "fork"));
            if path.soma_length > 0.0 {
                parts.push(format!(
                    "{} of it in the soma",
                    measured(path.soma_length, "µm")
                ));
            }
            parts.join("; ")
        }
        (Dimension::Diameter { at }, _) => format!("{}, sample {}: diameter", name(at), sample(at)),
        (Dimension::Angle { at }, _) => {
            let what = "angle of the fork, and to the ends of its branches";
            format!("{}, sample {}: {what}", name(at), sample(at))
        }
        _ => name_of(dimension, name),
    }
}

fn name_of(dimension: Dimension, name: impl Fn(Anchor) -> String) -> String {
    dimension.anchors().map(name).collect::<Vec<_>>().join("; ")
}
