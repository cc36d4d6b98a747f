//! A mesh as it is read.

use glam::DVec3;

use super::own::{OwnAttribute, OwnColumns};
use super::{FilePosition, ReadError, malformed};
use crate::{Faces, SurfaceMesh, SurfaceVertex};

/// Collects vertices and faces.
pub(super) struct Builder {
    positions: Vec<DVec3>,
    vertices: Vec<SurfaceVertex>,
    faces: Faces,
    own: OwnColumns,
    /// Vertices and faces that a file of this size may hold: formats with references (glTF, VTU)
    /// could name the same bytes again and again.
    limit: usize,
    /// The highest index that a face named.
    highest: Option<(u32, FilePosition)>,
}

/// Coordinates beyond are refused, so that differences stay finite in 32 bits.
const FARTHEST: f64 = 1e37;

/// Vertices and faces for each byte of a file, at most; a plain file has far less than one.
const PER_BYTE: usize = 8;

impl Builder {
    pub(super) fn new(file_bytes: usize) -> Self {
        Self {
            positions: Vec::new(),
            vertices: Vec::new(),
            faces: Faces::default(),
            own: OwnColumns::default(),
            limit: file_bytes.saturating_mul(PER_BYTE).min(u32::MAX as usize),
            highest: None,
        }
    }

    /// One that takes numbers of one's own, too.
    pub(super) fn with_own(file_bytes: usize) -> Self {
        let mut mesh = Self::new(file_bytes);
        mesh.own.wanted = true;
        mesh
    }

    /// Compressed parts of the file stand for so many bytes more, so that it may hold more.
    pub(super) fn stands_for(&mut self, bytes: usize) {
        let more = bytes.saturating_mul(PER_BYTE);
        self.limit = self.limit.saturating_add(more).min(u32::MAX as usize);
    }

    /// Whether numbers of one's own are wanted.
    pub(super) fn wants_own(&self) -> bool {
        self.own.wanted
    }

    /// Adds numbers of one's own of the vertices from `first` on; see [`OwnColumns::add`].
    pub(super) fn own(
        &mut self,
        at: FilePosition,
        first: usize,
        attribute: OwnAttribute,
    ) -> Result<(), ReadError> {
        self.own.add((first, at), attribute, self.limit)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Adds a vertex; its position is `position`, the other attributes are those of `vertex`.
    pub(super) fn vertex(
        &mut self,
        at: FilePosition,
        position: DVec3,
        vertex: SurfaceVertex,
    ) -> Result<(), ReadError> {
        if !position.abs().cmple(DVec3::splat(FARTHEST)).all() {
            let found = format!("coordinates {position}");
            return Err(malformed(at, found, "finite numbers, none beyond 1e37"));
        }
        self.room(self.positions.len(), at)?;
        self.positions.push(position);
        self.vertices.push(vertex);
        Ok(())
    }

    /// Adds a face of three corners or more.
    pub(super) fn face(&mut self, at: FilePosition, corners: &[u32]) -> Result<(), ReadError> {
        if let Some(&highest) = corners.iter().max()
            && self.highest.is_none_or(|(before, _)| highest > before)
        {
            self.highest = Some((highest, at));
        }
        match *corners {
            [a, b, c] => self.faces.triangles.push([a, b, c]),
            [a, b, c, d] => self.faces.quads.push([a, b, c, d]),
            [first, _, ref rest @ ..] if !rest.is_empty() => {
                let fan = corners[1..]
                    .windows(2)
                    .map(|pair| [first, pair[0], pair[1]]);
                self.faces.triangles.extend(fan);
            }
            _ => {
                let found = format!("a face of {} corners", corners.len());
                return Err(malformed(at, found, "three or more"));
            }
        }
        self.room(self.faces.triangles.len().max(self.faces.quads.len()), at)
    }

    fn room(&self, count: usize, at: FilePosition) -> Result<(), ReadError> {
        if count < self.limit {
            return Ok(());
        }
        let what = "a mesh this much larger than its file".to_owned();
        Err(ReadError::Unsupported {
            at,
            what,
            remedy: "write its parts into the file one by one",
        })
    }

    /// The mesh with numbers of one's own.
    pub(super) fn finish_with_own(mut self) -> Result<(SurfaceMesh, Vec<OwnAttribute>), ReadError> {
        let own = std::mem::take(&mut self.own);
        let own = own.finish(self.positions.len(), self.limit)?;
        Ok((self.finish()?, own))
    }

    /// The mesh, with an origin if the positions need one.
    pub(super) fn finish(mut self) -> Result<SurfaceMesh, ReadError> {
        let vertices = self.positions.len();
        if let Some((index, at)) = self
            .highest
            .filter(|(index, _)| *index as usize >= vertices)
        {
            return Err(ReadError::BadIndex {
                at,
                index,
                vertices,
            });
        }
        let exact = self.positions.iter().all(|p| p.as_vec3().as_dvec3() == *p);
        let origin = if exact {
            DVec3::ZERO
        } else {
            center(&self.positions)
        };
        for (vertex, position) in self.vertices.iter_mut().zip(&self.positions) {
            vertex.position = (position - origin).as_vec3();
        }
        Ok(SurfaceMesh {
            origin,
            vertices: self.vertices,
            faces: self.faces,
        })
    }
}

/// The center of the bounds, rounded to whole micrometers.
fn center(positions: &[DVec3]) -> DVec3 {
    let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = positions
        .iter()
        .copied()
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    (low * 0.5 + high * 0.5).round()
}
