//! Meshes of neuroglancer, read: legacy ones in one file or several, and the finest level of those with several levels.
//!
//! A path names one as `FOLDER/ID`, where the `info` of the folder says what it holds.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};
use neurotess_formats::precomputed::{Located, Shards};
use neurotess_formats::{Fault, read_regular, unpacked};
use neurotess_mesh::draco::{DracoError, decode};
use neurotess_mesh::{Faces, SurfaceMesh, SurfaceVertex};
use serde::Deserialize;

use crate::skeleton::NM;

/// Why a mesh was not read: `what: what to do`.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshReadError {
    /// A file cannot be read, or a shard is broken.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// Its triangles cannot be read.
    #[error(transparent)]
    Draco(#[from] DracoError),
    /// Something of it is not what it should be.
    #[error("the precomputed mesh is not what it should be ({0}): export it again")]
    Broken(&'static str),
    /// There is no such mesh.
    #[error("no shard has mesh {0}: check the id, and whether all shards were fetched")]
    Missing(u64),
}

use MeshReadError::Broken;

#[derive(Deserialize)]
struct Info {
    #[serde(rename = "@type", default)]
    kind: String,
    transform: Option<Vec<f64>>,
    vertex_quantization_bits: Option<u32>,
    sharding: Option<Shards>,
}

/// Reads the mesh that a path names, in µm; none if it names none.
pub fn read_mesh(path: &Path) -> Option<Result<SurfaceMesh, MeshReadError>> {
    let id: u64 = path.file_name()?.to_str()?.parse().ok()?;
    let folder = path.parent()?;
    let info = read_regular(&folder.join("info")).ok()?;
    let info: Info = serde_json::from_slice(&info).ok()?;
    match info.kind.as_str() {
        "neuroglancer_legacy_mesh" => Some(legacy(folder, id)),
        "neuroglancer_multilod_draco" => Some(multilod(folder, id, &info)),
        _ => None,
    }
}

/// The content of a file, or of the same packed by gzip under its name or with `.gz`, as cloud-volume writes it.
fn content(path: &Path) -> Result<Vec<u8>, MeshReadError> {
    let mut packed = path.as_os_str().to_owned();
    packed.push(".gz");
    let packed = PathBuf::from(packed);
    let path = if packed.is_file() && !path.exists() {
        &packed
    } else {
        path
    };
    Ok(unpacked(read_regular(path).map_err(Fault::Io)?)?)
}

/// A mesh in fragments, each with its own vertices (nm): what several fragments share is shared.
fn legacy(folder: &Path, id: u64) -> Result<SurfaceMesh, MeshReadError> {
    #[derive(Deserialize)]
    struct Manifest {
        fragments: Vec<String>,
    }
    let manifest = content(&folder.join(format!("{id}:0")))?;
    let manifest: Manifest =
        serde_json::from_slice(&manifest).map_err(|_| Broken("its manifest names no fragments"))?;
    let mut joined = Joined::default();
    for name in manifest.fragments {
        // Within the folder only.
        if name.contains(['/', '\\']) {
            return Err(Broken("a fragment is outside of the folder"));
        }
        let bytes = content(&folder.join(name))?;
        let count = bytes
            .first_chunk::<4>()
            .map(|four| u32::from_le_bytes(*four) as usize);
        let vertices = count.and_then(|count| bytes[4..].get(..count.checked_mul(12)?));
        let vertices = vertices.ok_or(Broken("a fragment is shorter than its vertices"))?;
        let corners = &bytes[4 + vertices.len()..];
        if !corners.len().is_multiple_of(12) {
            return Err(Broken("a fragment has a part of a triangle"));
        }
        let floats = vertices
            .as_chunks::<4>()
            .0
            .iter()
            .map(|four| f32::from_le_bytes(*four));
        let floats: Vec<f32> = floats.collect();
        let corners = corners
            .as_chunks::<4>()
            .0
            .iter()
            .map(|four| u32::from_le_bytes(*four));
        let corners: Vec<u32> = corners.collect();
        let points = floats.as_chunks::<3>().0;
        joined.add(corners.as_chunks::<3>().0, points.len(), |vertex| {
            let at = points[vertex];
            // Equal coordinates are one vertex of the whole: fragments repeat those of their borders.
            (
                Some(at.map(|n| u64::from(n.to_bits()))),
                DVec3::from_array(at.map(f64::from)),
            )
        })?;
    }
    joined.finish(None)
}

/// The finest level of a mesh with several.
fn multilod(folder: &Path, id: u64, info: &Info) -> Result<SurfaceMesh, MeshReadError> {
    let bits = info
        .vertex_quantization_bits
        .filter(|bits| [10, 16].contains(bits));
    let bits = bits.ok_or(Broken("its bits of coordinates are neither 10 nor 16"))?;
    let steps = (1_u64 << bits) - 1;
    // Fragments lie directly before the manifest in a shard, or in a file of their own, the finest level first.
    let (manifest, data) = match &info.sharding {
        Some(shards) => {
            shards.check()?;
            let found = shards
                .locate(folder, id)?
                .ok_or(MeshReadError::Missing(id))?;
            let manifest = shards
                .object(folder, id)?
                .ok_or(MeshReadError::Missing(id))?;
            (manifest, found)
        }
        None => {
            let manifest = content(&folder.join(format!("{id}.index")))?;
            let file = folder.join(id.to_string());
            let size = std::fs::metadata(&file).map_err(Fault::Io)?.len();
            (
                manifest,
                Located {
                    file,
                    start: size,
                    size: 0,
                },
            )
        }
    };
    let manifest = Manifest::parse(&manifest)?;
    let all = manifest
        .sizes
        .iter()
        .flatten()
        .map(|&size| u64::from(size))
        .sum();
    let first = data.start.checked_sub(all);
    let first = first.ok_or(Broken("its fragments are more than its file"))?;
    let finest = manifest
        .sizes
        .first()
        .map_or(0, |sizes| sizes.iter().map(|&n| n as usize).sum());
    neurotess_formats::regular(&data.file).map_err(Fault::Io)?;
    let mut file = File::open(&data.file).map_err(Fault::Io)?;
    let mut bytes = vec![0; finest];
    file.seek(SeekFrom::Start(first)).map_err(Fault::Io)?;
    file.read_exact(&mut bytes).map_err(Fault::Io)?;
    let mut joined = Joined::default();
    let mut rest = &bytes[..];
    let sizes = manifest.sizes.first().into_iter().flatten();
    for (node, &size) in manifest.nodes.iter().zip(sizes) {
        let (fragment, others) = rest.split_at(size as usize);
        rest = others;
        if fragment.is_empty() {
            continue;
        }
        let decoded = decode(fragment)?;
        let positions = decoded
            .attributes
            .iter()
            .find(|attribute| attribute.components == 3);
        let positions = positions.ok_or(Broken("a fragment has no positions"))?;
        joined.add(&decoded.triangles, decoded.vertices, |vertex| {
            let stored: [f64; 3] = std::array::from_fn(|axis| positions.values[3 * vertex + axis]);
            let within = DVec3::from_array(stored) / steps as f64;
            let place = manifest.origin
                + manifest.offset
                + manifest.chunk * (DVec3::from_array(node.map(f64::from)) + within);
            // Fragments meet in the planes of their nodes, where they repeat vertices: one number through all of them.
            let whole: [u64; 3] =
                std::array::from_fn(|axis| u64::from(node[axis]) * steps + stored[axis] as u64);
            let meets = stored.iter().any(|&s| s <= 0.0 || s >= steps as f64);
            (meets.then_some(whole), place)
        })?;
    }
    joined.finish(info.transform.as_deref())
}

/// What a manifest says of the levels.
struct Manifest {
    /// Sides of a node of the finest level, near corner of the grid, and what the finest level is moved by.
    chunk: DVec3,
    origin: DVec3,
    offset: DVec3,
    /// Nodes of the finest level.
    nodes: Vec<[u32; 3]>,
    /// Bytes of the fragments of each level.
    sizes: Vec<Vec<u32>>,
}

impl Manifest {
    fn parse(bytes: &[u8]) -> Result<Self, MeshReadError> {
        let words: Vec<u32> = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|four| u32::from_le_bytes(*four))
            .collect();
        let mut rest = &words[..];
        let mut take = |count: usize| {
            let (taken, others) = rest
                .split_at_checked(count)
                .ok_or(Broken("its manifest is cut off"))?;
            rest = others;
            Ok::<_, MeshReadError>(taken.to_vec())
        };
        let point = |words: &[u32]| {
            let of = |axis: usize| f64::from(f32::from_bits(words[axis]));
            DVec3::new(of(0), of(1), of(2))
        };
        let (chunk, origin) = (point(&take(3)?), point(&take(3)?));
        let levels = take(1)?[0] as usize;
        take(levels)?;
        let offsets = take(levels.saturating_mul(3))?;
        let counts = take(levels)?;
        if levels == 0 {
            return Err(Broken("its manifest has no level"));
        }
        let (mut nodes, mut sizes) = (Vec::new(), Vec::new());
        for (level, &count) in counts.iter().enumerate() {
            let count = count as usize;
            let places = take(count.saturating_mul(3))?;
            if level == 0 {
                let of = |n: usize| [places[n], places[count + n], places[2 * count + n]];
                nodes = (0..count).map(of).collect();
            }
            sizes.push(take(count)?);
        }
        Ok(Self {
            chunk,
            origin,
            offset: point(&offsets),
            nodes,
            sizes,
        })
    }
}

