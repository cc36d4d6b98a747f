//! Writers of surfaces.
//!
//! **Practice.** A surface is made group by group: some blocks at a time, in parallel, each encoded
//! where it is made, then written in order while the next are made. What is held at a time is four
//! groups a thread, so the surface may be far larger than memory. Sizes are known beforehand, therefore arrays that a
//! format wants one after the other are written side by side, each from its own place in the file;
//! that is what `Seek` is for.

pub(crate) mod corners;
mod glb;
mod in_order;
mod materials;
mod msh;
mod msh2;
mod obj;
mod off;
mod ply;
mod stl;
mod tetgen;
mod vtu;

pub use glb::GlbNode;
pub use materials::{ColorBy, Compression, WriteOptions};
pub use obj::obj_materials;

use std::collections::BTreeSet;
use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::DVec3;

use crate::draco::DracoError;
#[cfg(doc)]
use crate::{FaceLabel, VertexAttribute};
use crate::{Faces, Format, Surface, SurfaceVertex, Unsound, Watched};
use in_order::in_order;

/// Why a surface could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file or stream failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// Indices have 32 bits in these formats.
    #[error(
        "the surface has {0} vertices, files hold at most 4294967295: lower the level, or write \
         several files"
    )]
    TooManyVertices(usize),
    /// The format counts in 32 bits.
    #[error(
        "the surface needs {size} {unit}, {format} holds at most 4294967295: write ply or vtu, or \
         lower the level"
    )]
    TooLarge {
        /// The format.
        format: Format,
        /// How many would be needed.
        size: u64,
        /// Of what: bytes or triangles.
        unit: &'static str,
    },
    /// A vertex has no place: what is drawn from it is not there, and what reads it fails.
    #[error(
        "vertex {0} of the surface is not finite: check the radii and coordinates of the tracing"
    )]
    NotFinite(usize),
    /// It is no surface around its tracing.
    #[error(transparent)]
    Unsound(#[from] Unsound),
    /// It cannot be compressed.
    #[error(transparent)]
    Draco(#[from] DracoError),
    /// A bug of the surface: its blocks hold not what it announced.
    #[error("the surface announced {announced} {what} but its blocks hold {found}")]
    Inconsistent {
        /// Vertices, triangles, quads or numbers.
        what: &'static str,
        /// The count asked for beforehand.
        announced: usize,
        /// The count over all blocks.
        found: usize,
    },
}

/// Writes a surface from the current position of `out` on; coordinates are position + origin (µm).
///
/// | format | encoding | positions | attributes | quads |
/// | --- | --- | --- | --- | --- |
/// | PLY | binary, little endian | f32; f64 if the origin is not zero | all, and [one's own](VertexAttribute) | kept |
/// | OBJ | text | shortest that reads back exactly | normals; type of each face | kept |
/// | STL | binary | f32 | facet normals | split |
/// | GLB | binary | f32, the origin is the node's translation | all, and one's own; a material for each type | split |
/// | OFF | text | shortest that reads back exactly | none | kept |
/// | VTU | XML, raw binary | f32; f64 if the origin is not zero | all, and one's own | kept |
/// | MSH | binary, little endian | f64 | type and section of each face | split |
/// | MSH 2.2 | text | shortest that reads back exactly | type and section of each face | split |
/// | POLY, SMESH | text | shortest that reads back exactly | type of each face | split |
///
/// Writes are large, `out` needs no buffer. STL repeats positions for each face and so holds those
/// of all vertices; the others hold a few blocks. Formats whose faces have a type (see [`FaceLabel`])
/// take several passes. An empty surface gives a valid empty file.
pub fn write<W: Write + Seek>(
    surface: &dyn Surface,
    format: Format,
    out: &mut W,
) -> Result<(), WriteError> {
    write_with(surface, format, &WriteOptions::default(), out).map(drop)
}

/// [`write()`] with options. Gives the types of the faces, of which an OBJ's file of materials must tell; those of
/// other formats are left out.
///
/// # Errors
/// As [`write()`].
pub fn write_with<W: Write + Seek>(
    surface: &dyn Surface,
    format: Format,
    options: &WriteOptions,
    out: &mut W,
) -> Result<BTreeSet<i32>, WriteError> {
    if surface.vertex_count() > u32::MAX as usize {
        return Err(WriteError::TooManyVertices(surface.vertex_count()));
    }
    let watched = Watched::new(surface);
    let surface: &dyn Surface = &watched;
    for attribute in surface.attributes() {
        let announced = attribute.components * surface.vertex_count();
        agree("numbers of an attribute", announced, attribute.values.len())?;
    }
    let mut file = File::begin(out)?;
    let mut kinds = BTreeSet::new();
    match format {
        Format::Ply => ply::write(surface, options.color_by, &mut file),
        Format::Obj => obj::write(surface, options.material_file.as_deref(), &mut file)
            .map(|found| kinds = found),
        Format::Stl => stl::write(surface, &mut file),
        Format::Glb => glb::write(surface, options, &mut file),
        Format::Off => off::write(surface, &mut file),
        Format::Vtu => vtu::write(surface, options.color_by, &mut file),
        Format::Msh => msh::write(surface, &mut file),
        Format::Msh2 => msh2::write(surface, &mut file),
        Format::Poly => tetgen::write_poly(surface, &mut file),
        Format::Smesh => tetgen::write_smesh(surface, &mut file),
    }?;
    file.out.flush()?;
    watched.check()?;
    Ok(kinds)
}

/// Writes several surfaces as one GLB, each shown by nodes: a surface that stands in many places is in the
/// file once. Translations are `f64` in the file, but most readers keep them in `f32`.
///
/// # Errors
/// As [`write()`]; all surfaces together hold at most 4 GiB.
pub fn write_glb<W: Write + Seek>(
    surfaces: &[&dyn Surface],
    nodes: &[GlbNode],
    options: &WriteOptions,
    out: &mut W,
) -> Result<(), WriteError> {
    let most = surfaces.iter().map(|surface| surface.vertex_count()).max();
    if let Some(most) = most.filter(|&most| most > u32::MAX as usize) {
        return Err(WriteError::TooManyVertices(most));
    }
    let watched: Vec<Watched<'_>> = surfaces
        .iter()
        .map(|surface| Watched::new(*surface))
        .collect();
    let surfaces: Vec<&dyn Surface> = watched
        .iter()
        .map(|surface| surface as &dyn Surface)
        .collect();
    let mut file = File::begin(out)?;
    glb::write_all(&surfaces, nodes, options, &mut file)?;
    file.out.flush()?;
    for surface in &watched {
        surface.check()?;
    }
    Ok(())
}

pub(crate) trait WriteSeek: Write + Seek {}

impl<W: Write + Seek> WriteSeek for W {}

/// The output with its position, counted from where we began.
pub(crate) struct File<'a> {
    pub(crate) out: &'a mut dyn WriteSeek,
    base: u64,
    at: u64,
}

