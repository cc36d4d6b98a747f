//! glTF 2.0: GLB, or JSON that embeds its data. All triangles of the scene, nodes transformed. Primitives of a mesh
//! that have the same attributes share their vertices, so that a mesh which is divided by material stays closed.
//! Triangles may be compressed by Draco (`KHR_draco_mesh_compression`).

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use glam::{DMat4, DQuat, DVec3, Vec3};
use serde_json::Value;

use super::arrays::{Arrays, item, items};
use super::builder::Builder;
use super::compressed::Compressed;
use super::lines::index;
use super::own::OwnAttribute;
use super::{FilePosition, ReadError, malformed};
use crate::SurfaceVertex;
use crate::draco::{Decoded, decode};

pub(super) fn read(bytes: &[u8], mesh: &mut Builder) -> Result<(), ReadError> {
    let (json, binary) = if bytes.starts_with(b"glTF") {
        chunks(bytes)?
    } else {
        (bytes, None)
    };
    let root: Value = serde_json::from_slice(json).map_err(|error| {
        malformed(
            FilePosition::Line(error.line()),
            format!("JSON ({error})"),
            "glTF",
        )
    })?;
    let scene = Scene {
        root: &root,
        arrays: Arrays::new(&root, binary)?,
        decoded: RefCell::default(),
    };
    scene.read(mesh)
}

/// The JSON and the binary chunk.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    let mut found = [None, None];
    let mut at = 12;
    for (slot, name) in found.iter_mut().zip([b"JSON", b"BIN\0"]) {
        let Some((head, rest)) = bytes
            .get(at..)
            .and_then(|rest| rest.split_first_chunk::<8>())
        else {
            break;
        };
        let length = u32::from_le_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let cut = ReadError::Truncated {
            at: FilePosition::Byte(at),
            what: "a chunk",
        };
        let data = rest.get(..length).ok_or(cut)?;
        if head[4..] == name[..] {
            *slot = Some(data);
        }
        at += 8 + length;
    }
    let [json, binary] = found;
    Ok((
        json.ok_or_else(|| malformed(FilePosition::Byte(12), "a chunk", "JSON"))?,
        binary,
    ))
}

/// Vertices that several primitives of a mesh may have.
#[derive(Clone, Copy)]
struct Shared<'a> {
    attributes: &'a Value,
    /// What says how they are compressed.
    extensions: &'a Value,
    /// The number of the first.
    first: u64,
    /// None if they have no positions.
    count: Option<usize>,
}

/// Where the vertices of a primitive come from.
#[derive(Clone, Copy)]
struct Source<'v, 's> {
    attributes: &'v Value,
    extensions: &'v Value,
    /// Names of numbers of one's own, by those that glTF has for them.
    names: &'v Value,
    compressed: Option<&'s Compressed<'v>>,
}

/// Different attributes in a mesh that are compared with those of the next primitive; files of thousands would make
/// it slow.
const MAX_SHARED: usize = 64;

/// Bytes that a vertex would have without compression, with its share of two triangles.
const PLAIN: usize = 64;

struct Scene<'a> {
    root: &'a Value,
    arrays: Arrays<'a>,
    /// Compressed meshes by their buffer view: many nodes may show one.
    decoded: RefCell<BTreeMap<u64, Rc<Decoded>>>,
}

