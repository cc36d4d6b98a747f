//! What colours tell, as the options say.

use std::path::Path;

use neurotess::colouring::{self, ColourBy};
pub(crate) use neurotess::colouring::{Colouring, NOTHING, Paint};

use super::args::{ColorBy, RenderArgs};
use super::by_node;
use super::cells::Cell;
use super::values::{self, Shown};
use crate::report::Reporter;

/// Chooses the colours. `shown`: what a circuit shows; `places`: the cell at each.
///
/// # Errors
/// What is wrong with a report.
pub(crate) fn colouring(
    cells: &[&Cell],
    shown: Option<&Shown>,
    places: &[usize],
    args: &RenderArgs,
    reporter: &Reporter,
) -> anyhow::Result<Colouring> {
    let background = (!args.transparent).then_some(args.background.0);
    let paint = Paint {
        palette: args.palette,
        background,
        scale: args.colormap.scale(background),
    };
    if let (Some(report), Some(shown)) = (&args.report, shown) {
        return values::colouring((cells, shown), places, report, (args, &paint), reporter);
    }
    if let Some(shown) = shown {
        match (&args.color_by_attribute, args.color_by) {
            (Some(attribute), _) => return by_node::by_attribute(cells, shown, attribute, &paint),
            (None, Some(ColorBy::Neuron)) => return Ok(by_node::each(cells, shown, &paint)),
            (None, None) => {
                if let Some(colouring) = by_node::given(cells, shown) {
                    return Ok(colouring);
                }
            }
            (None, Some(_)) => {}
        }
    }
    let names: Vec<String> = cells
        .iter()
        .map(|cell| {
            let stem = Path::new(&cell.file).file_stem().unwrap_or_default();
            stem.to_string_lossy().into_owned()
        })
        .collect();
    let cells: Vec<colouring::Cell<'_>> = cells
        .iter()
        .zip(&names)
        .map(|(cell, name)| seen(cell, name))
        .collect();
    let by = by(args.color_by.unwrap_or(ColorBy::Type));
    Ok(colouring::colouring(&cells, by, &paint))
}

/// Way (µm) along the neurite from its first point to each tracing point.
pub(crate) fn depths(cell: &Cell) -> Vec<Option<f32>> {
    colouring::depths(&seen(cell, ""))
}

fn seen<'c>(cell: &'c Cell, name: &'c str) -> colouring::Cell<'c> {
    colouring::Cell {
        name,
        morphology: &cell.morphology,
        mesh: &cell.mesh,
    }
}

fn by(what: ColorBy) -> ColourBy {
    match what {
        // Arguments have been checked: a value comes with a report.
        ColorBy::Type | ColorBy::Value => ColourBy::Type,
        ColorBy::Neurite => ColourBy::Neurite,
        ColorBy::Section => ColourBy::Section,
        ColorBy::Order => ColourBy::Order,
        ColorBy::Radius => ColourBy::Radius,
        ColorBy::Depth => ColourBy::Depth,
        ColorBy::Neuron => ColourBy::Neuron,
    }
}
