//! Colors by what a tracing says: types, neurites, sections, numbers along the path.

use std::collections::{BTreeMap, HashMap};

use neurotess_mesh::{CoarseMesh, Role, TracingPoint};
use neurotess_morphology::{Morphology, NeuriteKind, Section, SectionId, shape};
use neurotess_render::{ColorTable, Legend, Palette, Rgb, category, fraction};

/// What colors tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// SWC type.
    #[default]
    Type,
    /// Every neurite its own.
    Neurite,
    /// Neighboring sections differ.
    Section,
    /// Number of forks from the neurite's start.
    BranchOrder,
    /// Radius (µm).
    Radius,
    /// Distance along the neurite from its start (µm).
    PathDistance,
    /// Every cell its own.
    Neuron,
}

/// What is colored.
#[derive(Clone, Copy, Debug)]
pub struct Cell<'c> {
    /// Name for the legend.
    pub name: &'c str,
    /// The tracing.
    pub morphology: &'c Morphology,
    /// Its coarse mesh.
    pub mesh: &'c CoarseMesh,
}

/// Colors of all cells.
#[derive(Clone, Debug)]
pub struct Coloring {
    /// By cell and tracing point.
    pub color_keys: Vec<Vec<u32>>,
    /// What color_keys mean.
    pub table: ColorTable,
    /// What colors mean.
    pub legend: Legend,
}

/// The colors to choose from.
#[derive(Clone, Debug)]
pub struct ColorScheme {
    /// Of types and of what is merely told apart.
    pub palette: Palette,
    /// Behind everything: black is not drawn on black.
    pub background: Option<Rgb>,
    /// Of numbers.
    pub scale: Vec<Rgb>,
    /// Numbers at both ends of the scale; none: those that fit.
    pub range: Option<[f32; 2]>,
}

/// Color of what has no value: a gray that no scale has.
pub const NOTHING: Rgb = [160; 3];

impl ColorScheme {
    /// Words on the scale, from one number to another; the first category is for what has none.
    pub fn scaled(
        &self,
        color_keys: Vec<Vec<u32>>,
        title: &str,
        unit: &str,
        range: [f32; 2],
    ) -> Coloring {
        Coloring {
            color_keys,
            legend: Legend::bar(title, unit, self.scale.clone(), range, false),
            table: ColorTable {
                scale: self.scale.clone(),
                categories: vec![NOTHING],
                ..ColorTable::default()
            },
        }
    }

    fn of_type(&self, kind: i32) -> Rgb {
        match NeuriteKind(kind) {
            NeuriteKind::SOMA => self.palette.of_soma(self.background),
            _ => self.palette.of_type(kind),
        }
    }
}