impl Scene<'_> {
    fn read(&self, mesh: &mut Builder) -> Result<(), ReadError> {
        let nodes = items(self.root, "nodes");
        let mut visited = vec![false; nodes.len()];
        let mut stack: Vec<(u64, DMat4)> = self
            .roots()
            .into_iter()
            .map(|node| (node, DMat4::IDENTITY))
            .collect();
        stack.reverse();
        while let Some((number, world_from_parent)) = stack.pop() {
            let node = item(nodes, number, "node")?;
            if std::mem::replace(&mut visited[number as usize], true) {
                let found = format!("node {number} twice");
                return Err(malformed(
                    FilePosition::File,
                    found,
                    "nodes that form trees",
                ));
            }
            let world_from_node = world_from_parent * parent_from_node(node);
            if let Some(number) = node["mesh"].as_u64() {
                let shape = item(items(self.root, "meshes"), number, "mesh")?;
                let mut read: Vec<Shared<'_>> = Vec::new();
                for primitive in items(shape, "primitives") {
                    let attributes = &primitive["attributes"];
                    let extensions = &primitive["extensions"];
                    let compressed = self.compressed(extensions, mesh)?;
                    let same = |shared: &&Shared<'_>| {
                        shared.attributes == attributes && shared.extensions == extensions
                    };
                    let known = read.iter().find(same);
                    let shared = match known {
                        Some(&shared) => shared,
                        None => {
                            let source = Source {
                                attributes,
                                extensions,
                                names: &shape["extras"]["attributes"],
                                compressed: compressed.as_ref(),
                            };
                            self.vertices(source, world_from_node, mesh)?
                        }
                    };
                    if known.is_none() && read.len() < MAX_SHARED {
                        read.push(shared);
                    }
                    let triangles = compressed.as_ref().map(Compressed::triangles);
                    self.faces((primitive, triangles), shared, world_from_node, mesh)?;
                }
            }
            let children = items(node, "children").iter().filter_map(Value::as_u64);
            stack.extend(children.rev().map(|child| (child, world_from_node)));
        }
        Ok(())
    }

    /// Nodes of the scene; without scenes, those that are no one's children.
    fn roots(&self) -> Vec<u64> {
        let number = self.root["scene"].as_u64().unwrap_or(0);
        if let Some(scene) = items(self.root, "scenes").get(number as usize) {
            return items(scene, "nodes")
                .iter()
                .filter_map(Value::as_u64)
                .collect();
        }
        let nodes = items(self.root, "nodes");
        let mut root = vec![true; nodes.len()];
        let children = nodes.iter().flat_map(|node| items(node, "children"));
        for child in children.filter_map(Value::as_u64) {
            if let Some(root) = root.get_mut(child as usize) {
                *root = false;
            }
        }
        (0..)
            .zip(root)
            .filter_map(|(node, root)| root.then_some(node))
            .collect()
    }

    /// What a primitive's extensions say of compressed triangles.
    fn compressed<'v>(
        &self,
        extensions: &'v Value,
        mesh: &mut Builder,
    ) -> Result<Option<Compressed<'v>>, ReadError> {
        let extension = &extensions["KHR_draco_mesh_compression"];
        let Some(number) = extension["bufferView"].as_u64() else {
            return Ok(None);
        };
        let known = self.decoded.borrow().get(&number).cloned();
        let decoded = match known {
            Some(known) => known,
            None => {
                let (bytes, _) = self.arrays.view(number)?;
                let decoded = decode(bytes).map_err(|error| ReadError::Unsupported {
                    at: FilePosition::File,
                    what: error.to_string(),
                    remedy: "write the model without compression",
                })?;
                mesh.stands_for(PLAIN * decoded.vertices);
                let decoded = Rc::new(decoded);
                self.decoded.borrow_mut().insert(number, decoded.clone());
                decoded
            }
        };
        Ok(Some(Compressed::new(decoded, &extension["attributes"])))
    }

    /// The numbers of an attribute of a primitive, if it has it.
    fn attribute(
        &self,
        source: Source<'_, '_>,
        name: &str,
        components: usize,
    ) -> Result<Option<Vec<f64>>, ReadError> {
        if let Some(compressed) = source.compressed
            && let Some(numbers) = compressed.numbers(name, components)?
        {
            return Ok(Some(numbers));
        }
        let accessor = source.attributes[name].as_u64();
        accessor
            .map(|a| self.arrays.numbers(a, components))
            .transpose()
    }

    /// Reads the vertices of a primitive; none if they have no positions.
    fn vertices<'v>(
        &self,
        source: Source<'v, '_>,
        world_from_node: DMat4,
        mesh: &mut Builder,
    ) -> Result<Shared<'v>, ReadError> {
        let mut shared = Shared {
            attributes: source.attributes,
            extensions: source.extensions,
            first: mesh.vertex_count() as u64,
            count: None,
        };
        let numbers = |name: &str, components: usize| self.attribute(source, name, components);
        let Some(positions) = numbers("POSITION", 3)? else {
            return Ok(shared);
        };
        let normals = numbers("NORMAL", 3)?.unwrap_or_default();
        let own = [
            numbers("_TYPE", 1)?.unwrap_or_default(),
            numbers("_POINT", 1)?.unwrap_or_default(),
            numbers("_SECTION", 1)?.unwrap_or_default(),
            numbers("_RADIUS", 1)?.unwrap_or_default(),
        ];
        let (positions, _) = positions.as_chunks::<3>();
        let (normals, _) = normals.as_chunks::<3>();
        for (n, &position) in positions.iter().enumerate() {
            let position = world_from_node.transform_point3(position.into());
            let normal = normals
                .get(n)
                .map_or(DVec3::ZERO, |&normal| DVec3::from(normal));
            let [kind, point, section, radius] = own
                .each_ref()
                .map(|values| values.get(n).copied().unwrap_or_default());
            let vertex = SurfaceVertex {
                position: Vec3::ZERO,
                normal: world_from_node
                    .transform_vector3(normal)
                    .normalize_or_zero()
                    .as_vec3(),
                // Compressed ones may be rounded to steps of less than a half.
                kind: kind.round() as i32,
                point: point.round() as i32,
                section: section.round() as i32,
                radius: radius as f32,
            };
            mesh.vertex(FilePosition::File, position, vertex)?;
        }
        if mesh.wants_own() {
            self.own_numbers(source, positions.len(), mesh)?;
        }
        shared.count = Some(positions.len());
        Ok(shared)
    }

    /// Reads numbers of one's own of the vertices that were read last. Colors and places in pictures are none.
    fn own_numbers(
        &self,
        source: Source<'_, '_>,
        vertices: usize,
        mesh: &mut Builder,
    ) -> Result<(), ReadError> {
        let Source {
            attributes, names, ..
        } = source;
        let accessors = items(self.root, "accessors");
        let of = |number: &Value| item(accessors, number.as_u64().unwrap_or(u64::MAX), "accessor");
        let first = mesh.vertex_count() - vertices;
        for (name, number) in attributes.as_object().into_iter().flatten() {
            let Some(plain) = name
                .strip_prefix('_')
                .filter(|_| !KEPT.contains(&&name[..]))
            else {
                continue;
            };
            let accessor = of(number)?;
            let shape = accessor["type"].as_str().unwrap_or_default();
            let Some(components) = SHAPES.iter().position(|known| *known == shape) else {
                continue;
            };
            let components = components + 1;
            let values = self.attribute(source, name, components)?;
            let values = values.unwrap_or_default();
            let count = values.len() / components;
            if count != vertices {
                let found = format!("{count} numbers of {name} for {vertices} vertices");
                return Err(malformed(FilePosition::File, found, "one for each"));
            }
            let own_name = names[name].as_str().map(str::to_owned);
            let attribute = OwnAttribute {
                name: own_name.unwrap_or_else(|| plain.to_lowercase()),
                components,
                values,
                single: accessor["componentType"] != UNSIGNED_INT,
            };
            mesh.own(FilePosition::File, first, attribute)?;
        }
        Ok(())
    }

    /// Reads the faces of a primitive; those that are compressed are given.
    fn faces(
        &self,
        (primitive, triangles): (&Value, Option<&[[u32; 3]]>),
        Shared { first, count, .. }: Shared<'_>,
        world_from_node: DMat4,
        mesh: &mut Builder,
    ) -> Result<(), ReadError> {
        let Some(count) = count else {
            return Ok(());
        };
        let mode = primitive["mode"].as_u64().unwrap_or(TRIANGLES);
        let corners = match primitive["indices"].as_u64() {
            _ if triangles.is_some() => Vec::new(),
            Some(accessor) => self.arrays.numbers(accessor, 1)?,
            None => (0..count as u32).map(f64::from).collect(),
        };
        // A mirrored node turns its faces round.
        let mirrored = world_from_node.determinant() < 0.0;
        let mut push = |a: f64, b: f64, c: f64| -> Result<(), ReadError> {
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            let mut corners = [0; 3];
            for (corner, number) in corners.iter_mut().zip([a, b, c]) {
                let number = u64::from(index(number, FilePosition::File)?) + first;
                *corner = u32::try_from(number).unwrap_or(u32::MAX);
            }
            mesh.face(FilePosition::File, &corners)
        };
        if let Some(triangles) = triangles {
            let mut all = triangles.iter();
            return all.try_for_each(|t| {
                let [a, b, c] = t.map(f64::from);
                push(a, b, c)
            });
        }
        match mode {
            TRIANGLES => corners
                .as_chunks()
                .0
                .iter()
                .try_for_each(|&[a, b, c]| push(a, b, c)),
            STRIP => corners.windows(3).enumerate().try_for_each(|(n, v)| {
                if n % 2 == 0 {
                    push(v[0], v[1], v[2])
                } else {
                    push(v[1], v[0], v[2])
                }
            }),
            FAN => corners
                .get(1..)
                .unwrap_or_default()
                .windows(2)
                .try_for_each(|pair| push(corners[0], pair[0], pair[1])),
            // Points and lines.
            _ => Ok(()),
        }
    }
}

