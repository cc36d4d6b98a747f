//! The parts of a surface: soma, axon, dendrites, each a surface of its own, cut where the type changes.
//!
//! **Theory.** A face belongs to the part of its type ([`FaceLabel`](crate::FaceLabel)). So each part is open where it
//! hangs on the next. Walls ([`with_walls`](crate::with_walls)) close them: a wall belongs to the soma, and turned round
//! to the neurite behind it.
//!
//! **Practice.** A part is made block by block, as the surface is. What is kept is a bit for each vertex and
//! part, with counts by which a vertex has its number in the part: 1.5 bits a vertex. Finding the parts takes a pass over
//! the vertices and one over the faces, and each part makes all blocks again.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::face_types::{FaceTypes, SectionType, TypesOfGroups, VertexTypes};
use crate::write::agree;
use crate::{Faces, Surface, SurfaceVertex, Unit, WALL, Watched, WriteError};

/// The parts of a surface by type.
pub struct Parts<'s> {
    surface: &'s dyn Surface,
    /// The first vertex of each block.
    starts: Vec<usize>,
    types: VertexTypes,
    walls: Walls,
    /// By type.
    found: BTreeMap<i32, Found>,
}

/// What walls part: types of the soma and of the neurites, as [`Surface::regions`] has them.
struct Walls(Vec<i32>);

/// What a part has.
struct Found {
    vertices: VertexSet,
    triangles: usize,
    quads: usize,
}

/// A part of a surface.
#[derive(Clone, Copy)]
pub struct Part<'p> {
    parts: &'p Parts<'p>,
    kind: i32,
    found: &'p Found,
}

impl<'s> Parts<'s> {
    /// Finds the parts of a surface, whose faces must name its vertices.
    ///
    /// # Errors
    /// As [`write()`](crate::write()) has for what the surface is.
    pub fn find(surface: &'s dyn Surface) -> Result<Self, WriteError> {
        if surface.vertex_count() > u32::MAX as usize {
            return Err(WriteError::TooManyVertices(surface.vertex_count()));
        }
        let (starts, types) = look(surface)?;
        let regions = surface.regions();
        let mut parts = Self {
            surface,
            starts,
            types,
            walls: Walls(regions.iter().map(|region| region.kind).collect()),
            found: BTreeMap::new(),
        };
        parts.found = parts.count()?;
        Ok(parts)
    }

    /// The parts that have faces, by type.
    pub fn iter(&self) -> impl Iterator<Item = Part<'_>> {
        let parts = self.found.iter();
        parts.map(|(&kind, found)| Part {
            parts: self,
            kind,
            found,
        })
    }

    /// Counts the faces of each part and marks their vertices.
    fn count(&self) -> Result<BTreeMap<i32, Found>, WriteError> {
        let words = self.surface.vertex_count().div_ceil(64);
        let counting: BTreeMap<i32, Counting> = self
            .types
            .kinds()
            .into_iter()
            .map(|kind| (kind, Counting::new(words)))
            .collect();
        let [triangles, quads] = [AtomicUsize::new(0), AtomicUsize::new(0)];
        (0..self.surface.face_blocks())
            .into_par_iter()
            .for_each(|block| {
                let mut faces = Faces::default();
                self.surface.faces(block, &mut faces);
                let mut types = self.types.ask();
                for &triangle in &faces.triangles {
                    for (kind, _) in self.walls.owners(types.triangle(triangle)) {
                        if let Some(counting) = counting.get(&kind) {
                            counting.triangles.fetch_add(1, Ordering::Relaxed);
                            counting.mark(&triangle);
                        }
                    }
                }
                for &quad in &faces.quads {
                    if let Some(counting) = counting.get(&types.quad(quad).kind) {
                        counting.quads.fetch_add(1, Ordering::Relaxed);
                        counting.mark(&quad);
                    }
                }
                triangles.fetch_add(faces.triangles.len(), Ordering::Relaxed);
                quads.fetch_add(faces.quads.len(), Ordering::Relaxed);
            });
        let found = [triangles, quads].map(AtomicUsize::into_inner);
        agree("triangles", self.surface.triangle_count(), found[0])?;
        agree("quads", self.surface.quad_count(), found[1])?;
        let counted = counting.into_iter();
        let counted = counted.map(|(kind, counting)| (kind, counting.finish()));
        Ok(counted
            .filter(|(_, found)| found.triangles + found.quads > 0)
            .collect())
    }
}

/// Where blocks of vertices start, and the types of vertices; judges the surface on the way.
fn look(surface: &dyn Surface) -> Result<(Vec<usize>, VertexTypes), WriteError> {
    let watched = Watched::new(surface);
    let types = TypesOfGroups::default();
    let blocks: Vec<(usize, Option<usize>)> = (0..watched.vertex_blocks())
        .into_par_iter()
        .map(|block| {
            let mut vertices = Vec::new();
            watched.vertices(block, &mut vertices);
            types.add(&(block..block + 1), &vertices);
            let lost = vertices.iter().position(|v| !v.position.is_finite());
            (vertices.len(), lost)
        })
        .collect();
    let (mut starts, mut next) = (Vec::with_capacity(blocks.len()), 0);
    for (count, lost) in blocks {
        if let Some(lost) = lost {
            return Err(WriteError::NotFinite(next + lost));
        }
        starts.push(next);
        next += count;
    }
    agree("vertices", surface.vertex_count(), next)?;
    watched.check()?;
    Ok((starts, types.finish()))
}

