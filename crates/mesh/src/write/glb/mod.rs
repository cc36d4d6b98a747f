//! GLB, glTF 2.0: <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.
//!
//! Vertices are interleaved, 40 bytes each, 48 with colors, so that one pass over the surface writes them. The
//! bounds that glTF asks for are known only after it: the JSON comes first in the file, therefore
//! it gets room for the longest numbers and is written last. Several surfaces follow one another in the
//! binary chunk; nodes show each where it stands, as often as they like.
//!
//! A surface has a primitive for each type, with the material of the type; all share its vertices, so the mesh is
//! closed by its indices. Which types there are is known when the vertices have been made. The JSON has room for
//! [`ROOM`] to a surface, and if there are more, the file is written again with as much room as it needs. **Why not**
//! look first: a pass over the vertices takes two fifths of writing.

mod document;
mod draco;

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use glam::{DAffine3, DVec3, Vec3};

use super::{Compression, File, WriteError, WriteOptions, push_numbers, record, split};
use crate::face_types::{TypesOfGroups, VertexTypes};
use crate::{Faces, Format, Surface};
use document::{COLOR, document};

/// Bytes of a vertex, and of one with a color, which is padded to a multiple of 4.
const STRIDES: [u64; 2] = [40, 48];

/// Types of a surface that the JSON has room for in any case: as many as have names in SWC.
const ROOM: usize = 5;

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

/// A name as glTF wants those that are not its own, unless another attribute has it.
fn gltf_name(name: &str, others: &[String]) -> String {
    if name == COLOR {
        return name.into();
    }
    let mut upper = format!("_{}", name.to_uppercase());
    while others.contains(&upper) {
        upper.push('_');
    }
    upper
}

/// Where numbers of one's own lie in the binary chunk.
struct OwnSpan {
    name: String,
    gltf_name: String,
    components: usize,
    start: u64,
}

/// Where the arrays of a surface lie in the binary chunk.
struct Span {
    vertices: u64,
    /// Bytes of a vertex.
    stride: u64,
    first_vertex: u64,
    indices: u64,
    first_index: u64,
    /// Of positions.
    bounds: [Vec3; 2],
    /// Numbers of one's own.
    own: Vec<OwnSpan>,
    /// Indices of each type, in the order of the primitives; none if there are no materials.
    kinds: BTreeMap<i32, u64>,
}

pub(super) fn write(
    surface: &dyn Surface,
    options: &WriteOptions,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let here = GlbNode {
        name: String::new(),
        surface: 0,
        world_from_surface: DAffine3::IDENTITY,
    };
    write_all(&[surface], &[here], options, file)
}

/// Writes surfaces with the nodes that show them.
pub(super) fn write_all(
    surfaces: &[&dyn Surface],
    nodes: &[GlbNode],
    options: &WriteOptions,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    if let Some(Compression::Draco) = options.compression {
        return draco::write(surfaces, nodes, options, file);
    }
    let materials = options.glb_materials;
    let stride = STRIDES[usize::from(options.color_by.is_some())];
    let mut spans = Vec::new();
    let mut binary = 0;
    for surface in surfaces {
        let vertices = surface.vertex_count() as u64;
        let faces = surface.triangle_count() as u64 + 2 * surface.quad_count() as u64;
        // As many as there is room for, with the longest name.
        let kinds = (i32::MIN..).take(if materials { ROOM } else { 0 });
        let first_vertex = binary;
        binary += stride * vertices + 12 * faces;
        let mut own: Vec<OwnSpan> = Vec::new();
        for a in surface.attributes() {
            let others: Vec<String> = own.iter().map(|own| own.gltf_name.clone()).collect();
            own.push(OwnSpan {
                name: a.name.to_owned(),
                gltf_name: gltf_name(a.name, &others),
                components: a.components,
                start: binary,
            });
            binary += 4 * a.values.len() as u64;
        }
        spans.push(Span {
            vertices,
            stride,
            first_vertex,
            indices: 3 * faces,
            first_index: first_vertex + stride * vertices,
            bounds: [Vec3::ZERO; 2],
            own,
            kinds: kinds.map(|kind| (kind, 3 * faces)).collect(),
        });
    }
    let origins: Vec<DVec3> = surfaces.iter().map(|surface| surface.origin()).collect();
    loop {
        // Six bounds of at most 25 characters instead of `0.0`; then to a multiple of 4.
        let longest = document(&spans, &origins, nodes).to_string().len() + 6 * 22 * spans.len();
        let json_bytes = (longest as u64).next_multiple_of(4);
        let chunk = if binary > 0 { 8 } else { 0 };
        let start = JSON_START + json_bytes + chunk;
        let size = start + binary;
        let Ok(total) = u32::try_from(size) else {
            return Err(WriteError::TooLarge {
                format: Format::Glb,
                size,
                unit: "bytes",
            });
        };
        for (surface, span) in surfaces.iter().zip(&mut spans) {
            write_surface(*surface, start, options, span, file)?;
        }
        let json = document(&spans, &origins, nodes).to_string();
        if json.len() as u64 > json_bytes {
            continue;
        }
        let mut head = Vec::new();
        head.extend_from_slice(&record![20;
            u32::from_le_bytes(*b"glTF"), 2u32, total, json_bytes as u32,
            u32::from_le_bytes(*b"JSON")]);
        head.extend_from_slice(json.as_bytes());
        head.resize((JSON_START + json_bytes) as usize, b' ');
        if binary > 0 {
            head.extend_from_slice(&record![8; binary as u32, u32::from_le_bytes(*b"BIN\0")]);
        }
        file.put(&mut 0, &head)?;
        return file.go(size);
    }
}

