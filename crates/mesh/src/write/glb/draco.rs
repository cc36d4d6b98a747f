//! GLB with compressed triangles: `KHR_draco_mesh_compression`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_draco_mesh_compression>.
//!
//! **Theory.** A primitive is one stream, which holds its triangles and all numbers of its vertices. What is whole numbers
//! stays so: integers are exact, and smaller than floats of 12 bits, by which `_POINT` would have steps of 1.2 in a cell of
//! 5,000 points. The steps that positions are rounded to follow from the finest edges: with 14 bits, as others round, a
//! third of the triangles of a cell with a long axon have no area.
//!
//! **Practice.** The encoder walks over the whole surface, so it is whole in memory, unlike elsewhere in this crate.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::document::{Arrays, COLOR, FLOAT, SHAPES, TRIANGLES, UNSIGNED_INT, UNSIGNED_SHORT};
use super::{GlbNode, JSON_START, gltf_name};
use crate::draco::{Attribute, AttributeKind, Encoded, Values, encode};
use crate::write::corners::triangles;
use crate::write::{File, WriteError, WriteOptions, agree, record};
use crate::{Format, Surface, SurfaceMesh};

/// Bits of the angles of normals: a step is 0.1°.
const NORMAL_BITS: u8 = 10;
/// Bits of radii: of the widest, which is that around a soma, a 65,536th.
const RADIUS_BITS: u8 = 16;
/// Bits of numbers of one's own, as many as an `f32` has.
const OWN_BITS: u8 = 24;
/// Bits of coordinates, at least and at most.
const POSITION_BITS: [u8; 2] = [16, 24];
/// Steps that the finest edges have, but for one in [`FINEST`]. With 2, 4, 8 and 16 a cell of 5,000 points has 177, 8, 2 and 0
/// triangles without area of 703,824, and its area is 0.4, 0.09, 0.02 and 0.006 % too large; each doubling adds a tenth to
/// the file.
const STEPS: f32 = 8.0;
/// Edges among which one may be finer.
const FINEST: usize = 100;

/// Numbers of an attribute, as they go into the stream.
enum Numbers {
    U8(Vec<u8>),
    U16(Vec<u16>),
    I16(Vec<i16>),
    /// With bits that they are rounded to.
    F32(Vec<f32>, Option<u8>),
}

impl Numbers {
    /// Whole numbers, in the smallest type of glTF that holds them. What none holds is floats, rounded to steps of a quarter
    /// or less, so that rounding them gives the number again.
    fn whole(numbers: &[i32]) -> Self {
        let low = numbers.iter().copied().min().unwrap_or(0);
        let high = numbers.iter().copied().max().unwrap_or(0);
        let all = numbers.iter();
        match (low, high) {
            (0.., ..=0xff) => Self::U8(all.map(|&n| n as u8).collect()),
            (0.., ..=0xffff) => Self::U16(all.map(|&n| n as u16).collect()),
            (-0x8000.., ..=0x7fff) => Self::I16(all.map(|&n| n as i16).collect()),
            _ => {
                let bits = (f64::from(high) - f64::from(low)).log2().ceil() as u8 + 2;
                let bits = (bits <= OWN_BITS).then_some(bits);
                Self::F32(all.map(|&n| n as f32).collect(), bits)
            }
        }
    }

    /// Numbers of one's own: exact where they are whole, or not finite; else rounded to 24 bits.
    fn own(numbers: &[f32]) -> Self {
        let is_whole =
            |n: &f32| n.fract() == 0.0 && (0.0..65_536.0).contains(n) && n.is_sign_positive();
        if numbers.iter().all(is_whole) {
            return Self::whole(&numbers.iter().map(|&n| n as i32).collect::<Vec<_>>());
        }
        let is_finite = numbers.iter().all(|n| n.is_finite());
        Self::F32(numbers.to_vec(), is_finite.then_some(OWN_BITS))
    }

    fn values(&self) -> (Values<'_>, Option<u8>) {
        match self {
            Self::U8(numbers) => (Values::U8(numbers), None),
            Self::U16(numbers) => (Values::U16(numbers), None),
            Self::I16(numbers) => (Values::I16(numbers), None),
            Self::F32(numbers, bits) => (Values::F32(numbers), *bits),
        }
    }

    fn component_type(&self) -> u32 {
        match self {
            Self::U8(_) => 5121,
            Self::U16(_) => UNSIGNED_SHORT,
            Self::I16(_) => 5122,
            Self::F32(..) => FLOAT,
        }
    }
}

/// An attribute of a mesh.
struct Column {
    gltf_name: String,
    /// What one's own is called elsewhere.
    own_name: Option<String>,
    kind: AttributeKind,
    components: usize,
    numbers: Numbers,
    normalized: bool,
}

