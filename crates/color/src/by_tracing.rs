//! Colors by what is in a tracing: types, neurites, sections, numbers along the path.

use std::collections::BTreeMap;

use neurotess_mesh::{Role, TracingPoint};
use neurotess_morphology::{Morphology, NeuriteKind, shape};
use neurotess_picture::color::{ColorTable, category, fraction};
use neurotess_picture::overlay::Legend;

use crate::own_colors::ColoredThing;
use crate::path_distance::path_distances;
use crate::scheme::{Cell, ColorScheme, Coloring};

/// What cells are colored by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// SWC type.
    #[default]
    Type,
    /// A color for each neurite.
    Neurite,
    /// Neighboring sections differ.
    Section,
    /// Number of forks from the neurite's start.
    BranchOrder,
    /// Radius (µm).
    Radius,
    /// Distance along the neurite from its start (µm).
    PathDistance,
    /// A color for each cell.
    Neuron,
}

/// A number that tracing points have.
struct Quantity {
    title: &'static str,
    unit: &'static str,
    span: Span,
}

/// Numbers at the ends of the scale, unless the scheme sets them.
enum Span {
    /// 0 and the greatest.
    FromZero,
    /// The least number and the 98th percentile: with outliers, all other points would have nearly
    /// the same color.
    WithoutOutliers,
}

const BRANCH_ORDER: Quantity = Quantity {
    title: "branch order",
    unit: "",
    span: Span::FromZero,
};
/// Radius: without outliers, since a few stems are far thicker than all else.
const RADIUS: Quantity = Quantity {
    title: "radius",
    unit: "µm",
    span: Span::WithoutOutliers,
};
const PATH_DISTANCE: Quantity = Quantity {
    title: "path distance",
    unit: "µm",
    span: Span::FromZero,
};

