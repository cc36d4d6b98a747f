//! Dimensions as numbers for the clipboard: separated by tabs, as spreadsheets take them.

use super::State;
use crate::model::document::Dimension;
use crate::model::measuring::{Figure, Measured};

const COLUMNS: [&str; 12] = [
    "kind",
    "neuron",
    "sample",
    "neuron_2",
    "sample_2",
    "distance_um",
    "path_um",
    "path_in_soma_um",
    "tortuosity",
    "forks",
    "diameter_um",
    "angles_deg",
];

/// The numbers of a dimension, on one line.
pub(crate) fn numbers(figure: &Figure) -> String {
    let numbers = figure.measured.numbers().into_iter().map(number);
    numbers.collect::<Vec<_>>().join("\t")
}

/// A table of all dimensions that are there, with a heading.
pub(crate) fn table(state: &State) -> String {
    let mut lines = vec![COLUMNS.join("\t")];
    let figures = state.figures();
    for (dimension, figure) in state.document.dimensions.iter().zip(figures.iter()) {
        if let Some(figure) = figure {
            lines.push(row(state, dimension, figure).join("\t"));
        }
    }
    lines.join("\n") + "\n"
}

fn row(state: &State, dimension: &Dimension, figure: &Figure) -> Vec<String> {
    let mut fields = vec![String::new(); COLUMNS.len()];
    let mut set = |name: &str, value: String| {
        if let Some(column) = COLUMNS.iter().position(|known| *known == name) {
            // Names of neurons may have any letter.
            fields[column] = value.replace(['\t', '\n', '\r'], " ");
        }
    };
    let names = [("neuron", "sample"), ("neuron_2", "sample_2")];
    for (anchor, (neuron, sample)) in dimension.anchors().zip(names) {
        if let Some(named) = state.document.neurons.get(anchor.neuron) {
            set(neuron, named.name.clone());
        }
        if let Some(id) = state.sample_of(anchor) {
            set(sample, id.to_string());
        }
    }
    match &figure.measured {
        Measured::Distance { straight, path } => {
            set("kind", "distance".into());
            set("distance_um", number(*straight));
            if let Some(path) = path {
                set("path_um", number(path.length));
                set("path_in_soma_um", number(path.soma_length));
                set("tortuosity", path.tortuosity.map_or(String::new(), number));
                set("forks", path.forks.to_string());
            }
        }
        Measured::Diameter(diameter) => {
            set("kind", "diameter".into());
            set("diameter_um", number(*diameter));
        }
        Measured::Angle { .. } => {
            set("kind", "angle".into());
            set("angles_deg", numbers(figure).replace('\t', " "));
        }
    }
    fields
}

/// As precise as tracings are: they have `f32`.
fn number(number: f64) -> String {
    let text = format!("{number:.4}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    short.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_needless_zeros() {
        assert_eq!([12.0, 0.5, 1.0 / 3.0].map(number), ["12", "0.5", "0.3333"]);
    }
}