/// Writes the arrays of a surface, and tells the span of the bounds of its positions and of its types.
fn write_surface(
    surface: &dyn Surface,
    start: u64,
    options: &WriteOptions,
    span: &mut Span,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let materials = options.glb_materials;
    let bounds = Mutex::new([Vec3::INFINITY, Vec3::NEG_INFINITY]);
    let types = TypesOfGroups::default();
    file.vertices_of_blocks(
        surface,
        &mut [start + span.first_vertex],
        |blocks, group, [bytes]| {
            if materials {
                types.add(&blocks, group);
            }
            let mut mine = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            bytes.reserve(span.stride as usize * group.len());
            for v in group {
                let (p, n) = (v.position, v.normal);
                mine = [mine[0].min(p), mine[1].max(p)];
                bytes.extend_from_slice(&record![40;
                p.x, p.y, p.z, n.x, n.y, n.z,
                v.kind as f32, v.point as f32, v.section as f32, v.radius]);
                if let Some(by) = options.color_by {
                    let [r, g, b] = by.light(v);
                    bytes.extend_from_slice(&record![8; r, g, b, 0u16]);
                }
            }
            let mut bounds = bounds.lock().unwrap_or_else(PoisonError::into_inner);
            *bounds = [bounds[0].min(mine[0]), bounds[1].max(mine[1])];
        },
    )?;
    span.bounds = bounds.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut bytes = Vec::new();
    for (attribute, own) in surface.attributes().iter().zip(&span.own) {
        bytes.clear();
        push_numbers(&mut bytes, attribute.values);
        file.put(&mut (start + own.start), &bytes)?;
    }
    span.kinds.clear();
    if materials {
        let runs = runs(surface, &types.finish(), file)?;
        for &(kind, count) in runs.iter().flatten() {
            *span.kinds.entry(kind).or_default() += 3 * count;
        }
        return write_by_type(surface, &runs, start, span, file);
    }
    file.faces(
        surface,
        &mut [start + span.first_index],
        |group, [bytes]| {
            bytes.reserve(12 * (group.triangles.len() + 2 * group.quads.len()));
            for [a, b, c] in halved(group) {
                bytes.extend_from_slice(&record![12; a, b, c]);
            }
        },
    )
}

/// Triangles with the same type, one after another: the type, and how many.
type KindRun = (i32, u64);

/// The types of the triangles of each group. They are looked up once, and there are few runs.
fn runs(
    surface: &dyn Surface,
    types: &VertexTypes,
    file: &mut File<'_>,
) -> Result<Vec<Vec<KindRun>>, WriteError> {
    let mut all = Vec::new();
    file.faces_as(
        surface,
        Vec::new,
        |group, runs: &mut Vec<KindRun>| {
            runs.clear();
            let mut ask = types.ask();
            for triangle in halved(group) {
                let here = ask.triangle(triangle).kind;
                match runs.last_mut() {
                    Some((kind, count)) if *kind == here => *count += 1,
                    _ => runs.push((here, 1)),
                }
            }
        },
        |_, runs| {
            all.push(runs.clone());
            Ok(())
        },
    )?;
    Ok(all)
}

/// Writes the indices of each type behind those of the one before.
fn write_by_type(
    surface: &dyn Surface,
    runs: &[Vec<KindRun>],
    start: u64,
    span: &Span,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let mut next = start + span.first_index;
    let mut places = BTreeMap::new();
    for (&kind, &indices) in &span.kinds {
        places.insert(kind, next);
        next += 4 * indices;
    }
    let mut groups = runs.iter();
    file.faces_as(
        surface,
        Vec::new,
        |group, bytes: &mut Vec<u8>| {
            bytes.clear();
            bytes.reserve(12 * (group.triangles.len() + 2 * group.quads.len()));
            for [a, b, c] in halved(group) {
                bytes.extend_from_slice(&record![12; a, b, c]);
            }
        },
        |file, bytes| {
            // Types may change with each triangle of other people's meshes: each is written once for a group.
            let mut of_kinds: BTreeMap<i32, Vec<u8>> = BTreeMap::new();
            let mut rest = &bytes[..];
            for &(kind, count) in groups.next().into_iter().flatten() {
                let (run, behind) = rest.split_at(rest.len().min(12 * count as usize));
                of_kinds.entry(kind).or_default().extend_from_slice(run);
                rest = behind;
            }
            for (kind, bytes) in of_kinds {
                if let Some(place) = places.get_mut(&kind) {
                    file.put(place, &bytes)?;
                }
            }
            Ok(())
        },
    )
}

/// All triangles of a group, halves of quads last.
fn halved(group: &Faces) -> impl Iterator<Item = [u32; 3]> {
    let halves = group.quads.iter().flat_map(split);
    group.triangles.iter().copied().chain(halves)
}
