//! The faces around vertices, and edits that leave a closed surface closed: an edge is collapsed, or given to
//! the two corners across it. Whether an edit is for the better is for its caller to say.

use glam::DVec3;
use neurotess_mesh::SurfaceVertex;
use smallvec::SmallVec;

use crate::surface::work::Work;

/// Faces around a vertex; few have more than eight.
type Star = SmallVec<[u32; 8]>;

/// A surface with the faces around some of its vertices.
pub(crate) struct Stars<'a> {
    pub(crate) work: &'a mut Work,
    /// Faces of each vertex in the order of their numbers; none where they are not known.
    faces: Vec<Star>,
    /// Faces that were collapsed.
    dead: Vec<bool>,
}

impl<'a> Stars<'a> {
    /// With the faces of those vertices for which `known` holds; edits reach as far as these.
    pub(crate) fn new(work: &'a mut Work, known: impl Fn(u32) -> bool) -> Self {
        let mut faces = vec![Star::new(); work.vertices.len()];
        for (face, corners) in (0..).zip(&work.triangles) {
            for &corner in corners.iter().filter(|&&corner| known(corner)) {
                faces[corner as usize].push(face);
            }
        }
        let dead = vec![false; work.triangles.len()];
        Self { work, faces, dead }
    }

    /// The faces of a vertex, if they are known.
    pub(crate) fn of(&self, vertex: u32) -> Option<&[u32]> {
        let faces = &self.faces[vertex as usize];
        (!faces.is_empty()).then_some(faces)
    }

    /// Whether a face was collapsed.
    pub(crate) fn is_dead(&self, face: u32) -> bool {
        self.dead[face as usize]
    }

    /// Lengths of the sides of a face: from each corner to the next.
    pub(crate) fn lengths(&self, face: u32) -> [f64; 3] {
        let corners = self.work.corners(face);
        [0, 1, 2].map(|n| corners[n].distance(corners[(n + 1) % 3]))
    }

    /// Corners of a face with one of them elsewhere.
    pub(crate) fn corners_with(&self, face: u32, vertex: u32, to: DVec3) -> [DVec3; 3] {
        self.work.triangles[face as usize].map(|corner| match corner == vertex {
            true => to,
            false => self.work.position(corner).as_dvec3(),
        })
    }

    /// Makes one vertex of two, `to`, if the surface is not pinched by that. `choose` gets the faces that
    /// vanish and says what it becomes, or that it may not be.
    pub(crate) fn collapse(
        &mut self,
        from: u32,
        to: u32,
        choose: impl FnOnce(&Self, &[u32]) -> Option<SurfaceVertex>,
    ) -> bool {
        let (Some(star), Some(other)) = (self.of(from), self.of(to)) else {
            return false;
        };
        let shared = common(star, other);
        if !self.may_join(star, other, &shared, [from, to]) {
            return false;
        }
        let Some(joined) = choose(self, &shared) else {
            return false;
        };
        self.work.vertices[to as usize] = joined;
        for face in shared {
            for corner in self.work.triangles[face as usize] {
                self.forget(corner, face);
            }
            self.dead[face as usize] = true;
        }
        for face in std::mem::take(&mut self.faces[from as usize]) {
            let corners = &mut self.work.triangles[face as usize];
            corners
                .iter_mut()
                .filter(|corner| **corner == from)
                .for_each(|corner| *corner = to);
            self.work.changed[face as usize] = true;
            self.note(to, face);
        }
        true
    }

    /// Whether two neighbors may become one vertex without pinching the surface.
    pub(crate) fn may_collapse(&self, from: u32, to: u32) -> bool {
        match (self.of(from), self.of(to)) {
            (Some(star), Some(other)) => {
                self.may_join(star, other, &common(star, other), [from, to])
            }
            _ => false,
        }
    }

    /// Whether two vertices whose faces are known may get an edge: they are two, and have none.
    pub(crate) fn may_connect(&self, one: u32, other: u32) -> bool {
        match (self.of(one), self.of(other)) {
            (Some(star), Some(faces)) => one != other && common(star, faces).is_empty(),
            _ => false,
        }
    }

    /// Whether the only common neighbors of two vertices are those across their edge.
    fn may_join(&self, star: &[u32], other: &[u32], shared: &[u32], ends: [u32; 2]) -> bool {
        let around = |faces: &[u32]| -> Vec<u32> {
            let corners = faces
                .iter()
                .flat_map(|&face| self.work.triangles[face as usize]);
            let mut corners: Vec<u32> = corners.filter(|corner| !ends.contains(corner)).collect();
            corners.sort_unstable();
            corners.dedup();
            corners
        };
        let across = around(shared);
        let roomy = |&corner: &u32| self.of(corner).is_none_or(|star| star.len() > 3);
        shared.len() == 2
            && across.len() == 2
            && common(&around(star), &around(other)) == across
            && across.iter().all(roomy)
    }

    /// Gives a side of a face to the two corners across it, if `is_better` says so of the two faces there and
    /// the two that replace them.
    pub(crate) fn flip(
        &mut self,
        face: u32,
        side: usize,
        is_better: impl FnOnce(&Self, [u32; 2], [[u32; 3]; 2]) -> bool,
    ) -> bool {
        let corners = self.work.triangles[face as usize];
        let [from, to, apex] = [0, 1, 2].map(|n| corners[(side + n) % 3]);
        let Some((other, far)) = self.across(face, from, to) else {
            return false;
        };
        // An edge that is there already would be there twice.
        if !self.may_connect(apex, far) {
            return false;
        }
        let new = [[apex, from, far], [apex, far, to]];
        if !is_better(self, [face, other], new) {
            return false;
        }
        for (face, corners) in [face, other].into_iter().zip(new) {
            self.work.changed[face as usize] = true;
            for corner in std::mem::replace(&mut self.work.triangles[face as usize], corners) {
                self.forget(corner, face);
            }
        }
        for (face, corners) in [face, other].into_iter().zip(new) {
            for corner in corners {
                self.note(corner, face);
            }
        }
        true
    }

    /// The face on the other side of an edge, and its third corner.
    pub(crate) fn across(&self, face: u32, from: u32, to: u32) -> Option<(u32, u32)> {
        let shared = common(self.of(from)?, self.of(to)?);
        let other = *shared.iter().find(|&&other| other != face)?;
        let corners = self.work.triangles[other as usize];
        let far = corners
            .into_iter()
            .find(|&corner| corner != from && corner != to)?;
        (shared.len() == 2).then_some((other, far))
    }

    fn forget(&mut self, vertex: u32, face: u32) {
        self.faces[vertex as usize].retain(|&mut other| other != face);
    }

    /// Adds a face to those of a vertex, if these are known.
    fn note(&mut self, vertex: u32, face: u32) {
        let faces = &mut self.faces[vertex as usize];
        if let Err(at) = faces.binary_search(&face)
            && !faces.is_empty()
        {
            faces.insert(at, face);
        }
    }

    /// Leaves out the faces that were collapsed.
    pub(crate) fn finish(self) {
        if self.dead.contains(&true) {
            self.work.retain(|face| !self.dead[face]);
        }
    }
}

/// What two ascending rows have in common.
fn common(a: &[u32], b: &[u32]) -> Vec<u32> {
    a.iter()
        .copied()
        .filter(|n| b.binary_search(n).is_ok())
        .collect()
}

/// Normal of a triangle, twice as long as its area.
pub(crate) fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
