//! The numbers of tracings as rows: one for a cell, a neurite, a section or a bar of the persistence barcode.
//!
//! Columns have NeuroM's names of features, with the statistic before it where there is one for many values
//! (`mean_section_lengths`), as in NeuroM's `morph_stats`. docs/tracings.md says what each is.

use std::ops::Range;

use clap::ValueEnum;
use glam::DVec3;
use neurotess::morphology::barcode::barcode;
use neurotess::morphology::{Measures, Morphology, SectionId, shape, sholl};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// What a row is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Per {
    /// A row for each tracing
    Cell,
    /// A row for each neurite
    Neurite,
    /// A row for each section
    Section,
    /// A row for each bar of the persistence barcode: one for each end
    Bar,
}

/// A field of a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Value {
    Text(String),
    Count(i64),
    /// None where there is no such number.
    Number(Option<f64>),
}

/// A row: names of columns and their values, and crossings of spheres if they are asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) fields: Vec<(&'static str, Value)>,
    pub(super) sholl: Option<Vec<u64>>,
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (name, value) in &self.fields {
            map.serialize_entry(name, value)?;
        }
        if let Some(sholl) = &self.sholl {
            map.serialize_entry("sholl_crossings", sholl)?;
        }
        map.end()
    }
}

/// The rows of a tracing without its file. `step` (µm) of spheres, for cells and neurites.
pub(super) fn rows(
    morphology: &Morphology,
    per: Per,
    step: Option<f64>,
) -> Result<Vec<Row>, sholl::TooManySpheres> {
    let numbers = Numbers::of(morphology);
    match per {
        Per::Cell => Ok(vec![numbers.cell(step)?]),
        Per::Neurite => (0..numbers.roots.len() as u32)
            .map(|neurite| numbers.neurite(neurite, step))
            .collect(),
        Per::Section => Ok((0..morphology.sections.len())
            .map(|section| without_spheres(numbers.section(section)))
            .collect()),
        Per::Bar => Ok(numbers.bars()),
    }
}

/// The columns of a row.
pub(super) fn columns(per: Per) -> Vec<&'static str> {
    use neurotess::morphology::{NeuriteKind, Node};
    let node = Node {
        id: 1,
        kind: NeuriteKind::AXON,
        position: DVec3::ZERO,
        radius: 1.0,
        parent: None,
        section: None,
    };
    // Any tracing with a section has all columns.
    let one = Morphology::from_nodes("", Vec::new(), &[node]);
    let rows = one.map(|built| rows(&built.morphology, per, None).unwrap_or_default());
    let names = |row: &Row| row.fields.iter().map(|(name, _)| *name).collect();
    rows.ok()
        .as_deref()
        .and_then(<[Row]>::first)
        .map_or_else(Vec::new, names)
}

/// What is measured of each section.
struct Numbers<'m> {
    morphology: &'m Morphology,
    measures: Measures,
    /// What radial distances are measured from.
    center: DVec3,
    children: Vec<u32>,
    neurites: Vec<u32>,
    /// First section of each neurite.
    roots: Vec<usize>,
    lengths: Vec<f64>,
    areas: Vec<f64>,
    volumes: Vec<f64>,
    tortuosity: Vec<Option<f64>>,
    branch_orders: Vec<u32>,
    strahler_orders: Vec<u32>,
    path_distances: Vec<f64>,
    radial_distances: Vec<f64>,
    local_angles: Vec<Option<f64>>,
    remote_angles: Vec<Option<f64>>,
    asymmetries: Vec<Option<f64>>,
}

impl<'m> Numbers<'m> {
    fn of(morphology: &'m Morphology) -> Self {
        let center = sholl::center(morphology).unwrap_or_default();
        let sections = morphology.sections.iter().enumerate();
        let roots = sections.filter(|(_, section)| section.parent().is_none());
        let contractions = shape::contractions(morphology);
        let inverse = |c: Option<f64>| c.filter(|c| *c > 0.0).map(|c| 1.0 / c);
        Self {
            morphology,
            measures: Measures::of(morphology),
            center,
            children: shape::child_counts(morphology),
            neurites: shape::neurites(morphology),
            roots: roots.map(|(index, _)| index).collect(),
            lengths: shape::section_lengths(morphology),
            areas: shape::section_areas(morphology),
            volumes: shape::section_volumes(morphology),
            tortuosity: contractions.into_iter().map(inverse).collect(),
            branch_orders: shape::branch_orders(morphology),
            strahler_orders: shape::strahler_orders(morphology),
            path_distances: shape::path_lengths(morphology),
            radial_distances: shape::end_distances(morphology, center),
            local_angles: shape::fork_angles(morphology, shape::LOCAL),
            remote_angles: shape::fork_angles(morphology, shape::REMOTE),
            asymmetries: shape::partition_asymmetries(morphology),
        }
    }