impl Column {
    fn new(name: &str, kind: AttributeKind, components: usize, numbers: Numbers) -> Self {
        Self {
            gltf_name: name.to_owned(),
            own_name: None,
            kind,
            components,
            numbers,
            normalized: false,
        }
    }

    fn attribute(&self) -> Attribute<'_> {
        let (values, quantization) = self.numbers.values();
        Attribute {
            kind: self.kind,
            components: self.components,
            values,
            quantization,
        }
    }
}

/// A surface as it goes into the file, without its numbers, which the stream has.
struct Compressed {
    stream: Encoded,
    columns: Vec<Column>,
}

/// Writes surfaces with the nodes that show them.
pub(super) fn write(
    surfaces: &[&dyn Surface],
    nodes: &[GlbNode],
    options: &WriteOptions,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let made = surfaces
        .par_iter()
        .map(|&surface| compress(surface, options));
    let made: Vec<Option<Compressed>> = made.collect::<Result<_, _>>()?;
    let origins: Vec<DVec3> = surfaces.iter().map(|surface| surface.origin()).collect();
    let mut arrays = Arrays::default();
    let mut bytes = 0;
    let meshes: Vec<Option<usize>> = made
        .iter()
        .map(|made| Some(arrays.add_compressed(made.as_ref()?, &mut bytes)))
        .collect();
    let mut root = arrays.finish((&meshes, &origins), nodes, bytes);
    if bytes > 0 {
        let extension = json!(["KHR_draco_mesh_compression"]);
        (root["extensionsUsed"], root["extensionsRequired"]) = (extension.clone(), extension);
    }
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let size = JSON_START + json.len() as u64 + if bytes > 0 { 8 + bytes } else { 0 };
    let Ok(total) = u32::try_from(size) else {
        return Err(WriteError::TooLarge {
            format: Format::Glb,
            size,
            unit: "bytes",
        });
    };
    let mut at = 0;
    let head = record![20; u32::from_le_bytes(*b"glTF"), 2u32, total, json.len() as u32,
        u32::from_le_bytes(*b"JSON")];
    file.put(&mut at, &head)?;
    file.put(&mut at, &json)?;
    if bytes > 0 {
        file.put(
            &mut at,
            &record![8; bytes as u32, u32::from_le_bytes(*b"BIN\0")],
        )?;
    }
    for made in made.iter().flatten() {
        file.put(&mut at, &made.stream.bytes)?;
        let padding = made.stream.bytes.len().next_multiple_of(4) - made.stream.bytes.len();
        file.put(&mut at, &[0; 4][..padding])?;
    }
    Ok(())
}

/// Compresses a surface; none if it has no triangles.
fn compress(
    surface: &dyn Surface,
    options: &WriteOptions,
) -> Result<Option<Compressed>, WriteError> {
    let mesh = SurfaceMesh::collect(surface);
    agree("vertices", surface.vertex_count(), mesh.vertices.len())?;
    agree(
        "triangles",
        surface.triangle_count(),
        mesh.faces.triangles.len(),
    )?;
    agree("quads", surface.quad_count(), mesh.faces.quads.len())?;
    if let Some(lost) = mesh.vertices.iter().position(|v| !v.position.is_finite()) {
        return Err(WriteError::NotFinite(lost));
    }
    let triangles: Vec<[u32; 3]> = triangles(&mesh.faces).collect();
    if triangles.is_empty() {
        return Ok(None);
    }
    let columns = columns(surface, &mesh, &triangles, options);
    drop(mesh);
    let attributes: Vec<Attribute<'_>> = columns.iter().map(Column::attribute).collect();
    let stream = encode(&triangles, &attributes)?;
    Ok(Some(Compressed { stream, columns }))
}