impl<'a> File<'a> {
    /// Begins where the stream is.
    pub(crate) fn begin<W: Write + Seek>(out: &'a mut W) -> io::Result<Self> {
        let base = out.stream_position()?;
        Ok(Self { out, base, at: 0 })
    }

    /// Writes at a place and moves the place behind it.
    pub(crate) fn put(&mut self, place: &mut u64, bytes: &[u8]) -> Result<(), WriteError> {
        if bytes.is_empty() {
            return Ok(());
        }
        self.go(*place)?;
        self.out.write_all(bytes)?;
        self.at += bytes.len() as u64;
        *place = self.at;
        Ok(())
    }

    /// Moves to a place.
    fn go(&mut self, place: u64) -> Result<(), WriteError> {
        if place != self.at {
            self.out.seek(SeekFrom::Start(self.base + place))?;
            self.at = place;
        }
        Ok(())
    }

    /// Writes all vertices. `encode` appends a group to `N` buffers, which go to `N` places.
    fn vertices<const N: usize>(
        &mut self,
        surface: &dyn Surface,
        places: &mut [u64; N],
        encode: impl Fn(&[SurfaceVertex], &mut [Vec<u8>; N]) + Sync,
    ) -> Result<(), WriteError> {
        self.vertices_of_blocks(surface, places, |_, group, buffers| encode(group, buffers))
    }

