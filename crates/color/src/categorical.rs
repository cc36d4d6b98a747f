//! Neurons with a color each, which is the value of the instance: neurons of one cell share its keys.

use std::collections::HashMap;

use neurotess_picture::color::{ColorTable, InstanceValues, Rgb};
use neurotess_picture::overlay::Legend;

use crate::own_colors::{ColorTarget, ColoredThing};
use crate::scheme::{Cell, ColorScheme, Coloring, NOTHING};

/// Different colors, in the order in which they were first asked for.
#[derive(Default)]
pub(crate) struct Distinct {
    pub(crate) colors: Vec<Rgb>,
    indices: HashMap<Rgb, usize>,
}

impl Distinct {
    pub(crate) fn index(&mut self, color: Rgb) -> usize {
        *self.indices.entry(color).or_insert_with(|| {
            self.colors.push(color);
            self.colors.len() - 1
        })
    }
}

/// Neurons with a color for each of these names. `own`: the index of each neuron's name.
pub(crate) fn categorical(
    cells: &[Cell<'_>],
    own: &[Option<usize>],
    names: &[String],
    thing: &str,
    scheme: &ColorScheme,
) -> Coloring {
    let mut things = scheme.distinct(names);
    let title = if thing == "neuron" { "" } else { thing };
    let (title, mut entries) = scheme.listed(&things, title, &format!("{thing}s"));
    let mut colors = Distinct::default();
    let indices: Vec<usize> = things
        .iter()
        .map(|thing| colors.index(thing.color))
        .collect();
    let mut without = NOTHING;
    if own.contains(&None) {
        let target = ColorTarget::Category("none".into());
        without = scheme.own_colors.get(&target).unwrap_or(NOTHING);
        let none = ColoredThing {
            target,
            color: without,
        };
        if !entries.is_empty() {
            entries.push((none.color, none.target.to_string()));
        }
        things.push(none);
    }
    let own: Vec<Option<usize>> = own.iter().map(|own| own.map(|n| indices[n])).collect();
    let mut coloring = painted(
        cells,
        &own,
        colors.colors,
        Legend::swatches(&title, entries),
    );
    coloring.table.categories = vec![without];
    coloring.things = things;
    coloring
}

/// Neurons with these colors. `own`: the index of each neuron's color.
pub(crate) fn painted(
    cells: &[Cell<'_>],
    own: &[Option<usize>],
    colors: Vec<Rgb>,
    legend: Legend,
) -> Coloring {
    let last = (colors.len().max(2) - 1) as f32;
    let mut values = InstanceValues::default();
    for number in own {
        values.push(&[number.map_or(f32::NAN, |n| n as f32 / last)]);
    }
    Coloring {
        color_keys: first_values(cells),
        legend,
        table: ColorTable {
            scale: colors,
            categories: vec![NOTHING],
            values,
        },
        things: Vec::new(),
    }
}

/// Color keys by which every point has the first value of its neuron.
pub(crate) fn first_values(cells: &[Cell<'_>]) -> Vec<Vec<u32>> {
    let points = cells.iter().map(|cell| cell.mesh.tracing.len());
    points.map(|points| vec![0; points]).collect()
}