/// Chooses the colors.
pub fn coloring(cells: &[Cell<'_>], by: ColorBy, scheme: &ColorScheme) -> Coloring {
    match by {
        ColorBy::Type => by_type(cells, scheme),
        ColorBy::Neuron => by_neuron(cells, scheme),
        ColorBy::Neurite => categorical(cells, scheme, "neurite", shape::neurites),
        ColorBy::Section => categorical(cells, scheme, "section", sections),
        ColorBy::BranchOrder => continuous(cells, scheme, "branch order", "", |cell| {
            let orders = shape::branch_orders(cell.morphology);
            of_sections(cell, |section| orders.get(section).map(|&o| o as f32))
        }),
        ColorBy::Radius => continuous(cells, scheme, "radius", "µm", |cell| {
            let radius = |point: &TracingPoint| (point.role != Role::Soma).then_some(point.radius);
            cell.mesh.tracing.iter().map(radius).collect()
        }),
        ColorBy::PathDistance => continuous(cells, scheme, "path distance", "µm", path_distances),
    }
}

fn by_type(cells: &[Cell<'_>], scheme: &ColorScheme) -> Coloring {
    // The soma's points keep a type of their own whatever the file says.
    let kind = |point: &TracingPoint| match point.role {
        Role::Soma => NeuriteKind::SOMA.0,
        _ => point.kind,
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
    let categories: Vec<Rgb> = kinds.keys().map(|&kind| scheme.of_type(kind)).collect();
    let names = kinds
        .keys()
        .map(|&kind| NeuriteKind(kind).name().replace('_', " "));
    Coloring {
        color_keys: cells.iter().map(color_keys).collect(),
        legend: Legend::swatches("", categories.iter().copied().zip(names)),
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

/// Things numbered from 0 on over all cells; somata have a color of their own.
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
            let section = usize::try_from(point.section - 1).ok();
            let number = section.and_then(|section| numbers.get(section));
            // 0 is the soma.
            number.map_or(category(0), |number| category(1 + next + number))
        };
        color_keys.push(cell.mesh.tracing.iter().map(of_point).collect());
        next += numbers.iter().max().map_or(0, |most| most + 1);
    }
    let soma = scheme.of_type(1);
    let names: Vec<String> = (1..=next).map(|n| format!("{thing} {n}")).collect();
    let mut coloring = listed(color_keys, &names, thing, scheme);
    coloring.table.categories.insert(0, soma);
    coloring
}

/// Category i has the i-th distinct color and name.
fn listed(
    color_keys: Vec<Vec<u32>>,
    names: &[String],
    thing: &str,
    scheme: &ColorScheme,
) -> Coloring {
    let categories: Vec<Rgb> = (0..names.len())
        .map(|i| scheme.palette.distinct(i))
        .collect();
    let mut entries: Vec<(Rgb, String)> = categories
        .iter()
        .copied()
        .zip(names.iter().cloned())
        .collect();
    let title = if entries.len() > scheme.palette.distinct_count() {
        entries.clear();
        format!("{} {thing}s, colors repeat", names.len())
    } else {
        String::new()
    };
    Coloring {
        color_keys,
        legend: Legend::swatches(&title, entries),
        table: ColorTable {
            scale: Vec::new(),
            categories,
            ..ColorTable::default()
        },
    }
}

fn sections(morphology: &Morphology) -> Vec<u32> {
    (0..morphology.sections.len() as u32).collect()
}

/// Numbers on a scale; points without one have the soma's color.
fn continuous(
    cells: &[Cell<'_>],
    scheme: &ColorScheme,
    title: &str,
    unit: &str,
    values: impl Fn(&Cell<'_>) -> Vec<Option<f32>>,
) -> Coloring {
    let values: Vec<Vec<Option<f32>>> = cells.iter().map(&values).collect();
    let mut sorted: Vec<f32> = values.iter().flatten().flatten().copied().collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let at = |share: f64| {
        let place = share * sorted.len().saturating_sub(1) as f64;
        sorted.get(place as usize).copied().unwrap_or(0.0)
    };
    // A few stems are far thicker than all else: they would leave one color for the rest.
    let whole = title != "radius";
    let (low, high) = if whole {
        (0.0, at(1.0))
    } else {
        (at(0.0), at(0.98))
    };
    let [low, high] = scheme.range.unwrap_or([low, high]);
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
            title,
            unit,
            scheme.scale.clone(),
            [low, high],
            at(1.0) > high,
        ),
        table: ColorTable {
            scale: scheme.scale.clone(),
            categories: vec![scheme.of_type(1)],
            ..ColorTable::default()
        },
    }
}

fn of_sections(cell: &Cell<'_>, value: impl Fn(usize) -> Option<f32>) -> Vec<Option<f32>> {
    let of_point = |point: &TracingPoint| {
        let section = usize::try_from(point.section - 1).ok();
        section.and_then(&value)
    };
    cell.mesh.tracing.iter().map(of_point).collect()
}

/// Distance along the path (µm) along the neurite from its first point to each tracing point.
pub fn path_distances(cell: &Cell<'_>) -> Vec<Option<f32>> {
    let morphology = cell.morphology;
    let ends = shape::path_lengths(morphology);
    let mut of_sample: HashMap<i64, f32> = HashMap::new();
    for (index, section) in morphology.sections.iter().enumerate() {
        let start = section.parent().map_or(0.0, |parent| ends[parent.index()]);
        along(morphology, index, section, start, &mut of_sample);
    }
    let of_point = |point: &TracingPoint| match point.role {
        Role::Soma => None,
        _ => Some(
            of_sample
                .get(&i64::from(point.sample))
                .copied()
                .unwrap_or(0.0),
        ),
    };
    cell.mesh.tracing.iter().map(of_point).collect()
}

fn along(
    morphology: &Morphology,
    index: usize,
    section: &Section,
    start: f64,
    of_sample: &mut HashMap<i64, f32>,
) {
    let id = SectionId(index as u32);
    let mut before = shape::branch_point(morphology, id);
    let mut way = start;
    for (point, sample) in morphology.points[section.range()]
        .iter()
        .zip(&morphology.sample_ids[section.range()])
    {
        if let Some(before) = before {
            way += f64::from(point.position.distance(before.position));
        }
        before = Some(point);
        of_sample.insert(*sample, way as f32);
    }
}
