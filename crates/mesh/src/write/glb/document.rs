//! What the JSON of a GLB says: arrays, meshes, materials, nodes.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};
use serde_json::{Value, json};

use super::super::materials::type_color;
use super::{GlbNode, STRIDES, Span};
use crate::palette::linear;
use crate::region_name;

/// Types of accessors by their number of components.
pub(super) const SHAPES: [&str; 4] = ["SCALAR", "VEC2", "VEC3", "VEC4"];

/// The JSON. Surfaces without vertices have no mesh and no nodes, since accessors must not be empty.
pub(super) fn document(spans: &[Span], origins: &[DVec3], nodes: &[GlbNode]) -> Value {
    let mut arrays = Arrays::default();
    let meshes: Vec<Option<usize>> = spans.iter().map(|span| arrays.add(span)).collect();
    let own = |s: &Span| {
        s.own
            .iter()
            .map(|own| 4 * own.components as u64 * s.vertices)
            .sum::<u64>()
    };
    let bytes: u64 = spans
        .iter()
        .map(|s| s.stride * s.vertices + 4 * s.indices + own(s))
        .sum();
    arrays.finish((&meshes, origins), nodes, bytes)
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
pub(super) struct Arrays {
    pub(super) meshes: Vec<Value>,
    pub(super) accessors: Vec<Value>,
    pub(super) views: Vec<Value>,
    materials: Vec<Value>,
    /// The material of each type, and that of all.
    of_kinds: BTreeMap<Option<i32>, usize>,
}

impl Arrays {
    /// The JSON around them. `meshes`: their numbers by surface.
    pub(super) fn finish(
        self,
        (meshes, origins): (&[Option<usize>], &[DVec3]),
        nodes: &[GlbNode],
        bytes: u64,
    ) -> Value {
        let asset = json!({
            "version": "2.0",
            "generator": concat!("neurotess ", env!("CARGO_PKG_VERSION")),
            "extras": { "units": "micrometer" },
        });
        let shown = nodes.iter().filter_map(|node| {
            let mesh = meshes.get(node.surface).copied().flatten()?;
            Some(node_of(node, mesh, origins[node.surface]))
        });
        let shown: Vec<Value> = shown.collect();
        if shown.is_empty() {
            return json!({ "asset": asset, "scene": 0, "scenes": [{}] });
        }
        let mut root = json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{ "nodes": (0..shown.len()).collect::<Vec<_>>() }],
            "nodes": shown,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": bytes }],
        });
        // A list must not be empty.
        if !self.materials.is_empty() {
            root["materials"] = json!(self.materials);
        }
        root
    }

    /// Gives the number of the mesh, if there is anything in it.
    fn add(&mut self, span: &Span) -> Option<usize> {
        if span.vertices == 0 {
            return None;
        }
        let view = self.views.len();
        self.views.push(json!({
            "buffer": 0, "byteOffset": span.first_vertex, "byteLength": span.stride * span.vertices,
            "byteStride": span.stride, "target": ARRAY_BUFFER,
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
        // Those of one's own are given no material: trimesh shows no colors beside one.
        let has_colors = span.stride != STRIDES[0];
        if has_colors {
            attributes[COLOR] = json!(self.accessors.len());
            self.accessors.push(json!({
                "bufferView": view, "byteOffset": STRIDES[0], "componentType": UNSIGNED_SHORT,
                "normalized": true, "count": span.vertices, "type": "VEC3",
            }));
        }
        for own in &span.own {
            attributes[&own.gltf_name] = json!(self.accessors.len());
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
                let indices = self.indices(view, 0, span.indices);
                let material = has_colors.then(|| self.material(None, true));
                primitives.push(primitive(Some(indices), material));
            }
            let mut offset = 0;
            for (&kind, &count) in &span.kinds {
                let indices = self.indices(view, offset, count);
                primitives.push(primitive(
                    Some(indices),
                    Some(self.material(Some(kind), has_colors)),
                ));
                offset += 4 * count;
            }
        } else {
            primitives.push(primitive(None, None));
        }
        let names = span.own.iter().map(|own| (&*own.name, &*own.gltf_name));
        Some(self.mesh(&primitives, names))
    }

    /// The number of a mesh. `names`: of numbers of one's own, and what glTF calls them.
    pub(super) fn mesh<'n>(
        &mut self,
        primitives: &[Value],
        names: impl Iterator<Item = (&'n str, &'n str)>,
    ) -> usize {
        let mut mesh = json!({ "primitives": primitives });
        // Those whose letters glTF's do not tell.
        let told = names.filter(|(name, gltf_name)| {
            let plain = gltf_name.strip_prefix('_');
            plain.is_some_and(|plain| *name != plain.to_lowercase())
        });
        let told: serde_json::Map<String, Value> = told
            .map(|(name, gltf_name)| (gltf_name.to_owned(), json!(name)))
            .collect();
        if !told.is_empty() {
            mesh["extras"] = json!({ "attributes": told });
        }
        self.meshes.push(mesh);
        self.meshes.len() - 1
    }

    /// The number of an accessor of indices.
    fn indices(&mut self, view: usize, offset: u64, count: u64) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "byteOffset": offset, "componentType": UNSIGNED_INT,
            "count": count, "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    /// The number of the material of a type, or of all. It is white where vertices have colors, which are multiplied with
    /// it. Tracings of membranes are no metal, which glTF takes what has no material for, and shine little.
    pub(super) fn material(&mut self, kind: Option<i32>, is_white: bool) -> usize {
        *self.of_kinds.entry(kind).or_insert_with(|| {
            let color = kind.filter(|_| !is_white).map_or([255; 3], type_color);
            // Finer than 8 bits, but for the darkest.
            let [r, g, b] = linear(color).map(|light| (f64::from(light) * 1e4).round() / 1e4);
            self.materials.push(json!({
                "name": kind.map_or("membrane".into(), region_name),
                "pbrMetallicRoughness": {
                    "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7,
                },
            }));
            self.materials.len() - 1
        })
    }
}

/// The attribute of colors.
pub(super) const COLOR: &str = "COLOR_0";
pub(super) const FLOAT: u32 = 5126;
pub(super) const UNSIGNED_SHORT: u32 = 5123;
pub(super) const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
pub(super) const TRIANGLES: u32 = 4;