    fn cell(&self, step: Option<f64>) -> Result<Row, sholl::TooManySpheres> {
        let m = &self.measures;
        let all = 0..self.lengths.len();
        let mut fields = vec![("number_of_neurites", count(m.n_neurites))];
        fields.extend(self.statistics(&all, self.center));
        fields.extend([
            ("length_axon", number(m.length_by_type.axon)),
            (
                "length_basal_dendrite",
                number(m.length_by_type.basal_dendrite),
            ),
            (
                "length_apical_dendrite",
                number(m.length_by_type.apical_dendrite),
            ),
            ("length_other", number(m.length_by_type.other)),
        ]);
        let [width, height, depth] = self.extent();
        fields.extend([
            ("total_width", number(width)),
            ("total_height", number(height)),
            ("total_depth", number(depth)),
            ("soma_kind", Value::Text(m.soma.kind.into())),
            ("soma_radius", number(m.soma.radius)),
            ("soma_surface_area", number(m.soma.area)),
            ("soma_volume", number(m.soma.volume)),
        ]);
        let sholl = self.sholl(step, &all)?;
        Ok(Row { fields, sholl })
    }

    fn neurite(&self, neurite: u32, step: Option<f64>) -> Result<Row, sholl::TooManySpheres> {
        // Depth first, the sections of a neurite follow one another.
        let next = self.roots.get(neurite as usize + 1);
        let own = self.roots[neurite as usize]..next.copied().unwrap_or(self.lengths.len());
        let root = &self.morphology.sections[self.roots[neurite as usize]];
        let first = &self.morphology.points[root.first as usize];
        let start = self.morphology.origin + first.position.as_dvec3();
        let mut fields = vec![
            ("neurite", Value::Count(i64::from(neurite))),
            ("type", Value::Text(root.kind.name())),
            (
                "first_sample",
                Value::Count(self.morphology.sample_ids[root.first as usize]),
            ),
        ];
        fields.extend(self.statistics(&own, start));
        let sholl = self.sholl(step, &own)?;
        Ok(Row { fields, sholl })
    }

    /// What cells and neurites have in common, of their own sections; radial distances are measured from `start`.
    fn statistics(&self, own: &Range<usize>, start: DVec3) -> Vec<(&'static str, Value)> {
        let children = |least: u32, most: u32| {
            let counts = self.children[own.clone()].iter();
            count(counts.filter(|n| (least..=most).contains(*n)).count())
        };
        let sections = &self.morphology.sections[own.clone()];
        let points = sections.iter().map(|section| section.range().len());
        let radial = |section: usize| {
            let last = self.morphology.sections[section].end as usize - 1;
            let end = self.morphology.origin + self.morphology.points[last].position.as_dvec3();
            (self.children[section] == 0).then(|| end.distance(start))
        };
        let radial_distances: Vec<f64> = own.clone().filter_map(radial).collect();
        let known = |values: &[Option<f64>]| -> Vec<f64> {
            values[own.clone()].iter().copied().flatten().collect()
        };
        let most = |values: &[u32]| {
            let most = values[own.clone()].iter().copied().max();
            most.map_or(Value::Number(None), |most| Value::Count(most.into()))
        };
        let [lengths, areas, volumes, paths] = [
            &self.lengths,
            &self.areas,
            &self.volumes,
            &self.path_distances,
        ]
        .map(|values| &values[own.clone()]);
        vec![
            ("number_of_points", count(points.sum())),
            ("number_of_sections", count(sections.len())),
            ("number_of_bifurcations", children(2, 2)),
            ("number_of_forking_points", children(2, u32::MAX)),
            ("number_of_leaves", children(0, 0)),
            ("total_length", sum(lengths)),
            ("total_area", sum(areas)),
            ("total_volume", sum(volumes)),
            ("max_section_branch_orders", most(&self.branch_orders)),
            ("max_section_strahler_orders", most(&self.strahler_orders)),
            ("mean_section_lengths", mean(lengths)),
            ("mean_section_tortuosity", mean(&known(&self.tortuosity))),
            ("max_section_path_distances", max(paths)),
            ("max_radial_distance", max(&radial_distances)),
            (
                "mean_local_bifurcation_angles",
                mean(&known(&self.local_angles)),
            ),
            (
                "mean_remote_bifurcation_angles",
                mean(&known(&self.remote_angles)),
            ),
            ("mean_partition_asymmetry", mean(&known(&self.asymmetries))),
        ]
    }

