//! A tracing as a precomputed skeleton: points, links and attributes.
//!
//! All attributes are 32-bit floating-point numbers, since with any other neuroglancer never asks for the skeleton. Links
//! are (parent, child), the root's first: other programs take the first number of the first link for the root. Positions
//! and radii are in nm at their places: nobody scales radii by a transform.

use glam::DAffine3;
use neurotess_morphology::{Attachment, Morphology, SectionId, shape};
use serde_json::{Value, json};

use crate::shards::Sharding;

/// Nanometers in a micrometer.
pub(crate) const NM: f64 = 1000.0;

/// Names of the attributes, in the order of the bytes.
const ATTRIBUTES: [&str; 4] = ["radius", "vertex_types", "section", "path_distance"];

/// Type of a soma's point.
const SOMA: f32 = 1.0;

/// The `info` file of skeletons.
pub fn skeleton_info(sharding: Option<Sharding>) -> Value {
    let attribute = |name: &str| json!({"id": name, "data_type": "float32", "num_components": 1});
    let mut info = json!({
        "@type": "neuroglancer_skeletons",
        "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
        "vertex_attributes": ATTRIBUTES.map(attribute),
    });
    if let Some(sharding) = sharding {
        info["sharding"] = sharding.json();
    }
    info
}

/// A skeleton while it is made.
#[derive(Default)]
struct Vertices {
    positions: Vec<[f32; 3]>,
    /// [`ATTRIBUTES`] of each point.
    attributes: [Vec<f32>; 4],
    links: Vec<[u32; 2]>,
}

/// The file of a tracing at its place. Somata come first, each a point, then the points of neurites in the tracing's order.
///
/// Attributes: the radius (nm); the type (SWC); the section, counted from 1, 0 of a soma; the length (nm) along the neurite
/// from its first point.
pub fn skeleton(morphology: &Morphology, world_from_cell: DAffine3) -> Vec<u8> {
    let scale = world_from_cell.matrix3.determinant().cbrt();
    let nm = |um: f64| (um * scale * NM) as f32;
    let mut vertices = Vertices::default();
    let mut add = |at: glam::Vec3, radius: f32, kind: f32, section: usize, distance: f64| {
        let at = world_from_cell.transform_point3(morphology.origin + at.as_dvec3()) * NM;
        vertices.positions.push(at.as_vec3().to_array());
        let attributes = [nm(f64::from(radius)), kind, section as f32, nm(distance)];
        for (column, value) in vertices.attributes.iter_mut().zip(attributes) {
            column.push(value);
        }
    };
    for soma in &morphology.somata {
        add(soma.center, soma.radius, SOMA, 0, 0.0);
    }
    let ends = shape::path_lengths(morphology);
    for (index, section) in morphology.sections.iter().enumerate() {
        let mut distance = section.parent().map_or(0.0, |parent| ends[parent.index()]);
        let parent = section.parent().map(SectionId::index);
        let mut before = parent.and_then(|parent| morphology.sections[parent].range().last());
        for point in section.range() {
            let here = &morphology.points[point];
            distance += before.map_or(0.0, |before| {
                let before = morphology.points[before].position.as_dvec3();
                before.distance(here.position.as_dvec3())
            });
            let kind = section.kind.0 as f32;
            add(here.position, here.radius, kind, index + 1, distance);
            before = Some(point);
        }
    }
    vertices.links = links(morphology);
    vertices.bytes()
}

/// Links (parent, child) in the order of the children.
fn links(morphology: &Morphology) -> Vec<[u32; 2]> {
    let somata = morphology.somata.len() as u32;
    let mut links = Vec::with_capacity(morphology.points.len());
    for section in &morphology.sections {
        let mut before = match section.attachment {
            Attachment::Section(parent) => {
                Some(somata + morphology.sections[parent.index()].end - 1)
            }
            Attachment::Soma { soma, .. } => Some(soma),
            Attachment::Free => None,
        };
        for point in section.first..section.end {
            let child = somata + point;
            links.extend(before.map(|before| [before, child]));
            before = Some(child);
        }
    }
    links
}

impl Vertices {
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let counts = [self.positions.len(), self.links.len()];
        bytes.extend(
            counts
                .map(|count| (count as u32).to_le_bytes())
                .as_flattened(),
        );
        let mut floats = |values: &[f32]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        floats(self.positions.as_flattened());
        let links = self.links.as_flattened().iter();
        bytes.extend(links.flat_map(|end| end.to_le_bytes()));
        for column in &self.attributes {
            bytes.extend(column.iter().flat_map(|value| value.to_le_bytes()));
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};
    use neurotess_formats::{ReadOptions, swc};

    use super::*;

    #[test]
    fn bytes_are_as_documented() {
        let text = b"1 1 0 0 0 5 -1\n2 2 0 9 0 1 1\n3 2 0 12 0 0.5 2\n4 2 4 12 0 0.5 3\n5 3 0 12 3 0.5 3\n";
        let read = swc::read_bytes(text, "a.swc", &ReadOptions::default()).expect("read");
        let turned = DAffine3::from_scale_rotation_translation(
            DVec3::splat(2.0),
            DQuat::IDENTITY,
            DVec3::new(100.0, 0.0, 0.0),
        );
        let bytes = skeleton(&read.morphology, turned);
        let words: Vec<[u8; 4]> = bytes.as_chunks::<4>().0.to_vec();
        let ints = |range: std::ops::Range<usize>| -> Vec<u32> {
            words[range]
                .iter()
                .map(|&w| u32::from_le_bytes(w))
                .collect()
        };
        let floats = |range: std::ops::Range<usize>| -> Vec<f32> {
            words[range]
                .iter()
                .map(|&w| f32::from_le_bytes(w))
                .collect()
        };
        assert_eq!(ints(0..2), [5, 4]);
        assert_eq!(
            floats(2..8),
            [100_000.0, 0.0, 0.0, 100_000.0, 18_000.0, 0.0]
        );
        // From the root on, parents first.
        assert_eq!(ints(17..25), [0, 1, 1, 2, 2, 3, 2, 4]);
        assert_eq!(
            floats(25..30),
            [10_000.0, 2_000.0, 1_000.0, 1_000.0, 1_000.0]
        );
        assert_eq!(floats(30..35), [1.0, 2.0, 2.0, 2.0, 3.0]);
        assert_eq!(floats(35..40), [0.0, 1.0, 1.0, 2.0, 3.0]);
        assert_eq!(floats(40..45), [0.0, 0.0, 6_000.0, 14_000.0, 12_000.0]);
        assert_eq!(words.len(), 45);
    }

    #[test]
    fn all_attributes_are_floats_with_lower_case_names() {
        let info = skeleton_info(Some(Sharding::for_count(9)));
        for attribute in info["vertex_attributes"].as_array().expect("a list") {
            assert_eq!(attribute["data_type"], "float32");
            let name = attribute["id"].as_str().expect("a name");
            assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '_'));
        }
        assert_eq!(info["vertex_attributes"][1]["id"], "vertex_types");
        assert_eq!(info["transform"][0], 1);
        assert_eq!(info["sharding"]["hash"], "murmurhash3_x86_128");
    }
}