/// Colors of cells by what is in their tracings.
pub fn coloring(cells: &[Cell<'_>], by: ColorBy, scheme: &ColorScheme) -> Coloring {
    match by {
        ColorBy::Type => by_type(cells, scheme),
        ColorBy::Neuron => by_neuron(cells, scheme),
        ColorBy::Neurite => categorical(cells, scheme, "neurite", shape::neurites),
        ColorBy::Section => categorical(cells, scheme, "section", sections),
        ColorBy::BranchOrder => continuous(cells, scheme, &BRANCH_ORDER, branch_orders),
        ColorBy::Radius => continuous(cells, scheme, &RADIUS, radii),
        ColorBy::PathDistance => continuous(cells, scheme, &PATH_DISTANCE, path_distances),
    }
}

fn by_type(cells: &[Cell<'_>], scheme: &ColorScheme) -> Coloring {
    // The soma's points have the soma's type, whatever the file says.
    let kind = |point: &TracingPoint| match point.role {
        Role::Soma => NeuriteKind::SOMA.0,
        _ => point.kind.0,
    };
    let mut kinds: BTreeMap<i32, u32> = BTreeMap::new();
    for point in cells.iter().flat_map(|cell| &cell.mesh.tracing) {
        kinds.insert(kind(point), 0);
    }
    for (index, number) in kinds.values_mut().zip(0..) {
        *index = number;
    }
    let color_keys = |cell: &Cell<'_>| {
        let points = cell.mesh.tracing.iter();
        points.map(|point| category(kinds[&kind(point)])).collect()
    };
    let things: Vec<ColoredThing> = kinds
        .keys()
        .map(|&kind| scheme.thing_of_type(kind))
        .collect();
    let entries = things
        .iter()
        .map(|thing| (thing.color, thing.target.to_string()));
    let categories = things.iter().map(|thing| thing.color).collect();
    Coloring {
        color_keys: cells.iter().map(color_keys).collect(),
        legend: Legend::swatches("", entries),
        things,
        table: ColorTable {
            scale: Vec::new(),
            categories,
            ..ColorTable::default()
        },
    }
}

fn by_neuron(cells: &[Cell<'_>], scheme: &ColorScheme) -> Coloring {
    let color_keys = |(cell, index)| {
        let cell: &Cell<'_> = cell;
        vec![category(index); cell.mesh.tracing.len()]
    };
    let names: Vec<String> = cells.iter().map(|cell| cell.name.to_owned()).collect();
    listed(
        cells.iter().zip(0..).map(color_keys).collect(),
        &names,
        "neuron",
        scheme,
    )
}

/// Colors of things that are numbered from 0 on in each cell, different for all cells; somata have
/// a color of their own.
fn categorical(
    cells: &[Cell<'_>],
    scheme: &ColorScheme,
    thing: &str,
    number: impl Fn(&Morphology) -> Vec<u32>,
) -> Coloring {
    let mut next = 0;
    let mut color_keys = Vec::new();
    for cell in cells {
        let numbers = number(cell.morphology);
        let of_point = |point: &TracingPoint| {
            let section = point.section.index();
            let number = section.and_then(|section| numbers.get(section));
            // 0 is the soma.
            number.map_or(category(0), |number| category(1 + next + number))
        };
        color_keys.push(cell.mesh.tracing.iter().map(of_point).collect());
        next += numbers.iter().max().map_or(0, |most| most + 1);
    }
    let soma = scheme.thing_of_type(NeuriteKind::SOMA.0);
    let names: Vec<String> = (1..=next).map(|n| format!("{thing} {n}")).collect();
    let mut coloring = listed(color_keys, &names, thing, scheme);
    coloring.table.categories.insert(0, soma.color);
    coloring.things.insert(0, soma);
    coloring
}

/// A coloring in which category i has the i-th distinct color and the i-th name.
fn listed(
    color_keys: Vec<Vec<u32>>,
    names: &[String],
    thing: &str,
    scheme: &ColorScheme,
) -> Coloring {
    let things = scheme.distinct(names);
    let (title, entries) = scheme.listed(&things, "", &format!("{thing}s"));
    Coloring {
        color_keys,
        legend: Legend::swatches(&title, entries),
        table: ColorTable {
            scale: Vec::new(),
            categories: things.iter().map(|thing| thing.color).collect(),
            ..ColorTable::default()
        },
        things,
    }
}

fn sections(morphology: &Morphology) -> Vec<u32> {
    (0..morphology.sections.len() as u32).collect()
}

/// Numbers on a scale; points without one have the soma's color.
fn continuous(
    cells: &[Cell<'_>],
    scheme: &ColorScheme,
    quantity: &Quantity,
    values: impl Fn(&Cell<'_>) -> Vec<Option<f32>>,
) -> Coloring {
    let values: Vec<Vec<Option<f32>>> = cells.iter().map(&values).collect();
    let mut sorted: Vec<f32> = values.iter().flatten().flatten().copied().collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let at = |share: f64| {
        let index = share * sorted.len().saturating_sub(1) as f64;
        sorted.get(index as usize).copied().unwrap_or(0.0)
    };
    let [low, high] = scheme.range.unwrap_or(match quantity.span {
        Span::FromZero => [0.0, at(1.0)],
        Span::WithoutOutliers => [at(0.0), at(0.98)],
    });
    let high = if high > low { high } else { low + 1.0 };
    let color_key = |value: &Option<f32>| match value {
        Some(value) => fraction((value - low) / (high - low)),
        None => category(0),
    };
    let color_keys = values
        .iter()
        .map(|values| values.iter().map(color_key).collect());
    Coloring {
        color_keys: color_keys.collect(),
        legend: Legend::bar(
            quantity.title,
            quantity.unit,
            scheme.scale.clone(),
            [low, high],
            at(1.0) > high,
        ),
        table: ColorTable {
            scale: scheme.scale.clone(),
            categories: vec![scheme.of_type(NeuriteKind::SOMA.0)],
            ..ColorTable::default()
        },
        things: vec![scheme.thing_of_type(NeuriteKind::SOMA.0)],
    }
}

fn branch_orders(cell: &Cell<'_>) -> Vec<Option<f32>> {
    let orders = shape::branch_orders(cell.morphology);
    let of_point = |point: &TracingPoint| {
        let section = point.section.index();
        section.and_then(|section| orders.get(section).map(|&order| order as f32))
    };
    cell.mesh.tracing.iter().map(of_point).collect()
}

fn radii(cell: &Cell<'_>) -> Vec<Option<f32>> {
    let traced = |radius: f32| (f64::from(radius) / cell.radius_factor) as f32;
    let radius = |point: &TracingPoint| (point.role != Role::Soma).then(|| traced(point.radius));
    cell.mesh.tracing.iter().map(radius).collect()
}

#[cfg(test)]
mod tests {
    use neurotess_picture::color::Palette;

    use super::*;
    use crate::own_colors::{ColorTarget, OwnColors};

    /// Colors of a stem far thicker than the rest of a neurite.
    fn colored(by: ColorBy, own_colors: OwnColors) -> Coloring {
        let row = |i: i32| format!("{i} 3 0 {} 0 {} {}\n", 10 * i, 0.5, i - 1);
        let text: String = ["1 1 0 0 0 5 -1\n".into(), "2 3 0 20 0 4 1\n".into()]
            .into_iter()
            .chain((3..200).map(row))
            .collect();
        let read = neurotess_formats::swc::read_bytes(text.as_bytes(), "cell", &Default::default());
        let morphology = read.expect("a cell").morphology;
        let generated = neurotess_generate::generate(&morphology, &Default::default());
        let cell = Cell {
            name: "",
            morphology: &morphology,
            mesh: &generated.expect("meshed").mesh,
            radius_factor: 1.0,
        };
        let scheme = ColorScheme {
            palette: Palette::NeuroM,
            own_colors,
            background: None,
            scale: vec![[0; 3], [255; 3]],
            range: None,
        };
        coloring(&[cell], by, &scheme)
    }

    #[test]
    fn own_colors_are_in_the_table_the_legend_and_the_list() {
        let mut own = OwnColors::default();
        own.set_named("basal dendrite", [1, 2, 3]);
        own.set_named("neurite 1", [4, 5, 6]);
        own.set_named("soma", [7, 8, 9]);
        let types = colored(ColorBy::Type, own.clone());
        assert_eq!(types.table.categories, [[7, 8, 9], [1, 2, 3]]);
        let legend = [
            ([7, 8, 9], "soma".into()),
            ([1, 2, 3], "basal dendrite".into()),
        ];
        assert_eq!(types.legend.entries(), legend);
        assert_eq!(types.things[1].target, ColorTarget::Type(3));
        let neurites = colored(ColorBy::Neurite, own.clone());
        assert_eq!(neurites.table.categories, [[7, 8, 9], [4, 5, 6]]);
        assert_eq!(neurites.legend.entries(), [([4, 5, 6], "neurite 1".into())]);
        // Somata on a scale of numbers have no entry in the legend.
        let numbers = colored(ColorBy::PathDistance, own);
        assert_eq!(numbers.table.categories, [[7, 8, 9]]);
        assert_eq!(numbers.things[0].target, ColorTarget::Type(1));
        assert!(numbers.legend.entries().is_empty());
    }

    #[test]
    fn a_thick_stem_does_not_take_the_scale_of_radii() {
        let scale = vec![[0; 3], [255; 3]];
        let bar = |title, unit, range, above| Legend::bar(title, unit, scale.clone(), range, above);
        let radii = bar("radius", "µm", [0.5, 0.5 + 1.0], true);
        let legend = |by| colored(by, OwnColors::default()).legend;
        assert_eq!(legend(ColorBy::Radius), radii);
        let orders = bar("branch order", "", [0.0, 1.0], false);
        assert_eq!(legend(ColorBy::BranchOrder), orders);
    }
}