    fn section(&self, index: usize) -> Vec<(&'static str, Value)> {
        let section = &self.morphology.sections[index];
        let id = SectionId(index as u32);
        let ids = &self.morphology.sample_ids;
        let parent = section.parent().map_or(-1, |parent| i64::from(parent.0));
        let mut links = shape::links(self.morphology, id);
        let ends = links
            .next()
            .map(|(from, to)| (from, links.last().map_or(to, |(_, to)| to)));
        let apart =
            ends.map(|(from, to)| from.position.as_dvec3().distance(to.position.as_dvec3()));
        vec![
            ("section", count(index)),
            ("parent", Value::Count(parent)),
            ("neurite", Value::Count(i64::from(self.neurites[index]))),
            ("type", Value::Text(section.kind.name())),
            ("first_sample", Value::Count(ids[section.first as usize])),
            ("last_sample", Value::Count(ids[section.end as usize - 1])),
            ("number_of_points", count(section.range().len())),
            (
                "number_of_children",
                Value::Count(i64::from(self.children[index])),
            ),
            ("section_lengths", number(self.lengths[index])),
            ("section_areas", number(self.areas[index])),
            ("section_volumes", number(self.volumes[index])),
            ("section_end_distances", number(apart.unwrap_or(0.0))),
            ("section_tortuosity", Value::Number(self.tortuosity[index])),
            (
                "section_branch_orders",
                Value::Count(self.branch_orders[index].into()),
            ),
            (
                "section_strahler_orders",
                Value::Count(self.strahler_orders[index].into()),
            ),
            ("section_path_distances", number(self.path_distances[index])),
            (
                "section_radial_distances",
                number(self.radial_distances[index]),
            ),
            (
                "local_bifurcation_angles",
                Value::Number(self.local_angles[index]),
            ),
            (
                "remote_bifurcation_angles",
                Value::Number(self.remote_angles[index]),
            ),
            (
                "partition_asymmetry",
                Value::Number(self.asymmetries[index]),
            ),
        ]
    }

    fn bars(&self) -> Vec<Row> {
        let last_sample = |id: SectionId| {
            let end = self.morphology.sections[id.index()].end as usize;
            self.morphology.sample_ids[end - 1]
        };
        let bars = barcode(self.morphology, self.center)
            .into_iter()
            .map(|bar| {
                let neurite = self.neurites[bar.end.index()];
                let root = &self.morphology.sections[self.roots[neurite as usize]];
                let first = self.morphology.sample_ids[root.first as usize];
                without_spheres(vec![
                    ("neurite", Value::Count(i64::from(neurite))),
                    ("type", Value::Text(root.kind.name())),
                    ("end_sample", Value::Count(last_sample(bar.end))),
                    (
                        "fork_sample",
                        Value::Count(bar.fork.map_or(first, last_sample)),
                    ),
                    ("end_distance", number(bar.end_distance)),
                    ("fork_distance", number(bar.fork_distance)),
                ])
            });
        bars.collect()
    }

    fn sholl(
        &self,
        step: Option<f64>,
        own: &Range<usize>,
    ) -> Result<Option<Vec<u64>>, sholl::TooManySpheres> {
        let sections = own.start as u32..own.end as u32;
        let crossings = |step| sholl::crossings(self.morphology, step, sections);
        step.map(crossings).transpose()
    }

    /// Sides of the box around all points of neurites.
    fn extent(&self) -> [f64; 3] {
        let points = || self.morphology.points.iter().map(|p| p.position.as_dvec3());
        let low = points().reduce(DVec3::min).unwrap_or_default();
        let high = points().reduce(DVec3::max).unwrap_or_default();
        (high - low).to_array()
    }
}

fn without_spheres(fields: Vec<(&'static str, Value)>) -> Row {
    Row {
        fields,
        sholl: None,
    }
}

fn count(count: usize) -> Value {
    Value::Count(count as i64)
}

/// The sum of nothing is −0 in Rust: here it is 0.
fn number(number: f64) -> Value {
    Value::Number(Some(number + 0.0).filter(|number| number.is_finite()))
}

fn sum(values: &[f64]) -> Value {
    number(values.iter().sum())
}

fn mean(values: &[f64]) -> Value {
    match values.len() {
        0 => Value::Number(None),
        n => number(values.iter().sum::<f64>() / n as f64),
    }
}

fn max(values: &[f64]) -> Value {
    let most = values.iter().copied().reduce(f64::max);
    most.map_or(Value::Number(None), number)
}
