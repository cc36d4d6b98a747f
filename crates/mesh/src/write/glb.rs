//! GLB, glTF 2.0: <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.
//!
//! Vertices are interleaved, 40 bytes each, so that one pass over the surface writes them. The
//! bounds that glTF asks for are known only after it: the JSON comes first in the file, therefore
//! it gets room for the longest numbers and is written last. Several surfaces follow one another in the
//! binary chunk; nodes show each where it stands, as often as they like.

use std::sync::{Mutex, PoisonError};

use glam::{DAffine3, DVec3, Vec3};
use serde_json::{Value, json};

use super::{File, WriteError, record, split};
use crate::{Format, Surface};

/// Bytes of a vertex.
const STRIDE: u64 = 40;

/// Magic number, version and length; then the JSON chunk's length and type.
const JSON_START: u64 = 20;

/// A surface that is shown somewhere in a file of several.
#[derive(Clone, Debug, PartialEq)]
pub struct GlbNode {
    /// Its name in the file.
    pub name: String,
    /// FilePosition among the surfaces.
    pub surface: usize,
    /// Rotation, uniform scale and translation (µm) of the surface's own coordinates.
    pub world_from_surface: DAffine3,
}

/// Where the arrays of a surface lie in the binary chunk.
struct Span {
    vertices: u64,
    first_vertex: u64,
    indices: u64,
    first_index: u64,
    /// Of positions.
    bounds: [Vec3; 2],
}

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let here = GlbNode {
        name: String::new(),
        surface: 0,
        world_from_surface: DAffine3::IDENTITY,
    };
    write_all(&[surface], &[here], file)
}

/// Writes surfaces with the nodes that show them.
pub(super) fn write_all(
    surfaces: &[&dyn Surface],
    nodes: &[GlbNode],
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let mut spans = Vec::new();
    let mut binary = 0;
    for surface in surfaces {
        let vertices = surface.vertex_count() as u64;
        let faces = surface.triangle_count() as u64 + 2 * surface.quad_count() as u64;
        spans.push(Span {
            vertices,
            first_vertex: binary,
            indices: 3 * faces,
            first_index: binary + STRIDE * vertices,
            bounds: [Vec3::ZERO; 2],
        });
        binary += STRIDE * vertices + 12 * faces;
    }
    let origins: Vec<DVec3> = surfaces.iter().map(|surface| surface.origin()).collect();

    // Six bounds of at most 25 characters instead of `0.0`; then to a multiple of 4.
    let longest = document(&spans, &origins, nodes).to_string().len() + 6 * 22 * spans.len();
    let json_bytes = (longest as u64).next_multiple_of(4);
    let chunk = if binary > 0 { 8 } else { 0 };
    let size = JSON_START + json_bytes + chunk + binary;
    let Ok(total) = u32::try_from(size) else {
        return Err(WriteError::TooLarge {
            format: Format::Glb,
            size,
            unit: "bytes",
        });
    };

    let start = JSON_START + json_bytes + chunk;
    for (surface, span) in surfaces.iter().zip(&mut spans) {
        span.bounds = write_surface(*surface, start, span, file)?;
    }
    let mut head = Vec::new();
    head.extend_from_slice(&record![20;
        u32::from_le_bytes(*b"glTF"), 2u32, total, json_bytes as u32,
        u32::from_le_bytes(*b"JSON")]);
    head.extend_from_slice(document(&spans, &origins, nodes).to_string().as_bytes());
    head.resize((JSON_START + json_bytes) as usize, b' ');
    if binary > 0 {
        head.extend_from_slice(&record![8; binary as u32, u32::from_le_bytes(*b"BIN\0")]);
    }
    file.put(&mut 0, &head)?;
    file.go(size)
}