/// All that vertices have.
fn columns(
    surface: &dyn Surface,
    mesh: &SurfaceMesh,
    triangles: &[[u32; 3]],
    options: &WriteOptions,
) -> Vec<Column> {
    let vertices = &mesh.vertices;
    let vectors = |of: fn(&crate::SurfaceVertex) -> Vec3| -> Vec<f32> {
        vertices.iter().flat_map(|v| of(v).to_array()).collect()
    };
    let whole = |of: fn(&crate::SurfaceVertex) -> i32| {
        Numbers::whole(&vertices.iter().map(of).collect::<Vec<_>>())
    };
    let bits = position_bits(mesh, triangles);
    let positions = Numbers::F32(vectors(|v| v.position), Some(bits));
    let normals = Numbers::F32(vectors(|v| v.normal), Some(NORMAL_BITS));
    let radii = vertices.iter().map(|v| v.radius).collect();
    let generic = AttributeKind::Generic;
    let mut columns = vec![
        Column::new("POSITION", AttributeKind::Position, 3, positions),
        Column::new("NORMAL", AttributeKind::Normal, 3, normals),
        Column::new("_TYPE", generic, 1, whole(|v| v.kind)),
        Column::new("_POINT", generic, 1, whole(|v| v.point)),
        Column::new("_SECTION", generic, 1, whole(|v| v.section)),
        Column::new(
            "_RADIUS",
            generic,
            1,
            Numbers::F32(radii, Some(RADIUS_BITS)),
        ),
    ];
    if let Some(by) = options.color_by {
        let light = vertices.iter().flat_map(|v| by.light(v)).collect();
        columns.push(Column {
            normalized: true,
            ..Column::new(COLOR, AttributeKind::Color, 3, Numbers::U16(light))
        });
    }
    let mut names = Vec::new();
    for own in surface.attributes() {
        let name = gltf_name(own.name, &names);
        let kind = match &*name {
            COLOR => AttributeKind::Color,
            _ => generic,
        };
        let numbers = match kind {
            AttributeKind::Color => Numbers::F32(own.values.to_vec(), Some(RADIUS_BITS)),
            _ => Numbers::own(own.values),
        };
        columns.push(Column {
            own_name: Some(own.name.to_owned()),
            ..Column::new(&name, kind, own.components, numbers)
        });
        names.push(name);
    }
    columns
}

/// Bits of the longest side of the bounding box, so that its steps are fine enough for the edges.
fn position_bits(mesh: &SurfaceMesh, triangles: &[[u32; 3]]) -> u8 {
    let at = |corner: u32| mesh.vertices[corner as usize].position;
    let known = |&&[a, b, c]: &&[u32; 3]| {
        [a, b, c]
            .iter()
            .all(|&v| (v as usize) < mesh.vertices.len())
    };
    let mut edges: Vec<f32> = triangles
        .iter()
        .filter(known)
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .filter(|(a, b)| a < b)
        .map(|(a, b)| at(a).distance(at(b)))
        .collect();
    let positions = mesh.vertices.iter().map(|v| v.position);
    let low = positions.clone().fold(Vec3::INFINITY, Vec3::min);
    let high = positions.fold(Vec3::NEG_INFINITY, Vec3::max);
    let place = edges.len() / FINEST;
    let [least, most] = POSITION_BITS;
    if edges.is_empty() {
        return least;
    }
    let (_, finest, _) = edges.select_nth_unstable_by(place, f32::total_cmp);
    let steps = STEPS * (high - low).max_element() / *finest;
    // Of edges without length, infinity, or none at all.
    (steps.log2().ceil().clamp(f32::from(least), f32::from(most))) as u8
}

impl Arrays {
    /// Gives the number of the mesh. `bytes`: those of the binary chunk, which grows.
    fn add_compressed(&mut self, made: &Compressed, bytes: &mut u64) -> usize {
        let Compressed { stream, columns } = made;
        let view = self.views.len();
        self.views.push(json!({
            "buffer": 0, "byteOffset": *bytes, "byteLength": stream.bytes.len(),
        }));
        *bytes += stream.bytes.len().next_multiple_of(4) as u64;
        let (mut attributes, mut ids) = (json!({}), json!({}));
        for (column, id) in columns.iter().zip(&stream.attribute_ids) {
            attributes[&column.gltf_name] = json!(self.accessors.len());
            ids[&column.gltf_name] = json!(id);
            let mut accessor = json!({
                "componentType": column.numbers.component_type(), "count": stream.vertices,
                "type": SHAPES[column.components.clamp(1, 4) - 1],
            });
            if column.normalized {
                accessor["normalized"] = json!(true);
            }
            if let (AttributeKind::Position, Some([low, high])) = (column.kind, stream.bounds) {
                (accessor["min"], accessor["max"]) = (json!(low), json!(high));
            }
            self.accessors.push(accessor);
        }
        let indices = self.accessors.len();
        self.accessors.push(json!({
            "componentType": UNSIGNED_INT, "count": 3 * stream.faces, "type": "SCALAR",
        }));
        let is_colored = columns.iter().any(|column| column.normalized);
        let mut primitive: Value = json!({
            "attributes": attributes, "indices": indices, "mode": TRIANGLES,
            "extensions": { "KHR_draco_mesh_compression": { "bufferView": view, "attributes": ids } },
        });
        if is_colored {
            primitive["material"] = json!(self.material(None, true));
        }
        let names = columns.iter();
        let names = names.filter_map(|c| Some((c.own_name.as_deref()?, &*c.gltf_name)));
        self.mesh(&[primitive], names)
    }
}