impl Walls {
    /// The parts that a triangle belongs to, and whether it is turned round there: a wall belongs to two.
    fn owners(&self, at: SectionType) -> impl Iterator<Item = (i32, bool)> {
        let Self(regions) = self;
        let region = |n: usize| regions.get(n).copied();
        let behind = usize::try_from(at.section.unsigned_abs()).unwrap_or(0);
        let owners = match at.kind {
            WALL => [region(0), region(behind)],
            kind => [Some(kind), None],
        };
        owners
            .into_iter()
            .zip([false, true])
            .filter_map(|(kind, turned)| Some((kind?, turned)))
    }

    /// Whether walls look into this part.
    fn look_into(&self, kind: i32) -> bool {
        self.0.first().is_some_and(|&soma| soma != kind)
    }
}

impl Part<'_> {
    /// SWC type of its faces.
    pub fn kind(&self) -> i32 {
        self.kind
    }

    /// Appends its share of some faces, with the surface's numbers of vertices.
    fn take(&self, faces: &Faces, mut types: FaceTypes<'_>, out: &mut Faces) {
        for &triangle in &faces.triangles {
            for (kind, turned) in self.parts.walls.owners(types.triangle(triangle)) {
                let [a, b, c] = triangle;
                if kind == self.kind {
                    out.triangles
                        .push(if turned { [a, c, b] } else { triangle });
                }
            }
        }
        let quads = faces.quads.iter().copied();
        out.quads
            .extend(quads.filter(|&quad| types.quad(quad).kind == self.kind));
    }
}

impl Surface for Part<'_> {
    fn origin(&self) -> DVec3 {
        self.parts.surface.origin()
    }

    fn unit(&self) -> Unit {
        self.parts.surface.unit()
    }

    fn vertex_count(&self) -> usize {
        self.found.vertices.count()
    }

    fn triangle_count(&self) -> usize {
        self.found.triangles
    }

    fn quad_count(&self) -> usize {
        self.found.quads
    }

    fn vertex_blocks(&self) -> usize {
        self.parts.surface.vertex_blocks()
    }

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        let mut all = Vec::new();
        self.parts.surface.vertices(block, &mut all);
        let start = self.parts.starts[block];
        let inwards = self.parts.walls.look_into(self.kind);
        for (n, mut vertex) in all.into_iter().enumerate() {
            if self.found.vertices.has(start + n) {
                if vertex.kind == WALL && inwards {
                    vertex.normal = -vertex.normal;
                }
                out.push(vertex);
            }
        }
    }

    fn face_blocks(&self) -> usize {
        self.parts.surface.face_blocks()
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        let mut all = Faces::default();
        self.parts.surface.faces(block, &mut all);
        let (triangles, quads) = (out.triangles.len(), out.quads.len());
        self.take(&all, self.parts.types.ask(), out);
        let new = out.triangles[triangles..].as_flattened_mut().iter_mut();
        for corner in new.chain(out.quads[quads..].as_flattened_mut()) {
            *corner = self.found.vertices.number(*corner);
        }
    }
}

/// What is counted of a part, on all threads.
struct Counting {
    vertices: Vec<AtomicU64>,
    triangles: AtomicUsize,
    quads: AtomicUsize,
}

impl Counting {
    fn new(words: usize) -> Self {
        Self {
            vertices: (0..words).map(|_| AtomicU64::new(0)).collect(),
            triangles: AtomicUsize::new(0),
            quads: AtomicUsize::new(0),
        }
    }

    fn mark(&self, corners: &[u32]) {
        for &corner in corners {
            let (word, bit) = place(corner as usize);
            // Most are marked already, by a face before.
            if self.vertices[word].load(Ordering::Relaxed) & bit == 0 {
                self.vertices[word].fetch_or(bit, Ordering::Relaxed);
            }
        }
    }

    fn finish(self) -> Found {
        let words = self.vertices.into_iter().map(AtomicU64::into_inner);
        Found {
            vertices: VertexSet::new(words.collect()),
            triangles: self.triangles.into_inner(),
            quads: self.quads.into_inner(),
        }
    }
}

/// Some of the vertices of a surface, numbered.
struct VertexSet {
    words: Vec<u64>,
    /// Vertices before each word, then all.
    before: Vec<u32>,
}

impl VertexSet {
    fn new(words: Vec<u64>) -> Self {
        let mut before = vec![0];
        let mut count = 0;
        before.extend(words.iter().map(|word| {
            count += word.count_ones();
            count
        }));
        Self { words, before }
    }

    fn count(&self) -> usize {
        self.before.last().map_or(0, |&count| count as usize)
    }

    fn has(&self, vertex: usize) -> bool {
        let (word, bit) = place(vertex);
        self.words[word] & bit != 0
    }

    /// The number among them of one of them.
    fn number(&self, vertex: u32) -> u32 {
        let (word, bit) = place(vertex as usize);
        self.before[word] + (self.words[word] & (bit - 1)).count_ones()
    }
}

/// The word of a vertex, and its bit there.
fn place(vertex: usize) -> (usize, u64) {
    (vertex / 64, 1 << (vertex % 64))
}