/// Numbers of vertices that every mesh has.
const KEPT: [&str; 4] = ["_TYPE", "_POINT", "_SECTION", "_RADIUS"];
/// Types of accessors by their number of components.
const SHAPES: [&str; 4] = ["SCALAR", "VEC2", "VEC3", "VEC4"];
/// The component type of glTF whose numbers no `f32` holds.
const UNSIGNED_INT: u32 = 5125;

const TRIANGLES: u64 = 4;
const STRIP: u64 = 5;
const FAN: u64 = 6;

/// The transform of a node: its matrix, or translation · rotation · scale.
fn parent_from_node(node: &Value) -> DMat4 {
    let list =
        |name: &str| -> Vec<f64> { items(node, name).iter().filter_map(Value::as_f64).collect() };
    if let Ok(columns) = <[f64; 16]>::try_from(list("matrix")) {
        return DMat4::from_cols_array(&columns);
    }
    let translation = <[f64; 3]>::try_from(list("translation")).unwrap_or([0.0; 3]);
    let rotation = <[f64; 4]>::try_from(list("rotation")).unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = <[f64; 3]>::try_from(list("scale")).unwrap_or([1.0; 3]);
    DMat4::from_translation(translation.into())
        * DMat4::from_quat(DQuat::from_array(rotation))
        * DMat4::from_scale(scale.into())
}