/// Fragments that are put together.
#[derive(Default)]
struct Joined {
    places: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Vertices that several fragments have, by their exact coordinates.
    shared: HashMap<[u64; 3], u32>,
}

impl Joined {
    /// Adds a fragment. `vertex`: the place (nm), and by what it is the same as one of another fragment.
    fn add(
        &mut self,
        triangles: &[[u32; 3]],
        vertices: usize,
        vertex: impl Fn(usize) -> (Option<[u64; 3]>, DVec3),
    ) -> Result<(), MeshReadError> {
        let mut numbers = Vec::with_capacity(vertices);
        for index in 0..vertices {
            let (same, place) = vertex(index);
            let next = self.places.len() as u32;
            let number = same.map_or(next, |same| *self.shared.entry(same).or_insert(next));
            if number == next {
                self.places.push(place);
            }
            numbers.push(number);
        }
        for triangle in triangles {
            let corner = |&corner: &u32| numbers.get(corner as usize).copied();
            let [Some(a), Some(b), Some(c)] = [
                corner(&triangle[0]),
                corner(&triangle[1]),
                corner(&triangle[2]),
            ] else {
                return Err(Broken(
                    "a triangle has a corner that is none of its vertices",
                ));
            };
            self.triangles.push([a, b, c]);
        }
        Ok(())
    }

