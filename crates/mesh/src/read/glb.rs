//! glTF 2.0: GLB, or JSON that embeds its data. All triangles of the scene, nodes transformed. Primitives of a mesh
//! that have the same attributes share their vertices, so that a mesh which is divided by material stays closed.

use std::borrow::Cow;

use glam::{DMat4, DQuat, DVec3, Vec3};
use serde_json::Value;

use super::builder::Builder;
use super::lines::index;
use super::own::OwnAttribute;
use super::{FilePosition, ReadError, base64, malformed};
use crate::SurfaceVertex;

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
    let buffers = items(&root, "buffers")
        .iter()
        .enumerate()
        // Only the first buffer may be the binary chunk.
        .map(|(n, buffer)| data(buffer, binary.filter(|_| n == 0)))
        .collect::<Result<_, _>>()?;
    let scene = Scene {
        root: &root,
        buffers,
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

/// The bytes of a buffer.
fn data<'a>(buffer: &Value, binary: Option<&'a [u8]>) -> Result<Cow<'a, [u8]>, ReadError> {
    let Some(uri) = buffer["uri"].as_str() else {
        return Ok(Cow::Borrowed(binary.unwrap_or_default()));
    };
    let Some((_, text)) = uri
        .split_once(";base64,")
        .filter(|_| uri.starts_with("data:"))
    else {
        let what = format!(
            "the separate file '{}'",
            uri.chars().take(40).collect::<String>()
        );
        let remedy = "write the model as GLB, with its data inside";
        return Err(ReadError::Unsupported {
            at: FilePosition::File,
            what,
            remedy,
        });
    };
    let decoded = base64::decode(text.as_bytes(), usize::MAX).map(Cow::Owned);
    decoded.ok_or_else(|| malformed(FilePosition::File, "a data URI", "base64"))
}

/// Vertices that several primitives of a mesh may have.
#[derive(Clone, Copy)]
struct Shared<'a> {
    attributes: &'a Value,
    /// The number of the first.
    first: u64,
    /// None if they have no positions.
    count: Option<usize>,
}

/// Different attributes in a mesh that are compared with those of the next primitive; files of thousands would make
/// it slow.
const MAX_SHARED: usize = 64;

