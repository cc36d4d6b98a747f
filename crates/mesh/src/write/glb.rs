//! GLB, glTF 2.0: <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.
//!
//! Vertices are interleaved, 40 bytes each, so that one pass over the surface writes them. The
//! bounds that glTF asks for are known only after it: the JSON comes first in the file, therefore
//! it gets room for the longest numbers and is written last.

use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use serde_json::{Value, json};

use super::{File, WriteError, record, split};
use crate::{Format, Surface};

/// Bytes of a vertex.
const STRIDE: u64 = 40;

/// Magic number, version and length; then the JSON chunk's length and type.
const JSON_START: u64 = 20;

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let vertices = STRIDE * surface.vertex_count() as u64;
    let triangles = surface.triangle_count() as u64 + 2 * surface.quad_count() as u64;
    let binary = vertices + 12 * triangles;

    // Six bounds of at most 25 characters instead of `0.0`; then to a multiple of 4.
    let longest = document(surface, [Vec3::ZERO; 2]).to_string().len() as u64 + 6 * 22;
    let json_bytes = longest.next_multiple_of(4);
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
    let bounds = Mutex::new([Vec3::INFINITY, Vec3::NEG_INFINITY]);
    file.vertices(surface, &mut [start], |group, [bytes]| {
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
    })?;
    file.faces(surface, &mut [start + vertices], |group, [bytes]| {
        let quads = group.quads.iter().flat_map(split);
        bytes.reserve(12 * (group.triangles.len() + 2 * group.quads.len()));
        for [a, b, c] in group.triangles.iter().copied().chain(quads) {
            bytes.extend_from_slice(&record![12; a, b, c]);
        }
    })?;

    let bounds = bounds.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut head = Vec::new();
    head.extend_from_slice(&record![20;
        u32::from_le_bytes(*b"glTF"), 2u32, total, json_bytes as u32,
        u32::from_le_bytes(*b"JSON")]);
    head.extend_from_slice(document(surface, bounds).to_string().as_bytes());
    head.resize((JSON_START + json_bytes) as usize, b' ');
    if binary > 0 {
        head.extend_from_slice(&record![8; binary as u32, u32::from_le_bytes(*b"BIN\0")]);
    }
    file.put(&mut 0, &head)?;
    file.go(size)
}

/// The JSON. Without vertices: a scene without nodes, since accessors must not be empty.
fn document(surface: &dyn Surface, [low, high]: [Vec3; 2]) -> Value {
    let asset = json!({
        "version": "2.0",
        "generator": concat!("neurotess ", env!("CARGO_PKG_VERSION")),
        "extras": { "units": "micrometre" },
    });
    let vertices = surface.vertex_count() as u64;
    if vertices == 0 {
        return json!({ "asset": asset, "scene": 0, "scenes": [{}] });
    }
    let indices = 3 * (surface.triangle_count() as u64 + 2 * surface.quad_count() as u64);
    let accessor = |offset: u64, kind: &str| {
        json!({
            "bufferView": 0, "byteOffset": offset, "componentType": FLOAT, "count": vertices,
            "type": kind,
        })
    };
    let mut accessors = vec![
        accessor(0, "VEC3"),
        accessor(12, "VEC3"),
        accessor(24, "SCALAR"),
        accessor(28, "SCALAR"),
        accessor(32, "SCALAR"),
        accessor(36, "SCALAR"),
    ];
    accessors[0]["min"] = json!(low.to_array());
    accessors[0]["max"] = json!(high.to_array());
    let mut views = vec![json!({
        "buffer": 0, "byteOffset": 0, "byteLength": STRIDE * vertices, "byteStride": STRIDE,
        "target": ARRAY_BUFFER,
    })];
    let mut primitive = json!({
        "attributes": {
            "POSITION": 0, "NORMAL": 1, "_TYPE": 2, "_POINT": 3, "_SECTION": 4, "_RADIUS": 5,
        },
        "mode": if indices > 0 { TRIANGLES } else { POINTS },
    });
    if indices > 0 {
        views.push(json!({
            "buffer": 0, "byteOffset": STRIDE * vertices, "byteLength": 4 * indices,
            "target": ELEMENT_ARRAY_BUFFER,
        }));
        accessors.push(json!({
            "bufferView": 1, "componentType": UNSIGNED_INT, "count": indices, "type": "SCALAR",
        }));
        primitive["indices"] = json!(6);
    }
    json!({
        "asset": asset,
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": surface.origin().to_array() }],
        "meshes": [{ "primitives": [primitive] }],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": STRIDE * vertices + 4 * indices }],
    })
}

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;