    /// The mesh in µm, after the transform of the `info`.
    fn finish(self, transform: Option<&[f64]>) -> Result<SurfaceMesh, MeshReadError> {
        let rows = transform.map(<[f64; 12]>::try_from).transpose();
        let rows = rows.map_err(|_| Broken("its transform has no twelve numbers"))?;
        let column = |rows: &[f64; 12], at: usize| DVec3::new(rows[at], rows[4 + at], rows[8 + at]);
        let (linear, translation) = rows.map_or((DMat3::IDENTITY, DVec3::ZERO), |rows| {
            let linear = DMat3::from_cols(column(&rows, 0), column(&rows, 1), column(&rows, 2));
            (linear, column(&rows, 3))
        });
        let places: Vec<DVec3> = self
            .places
            .iter()
            .map(|&p| (linear * p + translation) / NM)
            .collect();
        if !places.iter().all(|p| p.is_finite()) {
            return Err(Broken("a vertex is no place"));
        }
        let origin = places.first().copied().unwrap_or_default();
        let vertices = places.iter().map(|&place| SurfaceVertex {
            position: (place - origin).as_vec3(),
            ..SurfaceVertex::default()
        });
        Ok(SurfaceMesh {
            origin,
            vertices: vertices.collect(),
            faces: Faces {
                triangles: self.triangles,
                ..Faces::default()
            },
        })
    }
}
