//! Distances of tracing points from the beginning of their neurite.

use std::collections::HashMap;

use neurotess_mesh::{Role, TracingPoint};
use neurotess_morphology::{Morphology, SampleLabels, Section, SectionId, shape};

use crate::scheme::Cell;

/// Distance (µm) along the neurite from its first point to each tracing point; none for points of
/// somata.
pub fn path_distances(cell: &Cell<'_>) -> Vec<Option<f32>> {
    let morphology = cell.morphology;
    let ends = shape::path_lengths(morphology);
    let labels = morphology.sample_labels();
    let mut of_sample: HashMap<i32, f32> = HashMap::new();
    for (index, section) in morphology.sections.iter().enumerate() {
        let start = section.parent().map_or(0.0, |parent| ends[parent.index()]);
        measure_section(morphology, &labels, index, section, start, &mut of_sample);
    }
    let of_point = |point: &TracingPoint| match point.role {
        Role::Soma => None,
        _ => Some(of_sample.get(&point.sample.0).copied().unwrap_or(0.0)),
    };
    cell.mesh.tracing.iter().map(of_point).collect()
}

fn measure_section(
    morphology: &Morphology,
    labels: &SampleLabels<'_>,
    index: usize,
    section: &Section,
    start: f64,
    of_sample: &mut HashMap<i32, f32>,
) {
    let id = SectionId(index as u32);
    let mut before = shape::branch_point(morphology, id);
    let mut distance = start;
    for index in section.range() {
        let point = &morphology.points[index];
        if let Some(before) = before {
            distance += f64::from(point.position.distance(before.position));
        }
        before = Some(point);
        of_sample.insert(labels.of_point(index), distance as f32);
    }
}
