//! What the JSON of a GLB says: arrays, meshes, materials, nodes.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};
use serde_json::{Value, json};

use super::super::materials::type_color;
use super::{GlbNode, STRIDE, Span};
use crate::palette::linear;
use crate::region_name;

/// Types of accessors by their number of components.
const SHAPES: [&str; 4] = ["SCALAR", "VEC2", "VEC3", "VEC4"];

/// The JSON. Surfaces without vertices have no mesh and no nodes, since accessors must not be empty.
pub(super) fn document(spans: &[Span], origins: &[DVec3], nodes: &[GlbNode]) -> Value {
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
    let own = |s: &Span| {
        s.own
            .iter()
            .map(|own| 4 * own.components as u64 * s.vertices)
            .sum::<u64>()
    };
    let bytes: u64 = spans
        .iter()
        .map(|s| STRIDE * s.vertices + 4 * s.indices + own(s))
        .sum();
    let mut root = json!({
        "asset": asset,
        "scene": 0,
        "scenes": [{ "nodes": (0..shown.len()).collect::<Vec<_>>() }],
        "nodes": shown,
        "meshes": arrays.meshes,
        "accessors": arrays.accessors,
        "bufferViews": arrays.views,
        "buffers": [{ "byteLength": bytes }],
    });
    // A list must not be empty.
    if !arrays.materials.is_empty() {
        root["materials"] = json!(arrays.materials);
    }
    root
}

pub(super) fn node_of(node: &GlbNode, mesh: usize, origin: DVec3) -> Value {
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
    materials: Vec<Value>,
    /// The material of each type.
    of_kinds: BTreeMap<i32, usize>,
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
        let mut attributes = json!({
            "POSITION": first, "NORMAL": first + 1, "_TYPE": first + 2, "_POINT": first + 3,
            "_SECTION": first + 4, "_RADIUS": first + 5,
        });
        // Names whose letters glTF's do not tell.
        let mut names = serde_json::Map::new();
        for own in &span.own {
            let gltf_name = &own.gltf_name;
            attributes[gltf_name] = json!(self.accessors.len());
            if gltf_name.starts_with('_') && own.name != gltf_name[1..].to_lowercase() {
                names.insert(gltf_name.clone(), json!(own.name));
            }
            self.accessors.push(json!({
                "bufferView": self.views.len(), "componentType": FLOAT, "count": span.vertices,
                "type": SHAPES[own.components.clamp(1, 4) - 1],
            }));
            self.views.push(json!({
                "buffer": 0, "byteOffset": own.start,
                "byteLength": 4 * own.components as u64 * span.vertices, "target": ARRAY_BUFFER,
            }));
        }
        let [low, high] = span.bounds;
        self.accessors[first]["min"] = json!(low.to_array());
        self.accessors[first]["max"] = json!(high.to_array());
        let primitive = |indices: Option<usize>, material: Option<usize>| {
            let mut primitive = json!({
                "attributes": attributes,
                "mode": if indices.is_some() { TRIANGLES } else { POINTS },
            });
            if let Some(indices) = indices {
                primitive["indices"] = json!(indices);
            }
            if let Some(material) = material {
                primitive["material"] = json!(material);
            }
            primitive
        };
        let mut primitives = Vec::new();
        if span.indices > 0 {
            let view = self.views.len();
            self.views.push(json!({
                "buffer": 0, "byteOffset": span.first_index, "byteLength": 4 * span.indices,
                "target": ELEMENT_ARRAY_BUFFER,
            }));
            if span.kinds.is_empty() {
                primitives.push(primitive(Some(self.indices(view, 0, span.indices)), None));
            }
            let mut offset = 0;
            for (&kind, &count) in &span.kinds {
                let indices = self.indices(view, offset, count);
                primitives.push(primitive(Some(indices), Some(self.material(kind))));
                offset += 4 * count;
            }
        } else {
            primitives.push(primitive(None, None));
        }
        let mut mesh = json!({ "primitives": primitives });
        if !names.is_empty() {
            mesh["extras"] = json!({ "attributes": names });
        }
        self.meshes.push(mesh);
        Some(self.meshes.len() - 1)
    }

    /// The number of an accessor of indices.
    fn indices(&mut self, view: usize, offset: u64, count: u64) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "byteOffset": offset, "componentType": UNSIGNED_INT,
            "count": count, "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    /// The number of a type's material. Tracings of membranes are no metal, and shine little.
    fn material(&mut self, kind: i32) -> usize {
        *self.of_kinds.entry(kind).or_insert_with(|| {
            // Finer than 8 bits, but for the darkest.
            let [r, g, b] = linear(type_color(kind)).map(|light| (f64::from(light) * 1e4).round() / 1e4);
            self.materials.push(json!({
                "name": region_name(kind),
                "pbrMetallicRoughness": {
                    "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7,
                },
            }));
            self.materials.len() - 1
        })
    }
}

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;