    /// Writes all vertices; `encode` is also told which blocks a group is made of.
    fn vertices_of_blocks<const N: usize>(
        &mut self,
        surface: &dyn Surface,
        places: &mut [u64; N],
        encode: impl Fn(Range<usize>, &[SurfaceVertex], &mut [Vec<u8>; N]) + Sync,
    ) -> Result<(), WriteError> {
        self.vertices_as(surface, encode, |file, _, buffers| {
            file.put_all(places, buffers)
        })
    }

    /// Encodes all vertices group by group and takes them in order; `take` is told which vertices a group has.
    fn vertices_as<const N: usize>(
        &mut self,
        surface: &dyn Surface,
        encode: impl Fn(Range<usize>, &[SurfaceVertex], &mut [Vec<u8>; N]) + Sync,
        mut take: impl FnMut(&mut Self, Range<usize>, &[Vec<u8>; N]) -> Result<(), WriteError>,
    ) -> Result<(), WriteError> {
        let announced = surface.vertex_count();
        let groups = groups(surface.vertex_blocks(), announced);
        // Room of groups that were written, to be used again.
        let spare = Mutex::new(Vec::new());
        let encoded = |blocks: &Range<usize>| {
            let new = || (Vec::new(), [const { Vec::new() }; N]);
            let (mut group, mut buffers) = taken_from(&spare, new);
            group.clear();
            buffers.iter_mut().for_each(Vec::clear);
            for block in blocks.clone() {
                surface.vertices(block, &mut group);
            }
            encode(blocks.clone(), &group, &mut buffers);
            (group, buffers)
        };
        let mut found = 0;
        in_order(&groups, encoded, |(group, buffers)| {
            if let Some(lost) = group.iter().position(|v| !v.position.is_finite()) {
                return Err(WriteError::NotFinite(found + lost));
            }
            let first = found;
            found += group.len();
            take(self, first..found, &buffers)?;
            lock(&spare).push((group, buffers));
            Ok(())
        })?;
        agree("vertices", announced, found)
    }

    /// Writes all faces, as [`File::vertices`] does vertices.
    fn faces<const N: usize>(
        &mut self,
        surface: &dyn Surface,
        places: &mut [u64; N],
        encode: impl Fn(&Faces, &mut [Vec<u8>; N]) + Sync,
    ) -> Result<(), WriteError> {
        self.faces_as(
            surface,
            || [const { Vec::new() }; N],
            |group, buffers| {
                buffers.iter_mut().for_each(Vec::clear);
                encode(group, buffers);
            },
            |file, buffers| file.put_all(places, buffers),
        )
    }

    /// Makes something of all faces, group by group, and takes it in order. `make` gets what `new` gave, or what it
    /// made of an earlier group.
    fn faces_as<T: Send>(
        &mut self,
        surface: &dyn Surface,
        new: impl Fn() -> T + Sync,
        make: impl Fn(&Faces, &mut T) + Sync,
        mut take: impl FnMut(&mut Self, &T) -> Result<(), WriteError>,
    ) -> Result<(), WriteError> {
        let announced = (surface.triangle_count(), surface.quad_count());
        let groups = groups(surface.face_blocks(), announced.0 + announced.1);
        let spare = Mutex::new(Vec::new());
        let made = |blocks: &Range<usize>| {
            let (mut group, mut of_group) = taken_from(&spare, || (Faces::default(), new()));
            group.triangles.clear();
            group.quads.clear();
            for block in blocks.clone() {
                surface.faces(block, &mut group);
            }
            make(&group, &mut of_group);
            (group, of_group)
        };
        let mut found = (0, 0);
        in_order(&groups, made, |(group, of_group)| {
            found = (found.0 + group.triangles.len(), found.1 + group.quads.len());
            take(self, &of_group)?;
            lock(&spare).push((group, of_group));
            Ok(())
        })?;
        agree("triangles", announced.0, found.0)?;
        agree("quads", announced.1, found.1)
    }