/// Writes the arrays of a surface and gives the bounds of its positions.
fn write_surface(
    surface: &dyn Surface,
    start: u64,
    span: &Span,
    file: &mut File<'_>,
) -> Result<[Vec3; 2], WriteError> {
    let bounds = Mutex::new([Vec3::INFINITY, Vec3::NEG_INFINITY]);
    file.vertices(
        surface,
        &mut [start + span.first_vertex],
        |group, [bytes]| {
            let mut mine = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            bytes.reserve(STRIDE as usize * group.len());
            for v in group {
                let (p, n) = (v.position, v.normal);
                mine = [mine[0].min(p), mine[1].max(p)];
                bytes.extend_from_slice(&record![40;
                p.x, p.y, p.z, n.x, n.y, n.z,
                v.kind as f32, v.point as f32, v.section as f32, v.radius]);
            }
            let mut bounds = bounds.lock().unwrap_or_else(PoisonError::into_inner);
            *bounds = [bounds[0].min(mine[0]), bounds[1].max(mine[1])];
        },
    )?;
    file.faces(
        surface,
        &mut [start + span.first_index],
        |group, [bytes]| {
            let quads = group.quads.iter().flat_map(split);
            bytes.reserve(12 * (group.triangles.len() + 2 * group.quads.len()));
            for [a, b, c] in group.triangles.iter().copied().chain(quads) {
                bytes.extend_from_slice(&record![12; a, b, c]);
            }
        },
    )?;
    Ok(bounds.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// The JSON. Surfaces without vertices have no mesh and no nodes, since accessors must not be empty.
fn document(spans: &[Span], origins: &[DVec3], nodes: &[GlbNode]) -> Value {
    let asset = json!({
        "version": "2.0",
        "generator": concat!("neurotess ", env!("CARGO_PKG_VERSION")),
        "extras": { "units": "micrometer" },
    });
    let mut arrays = Arrays::default();
    let meshes: Vec<Option<usize>> = spans.iter().map(|span| arrays.add(span)).collect();
    let shown = nodes.iter().filter_map(|node| {
        let mesh = meshes.get(node.surface).copied().flatten()?;
        Some(node_of(node, mesh, origins[node.surface]))
    });
    let shown: Vec<Value> = shown.collect();
    if shown.is_empty() {
        return json!({ "asset": asset, "scene": 0, "scenes": [{}] });
    }
    let bytes: u64 = spans
        .iter()
        .map(|s| STRIDE * s.vertices + 4 * s.indices)
        .sum();
    json!({
        "asset": asset,
        "scene": 0,
        "scenes": [{ "nodes": (0..shown.len()).collect::<Vec<_>>() }],
        "nodes": shown,
        "meshes": arrays.meshes,
        "accessors": arrays.accessors,
        "bufferViews": arrays.views,
        "buffers": [{ "byteLength": bytes }],
    })
}

fn node_of(node: &GlbNode, mesh: usize, origin: DVec3) -> Value {
    let (scale, rotation, _) = node.world_from_surface.to_scale_rotation_translation();
    let translation = node.world_from_surface.transform_point3(origin);
    let mut value = json!({ "mesh": mesh, "translation": translation.to_array() });
    if !node.name.is_empty() {
        value["name"] = json!(node.name);
    }
    if node.world_from_surface.matrix3 != DAffine3::IDENTITY.matrix3 {
        value["rotation"] = json!(rotation.to_array());
        value["scale"] = json!(scale.to_array());
    }
    value
}

/// What the JSON says of surfaces.
#[derive(Default)]
struct Arrays {
    meshes: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
}

impl Arrays {
    /// Gives the number of the mesh, if there is anything in it.
    fn add(&mut self, span: &Span) -> Option<usize> {
        if span.vertices == 0 {
            return None;
        }
        let view = self.views.len();
        self.views.push(json!({
            "buffer": 0, "byteOffset": span.first_vertex, "byteLength": STRIDE * span.vertices,
            "byteStride": STRIDE, "target": ARRAY_BUFFER,
        }));
        let first = self.accessors.len();
        let kinds = ["VEC3", "VEC3", "SCALAR", "SCALAR", "SCALAR", "SCALAR"];
        for (kind, offset) in kinds.into_iter().zip([0, 12, 24, 28, 32, 36]) {
            self.accessors.push(json!({
                "bufferView": view, "byteOffset": offset, "componentType": FLOAT,
                "count": span.vertices, "type": kind,
            }));
        }
        let [low, high] = span.bounds;
        self.accessors[first]["min"] = json!(low.to_array());
        self.accessors[first]["max"] = json!(high.to_array());
        let mut primitive = json!({
            "attributes": {
                "POSITION": first, "NORMAL": first + 1, "_TYPE": first + 2, "_POINT": first + 3,
                "_SECTION": first + 4, "_RADIUS": first + 5,
            },
            "mode": if span.indices > 0 { TRIANGLES } else { POINTS },
        });
        if span.indices > 0 {
            primitive["indices"] = json!(self.accessors.len());
            self.accessors.push(json!({
                "bufferView": self.views.len(), "componentType": UNSIGNED_INT,
                "count": span.indices, "type": "SCALAR",
            }));
            self.views.push(json!({
                "buffer": 0, "byteOffset": span.first_index, "byteLength": 4 * span.indices,
                "target": ELEMENT_ARRAY_BUFFER,
            }));
        }
        self.meshes.push(json!({ "primitives": [primitive] }));
        Some(self.meshes.len() - 1)
    }
}

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;
