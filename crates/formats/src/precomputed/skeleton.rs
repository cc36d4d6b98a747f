//! The bytes of a skeleton: two counts, positions, edges, and attributes of vertices one after the other. Edges have no
//! direction that all programs agree on: the tree is walked from the first vertex of the first edge, and from the first
//! one that is not reached yet.

use glam::DVec3;
use neurotess_morphology::{Morphology, NeuriteKind};

use super::broken;
use super::info::{Attribute, Info};
use crate::Fault;
use crate::forest::Forest;
use crate::sample::Sample;
use crate::unit::NANOMETER;
use crate::warning::Warnings;

/// The points of a skeleton, whose numbers are their places from 1 on.
pub(super) fn forest(bytes: &[u8], info: &Info, warnings: &mut Warnings) -> Result<Forest, Fault> {
    let parts = Parts::of(bytes, info)?;
    let radii = parts.attribute(info, "radius");
    let kinds = parts.attribute(info, "vertex_types");
    if radii.is_some() && info.scales() {
        let told = "radii are taken as nm, as other programs do, though positions have a transform: check them";
        warnings.add(1, "radius_unit", told);
    }
    let mut forest = Forest::default();
    for vertex in 0..parts.vertices {
        let position = info.place(parts.position(vertex)) * NANOMETER;
        let radius = radii.as_ref().map_or(0.0, |radii| radii.number(vertex));
        let radius = if radius.is_finite() {
            radius.max(0.0) * NANOMETER
        } else {
            0.0
        };
        let most = Morphology::MAX_COORDINATE;
        if !(position.abs().max_element() <= most && radius <= most) {
            let text = position.to_string();
            return Err(Fault::OutOfRange {
                column: "a position",
                text,
            });
        }
        let kind = kinds
            .as_ref()
            .map_or(0, |kinds| kinds.number(vertex) as i32);
        let sample = Sample {
            position,
            radius,
            line: vertex as u64 + 1,
        };
        forest.push(vertex as i64 + 1, NeuriteKind(kind), sample, None);
    }
    let edges = parts.edges()?;
    let first = edges.first().map_or(0, |&[root, _]| root);
    forest.direct(&edges, first, |_| 1, warnings);
    Ok(forest)
}

/// Where the parts of a skeleton are.
struct Parts<'a> {
    vertices: usize,
    positions: &'a [u8],
    edges: &'a [u8],
    attributes: &'a [u8],
}

/// An attribute of vertices.
struct Values<'a> {
    attribute: &'a Attribute,
    bytes: &'a [u8],
}

impl Values<'_> {
    /// The first number of a vertex.
    fn number(&self, vertex: usize) -> f64 {
        let size = self.attribute.data_type.bytes();
        let at = vertex * size * self.attribute.num_components as usize;
        self.attribute.data_type.number(&self.bytes[at..at + size])
    }
}

impl<'a> Parts<'a> {
    fn of(bytes: &'a [u8], info: &Info) -> Result<Self, Fault> {
        let count = |at: usize| -> Option<usize> {
            let four = bytes.get(at..at + 4)?.try_into().ok()?;
            usize::try_from(u32::from_le_bytes(four)).ok()
        };
        let (Some(vertices), Some(edges)) = (count(0), count(4)) else {
            return Err(broken("a skeleton is shorter than its two counts"));
        };
        let of_vertex = info.attributes.iter();
        let of_vertex = of_vertex.map(|a| a.data_type.bytes() as u64 * u64::from(a.num_components));
        let of_vertex = of_vertex.fold(12_u64, u64::saturating_add);
        let (all, needed) = (bytes.len() as u64, 8_u64);
        let needed = needed.saturating_add((vertices as u64).saturating_mul(of_vertex));
        let needed = needed.saturating_add(8 * edges as u64);
        if needed != all {
            let told = format!(
                "{vertices} vertices and {edges} edges are {needed} bytes, and it has {all}"
            );
            return Err(broken(told));
        }
        if vertices == 0 {
            return Err(Fault::NoSample);
        }
        let (positions, rest) = bytes[8..].split_at(12 * vertices);
        let (edges, attributes) = rest.split_at(8 * edges);
        Ok(Self {
            vertices,
            positions,
            edges,
            attributes,
        })
    }

    fn position(&self, vertex: usize) -> DVec3 {
        let at = |axis: usize| {
            let start = 12 * vertex + 4 * axis;
            let mut four = [0; 4];
            four.copy_from_slice(&self.positions[start..start + 4]);
            f64::from(f32::from_le_bytes(four))
        };
        DVec3::new(at(0), at(1), at(2))
    }

    fn attribute<'i>(&self, info: &'i Info, id: &str) -> Option<Values<'i>>
    where
        'a: 'i,
    {
        let mut start = 0;
        for attribute in &info.attributes {
            let size = attribute.data_type.bytes() * attribute.num_components as usize;
            let bytes = self.attributes.get(start..start + size * self.vertices)?;
            if attribute.id == id && attribute.num_components > 0 {
                return Some(Values { attribute, bytes });
            }
            start += bytes.len();
        }
        None
    }

    fn edges(&self) -> Result<Vec<[u32; 2]>, Fault> {
        let ends = self.edges.as_chunks::<4>().0.iter();
        let ends: Vec<u32> = ends.map(|&four| u32::from_le_bytes(four)).collect();
        match ends.iter().find(|&&end| end as usize >= self.vertices) {
            Some(&end) => Err(Fault::UnknownEnd { id: i64::from(end) }),
            None => Ok(ends.as_chunks::<2>().0.to_vec()),
        }
    }
}