    fn put_all<const N: usize>(
        &mut self,
        places: &mut [u64; N],
        buffers: &[Vec<u8>; N],
    ) -> Result<(), WriteError> {
        places
            .iter_mut()
            .zip(buffers)
            .try_for_each(|(place, bytes)| self.put(place, bytes))
    }
}

fn lock<T>(spare: &Mutex<T>) -> MutexGuard<'_, T> {
    spare.lock().unwrap_or_else(PoisonError::into_inner)
}

fn taken_from<T>(spare: &Mutex<Vec<T>>, new: impl FnOnce() -> T) -> T {
    let taken = lock(spare).pop();
    taken.unwrap_or_else(new)
}

pub(crate) fn agree(what: &'static str, announced: usize, found: usize) -> Result<(), WriteError> {
    if announced == found {
        return Ok(());
    }
    Err(WriteError::Inconsistent {
        what,
        announced,
        found,
    })
}

/// Vertices or faces of a group, about: enough for a write, few enough for the cache. A block may hold more.
const GROUP: usize = 1 << 12;

/// Blocks, so many together that a group is worth a write.
pub(crate) fn groups(blocks: usize, items: usize) -> Vec<Range<usize>> {
    let each = (GROUP * blocks).checked_div(items).unwrap_or(blocks).max(1);
    (0..blocks)
        .step_by(each)
        .map(|first| first..blocks.min(first + each))
        .collect()
}

/// The faces of a group.
pub(crate) fn faces_of(surface: &dyn Surface, blocks: Range<usize>) -> Faces {
    let mut faces = Faces::default();
    for block in blocks {
        surface.faces(block, &mut faces);
    }
    faces
}

/// Groups made at a time.
pub(crate) fn window() -> usize {
    2 * rayon::current_num_threads()
}

/// The two triangles of a quad; the same diagonal as everywhere in this crate.
fn split(&[a, b, c, d]: &[u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Appends numbers as bytes.
fn push_numbers(bytes: &mut Vec<u8>, numbers: &[f32]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

/// Position + origin.
fn absolute(vertex: &SurfaceVertex, origin: DVec3) -> [f64; 3] {
    (vertex.position.as_dvec3() + origin).to_array()
}

/// Appends a position as text: the shortest numbers that read back the same, with a space between.
fn push_position(text: &mut Vec<u8>, vertex: &SurfaceVertex, origin: DVec3) {
    let mut buffer = zmij::Buffer::new();
    for (axis, (x, origin)) in vertex
        .position
        .to_array()
        .into_iter()
        .zip(origin.to_array())
        .enumerate()
    {
        if axis > 0 {
            text.push(b' ');
        }
        let number = if origin == 0.0 {
            buffer.format(x)
        } else {
            buffer.format(f64::from(x) + origin)
        };
        text.extend_from_slice(number.as_bytes());
    }
}

/// Appends a number in decimals.
fn push_index(text: &mut Vec<u8>, mut number: u64) {
    let mut digits = [0; 20];
    let mut first = digits.len();
    loop {
        first -= 1;
        digits[first] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            break;
        }
    }
    text.extend_from_slice(&digits[first..]);
}

/// Bytes of numbers, in the order given.
macro_rules! record {
    ($size:literal; $($number:expr),* $(,)?) => {{
        let mut record = [0u8; $size];
        let mut at = 0;
        $(
            let bytes = $number.to_le_bytes();
            record[at..at + bytes.len()].copy_from_slice(&bytes);
            at += bytes.len();
        )*
        debug_assert_eq!(at, $size);
        record
    }};
}
use record;
