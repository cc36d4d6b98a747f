//! Rings as they were, and as they are drawn in.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role, TracingPoint, Vertex};

use crate::judge::refined_patches::RefinedPatches;
use crate::tubes::{Straight, taper};

/// How a ring differs from how it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drawn {
    /// Share of the radius that is left.
    pub(super) scale: f32,
    /// Way of the center (µm).
    pub(super) shift: Vec3,
}

impl Drawn {
    /// As it was.
    pub(super) const NOT: Self = Self {
        scale: 1.0,
        shift: Vec3::ZERO,
    };
}

/// A tracing point with its vertices, as it was.
pub(super) struct Ring {
    pub(super) point: TracingPoint,
    vertices: Vec<(u32, Vertex)>,
    /// Patches that it is part of, ascending.
    pub(super) patches: Vec<u32>,
    /// Rings at the other ends of tubes that begin here, and of those that end here.
    after: Vec<u32>,
    before: Vec<u32>,
    /// Whether it may be drawn in: no ring on a soma, or beyond the stretch.
    pub(super) free: bool,
}

impl Ring {
    /// All rings of a stretch, by its tracing points. `is_free`: by tracing point of the whole.
    pub(super) fn all(stretch: &RefinedPatches, is_free: impl Fn(u32) -> bool) -> Vec<Self> {
        let mesh = &stretch.part.mesh;
        let of_tube = |role| matches!(role, Role::Ordinary | Role::End | Role::Joint | Role::Inset);
        let points = mesh.tracing.iter().zip(&stretch.part.tracing);
        let mut rings: Vec<Self> = points
            .map(|(point, &whole)| Self {
                point: *point,
                vertices: Vec::new(),
                patches: Vec::new(),
                after: Vec::new(),
                before: Vec::new(),
                free: of_tube(point.role) && is_free(whole),
            })
            .collect();
        for (v, vertex) in (0..).zip(&mesh.vertices) {
            rings[vertex.tracing as usize].vertices.push((v, *vertex));
        }
        for (p, patch) in (0..).zip(&mesh.patches) {
            let points = patch.corners.map(|v| mesh.vertices[v as usize].tracing);
            for t in points {
                add(&mut rings[t as usize].patches, p);
            }
            let [from, _, _, to] = points;
            if from != to {
                add(&mut rings[from as usize].after, to);
                add(&mut rings[to as usize].before, from);
            }
        }
        rings
    }

    pub(super) fn neighbors(&self) -> impl Iterator<Item = usize> {
        let all = self.before.iter().chain(&self.after);
        all.map(|&ring| ring as usize)
    }

    /// Whether its center may move. An inset stands over its trunk.
    pub(super) fn shifts(&self) -> bool {
        self.point.role != Role::Inset
    }

    /// Moves the ring in a mesh in which it has this number.
    pub(super) fn draw(&self, drawn: &Drawn, mesh: &mut CoarseMesh, number: usize) {
        let center = self.point.center + drawn.shift;
        mesh.tracing[number] = TracingPoint {
            center,
            radius: self.point.radius * drawn.scale,
            ..self.point
        };
        for (v, vertex) in &self.vertices {
            let offset = vertex.position - self.point.center;
            mesh.vertices[*v as usize].position = center + offset * drawn.scale;
        }
    }

    /// Leans the normals of a ring between two others by how the tube widens there.
    pub(super) fn lean(&self, mesh: &mut CoarseMesh, number: usize) {
        let (&[before], &[after]) = (&self.before[..], &self.after[..]) else {
            return;
        };
        if self.point.role != Role::Ordinary {
            return;
        }
        let here = mesh.tracing[number];
        let [before, after] = [before, after].map(|ring| mesh.tracing[ring as usize]);
        let lengths = [before, after].map(|ring| here.center.distance(ring.center).into());
        let taper = taper(
            [before, here, after].map(|ring| ring.radius.into()),
            lengths,
            Straight::Across,
        ) as f32;
        mesh.tracing[number].taper = taper;
        for &(v, _) in &self.vertices {
            let vertex = &mut mesh.vertices[v as usize];
            let radial = (vertex.position - here.center).normalize_or(vertex.normal);
            vertex.normal = (radial - here.tangent * taper).normalize_or(radial);
        }
    }

    /// Numbers of its vertices.
    pub(super) fn vertices(&self) -> impl Iterator<Item = u32> {
        self.vertices.iter().map(|&(v, _)| v)
    }
}

/// Adds to a short list what it does not hold.
fn add(list: &mut Vec<u32>, number: u32) {
    if !list.contains(&number) {
        list.push(number);
    }
}