struct Scene<'a> {
    root: &'a Value,
    buffers: Vec<Cow<'a, [u8]>>,
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
                    let known = read.iter().find(|shared| shared.attributes == attributes);
                    let shared = match known {
                        Some(&shared) => shared,
                        None => {
                            let names = &shape["extras"]["attributes"];
                            self.vertices((attributes, names), world_from_node, mesh)?
                        }
                    };
                    if known.is_none() && read.len() < MAX_SHARED {
                        read.push(shared);
                    }
                    self.faces(primitive, shared, world_from_node, mesh)?;
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

    /// Reads the vertices of a primitive; none if they have no positions. `names`: those of numbers of one's own, by the
    /// names that glTF has for them.
    fn vertices<'v>(
        &self,
        (attributes, names): (&'v Value, &Value),
        world_from_node: DMat4,
        mesh: &mut Builder,
    ) -> Result<Shared<'v>, ReadError> {
        let mut shared = Shared {
            attributes,
            first: mesh.vertex_count() as u64,
            count: None,
        };
        let numbers = |name: &str, components: usize| match attributes[name].as_u64() {
            Some(accessor) => self.numbers(accessor, components).map(Some),
            None => Ok(None),
        };
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
                kind: kind as i32,
                point: point as i32,
                section: section as i32,
                radius: radius as f32,
            };
            mesh.vertex(FilePosition::File, position, vertex)?;
        }
        if mesh.wants_own() {
            self.own_numbers((attributes, names), mesh)?;
        }
        shared.count = Some(positions.len());
        Ok(shared)
    }

    /// Reads numbers of one's own of the vertices that were read last. Colors and places in pictures are none.
    fn own_numbers(
        &self,
        (attributes, names): (&Value, &Value),
        mesh: &mut Builder,
    ) -> Result<(), ReadError> {
        let accessors = items(self.root, "accessors");
        let of = |number: &Value| item(accessors, number.as_u64().unwrap_or(u64::MAX), "accessor");
        let count_of = |accessor: &Value| accessor["count"].as_u64().unwrap_or(0) as usize;
        let vertices = count_of(of(&attributes["POSITION"])?);
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
            let (components, count) = (components + 1, count_of(accessor));
            if count != vertices {
                let found = format!("{count} numbers of {name} for {vertices} vertices");
                return Err(malformed(FilePosition::File, found, "one for each"));
            }
            let own_name = names[name].as_str().map(str::to_owned);
            let attribute = OwnAttribute {
                name: own_name.unwrap_or_else(|| plain.to_lowercase()),
                components,
                values: self.numbers(number.as_u64().unwrap_or(u64::MAX), components)?,
                single: accessor["componentType"] != UNSIGNED_INT,
            };
            mesh.own(FilePosition::File, first, attribute)?;
        }
        Ok(())
    }

    /// Reads the faces of a primitive.
    fn faces(
        &self,
        primitive: &Value,
        Shared { first, count, .. }: Shared<'_>,
        world_from_node: DMat4,
        mesh: &mut Builder,
    ) -> Result<(), ReadError> {
        let Some(count) = count else {
            return Ok(());
        };
        let mode = primitive["mode"].as_u64().unwrap_or(TRIANGLES);
        let corners = match primitive["indices"].as_u64() {
            Some(accessor) => self.numbers(accessor, 1)?,
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

    /// The numbers of an accessor.
    fn numbers(&self, number: u64, components: usize) -> Result<Vec<f64>, ReadError> {
        let accessor = item(items(self.root, "accessors"), number, "accessor")?;
        let Some(view) = accessor["bufferView"]
            .as_u64()
            .filter(|_| accessor["sparse"].is_null())
        else {
            let (what, remedy) = (
                "a sparse accessor",
                "write the model without sparse accessors",
            );
            return Err(ReadError::Unsupported {
                at: FilePosition::File,
                what: what.to_owned(),
                remedy,
            });
        };
        let view = item(items(self.root, "bufferViews"), view, "buffer view")?;
        let buffer = view["buffer"].as_u64().unwrap_or(0);
        let buffer: &[u8] = self.buffers.get(buffer as usize).map_or(&[], AsRef::as_ref);
        let whole = |value: &Value| value.as_u64().unwrap_or(0) as usize;
        let (start, length) = (whole(&view["byteOffset"]), whole(&view["byteLength"]));
        let cut = ReadError::Truncated {
            at: FilePosition::File,
            what: "a buffer view",
        };
        let data = buffer.get(start..start.saturating_add(length)).ok_or(cut)?;

        let kind = whole(&accessor["componentType"]);
        let width = match kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => {
                return Err(malformed(
                    FilePosition::File,
                    format!("component type {kind}"),
                    "5120–5126",
                ));
            }
        };
        let size = width * components;
        let stride = match whole(&view["byteStride"]) {
            0 => size,
            stride if stride >= size => stride,
            stride => {
                return Err(malformed(
                    FilePosition::File,
                    format!("stride {stride}"),
                    "a longer one",
                ));
            }
        };
        let count = whole(&accessor["count"]);
        let data = data
            .get(whole(&accessor["byteOffset"])..)
            .unwrap_or_default();
        // The last element needs no padding up to the stride.
        let held = (data.len() + stride - size) / stride;
        if held < count {
            return Err(ReadError::Truncated {
                at: FilePosition::File,
                what: "an accessor",
            });
        }
        let mut numbers = Vec::with_capacity(count * components);
        for element in data.chunks(stride).take(count) {
            numbers.extend(
                element[..size]
                    .chunks_exact(width)
                    .map(|bytes| component(kind, bytes)),
            );
        }
        Ok(numbers)
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

/// A number of a component type, from as many bytes as it has.
fn component(kind: usize, bytes: &[u8]) -> f64 {
    let mut wide = [0; 4];
    wide[..bytes.len()].copy_from_slice(bytes);
    let bits = u32::from_le_bytes(wide);
    match kind {
        5120 => f64::from(bits as u8 as i8),
        5122 => f64::from(bits as u16 as i16),
        5126 => f64::from(f32::from_bits(bits)),
        _ => f64::from(bits),
    }
}

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

/// A list of an object; empty if it is not there.
fn items<'a>(value: &'a Value, name: &str) -> &'a [Value] {
    value
        .get(name)
        .and_then(Value::as_array)
        .map(Vec::as_slice)
        .unwrap_or_default()
}

fn item<'a>(list: &'a [Value], number: u64, what: &'static str) -> Result<&'a Value, ReadError> {
    list.get(number as usize).ok_or_else(|| {
        let found = format!("{what} {number} of {}", list.len());
        malformed(FilePosition::File, found, "one that is there")
    })
}
