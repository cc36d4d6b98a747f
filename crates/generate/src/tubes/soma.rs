//! Somata in the mesh: their surfaces, and the rings that neurites begin with.

use glam::{DVec3, Vec3};
use neurotess_mesh::{Patch, PatchKind, Role, TracingPoint, Vertex};

use super::assembly::{Assembly, SomaLabel, Somata, sample_id};
use crate::plan::PathEnd;
use crate::soma::{SomaSurface, collar};

impl Assembly<'_> {
    /// Adds all somata.
    pub(super) fn add_somata(&mut self, somata: &Somata<'_>) {
        let stems = self.stems(somata.surfaces.len());
        for (index, (soma, stems)) in somata.surfaces.iter().zip(stems).enumerate() {
            if let (Some(soma), Some(soma_sphere)) = (soma, &somata.soma_spheres[index]) {
                let label = somata.labels[index];
                self.add_soma(&soma.surface, soma_sphere.center, label, &stems);
            }
        }
    }

    /// Paths that begin on each soma, in the order of the tracing.
    fn stems(&self, somata: usize) -> Vec<Vec<u32>> {
        let mut stems: Vec<Vec<u32>> = vec![Vec::new(); somata];
        for (number, path) in (0..).zip(&self.plan.paths) {
            if let PathEnd::Soma(soma) = path.start {
                stems[soma as usize].push(number);
            }
        }
        stems
    }

    /// Adds a soma; `stems`: the paths that begin on its rings, in order.
    fn add_soma(&mut self, surface: &SomaSurface, center: DVec3, label: SomaLabel, stems: &[u32]) {
        // Each vertex of a ring belongs to the tracing point of its neurite, all others to one of their own.
        let mut owner = vec![None; surface.vertices.len()];
        let rings = surface.rings.iter().zip(&surface.insertions);
        for ((&stem, (ring, insertion)), inset) in stems.iter().zip(rings).zip(&surface.insets) {
            let first = &self.plan.paths[stem as usize].rings[0];
            let tracing = match inset {
                Some(quad) => {
                    let place = |v: u32| surface.vertices[v as usize];
                    let lifted = ring.iter().zip(quad);
                    let lifted = lifted.map(|(&over, &under)| place(over) - place(under));
                    self.soma_inset(stem, insertion.axis, lifted.sum::<DVec3>() / 4.0)
                }
                None => self.tracing(first, Role::Insertion),
            };
            ring.iter().for_each(|&v| owner[v as usize] = Some(tracing));
        }
        let first = self.mesh.vertices.len() as u32;
        for (&position, &owner) in surface.vertices.iter().zip(&owner) {
            let tracing = owner.unwrap_or_else(|| {
                self.mesh.tracing.push(TracingPoint {
                    center: center.as_vec3(),
                    radius: position.distance(center) as f32,
                    tangent: Vec3::ZERO,
                    role: Role::Soma,
                    collar: 0.0,
                    taper: 0.0,
                    border: 0,
                    kind: label.kind,
                    sample: sample_id(label.sample),
                    section: label.section,
                });
                self.mesh.tracing.len() as u32 - 1
            });
            self.mesh.vertices.push(Vertex {
                position: position.as_vec3(),
                normal: Vec3::ZERO,
                tracing,
            });
        }
        let shift = |q: [u32; 4]| q.map(|v| v + first);
        for (ring, quad) in surface.rings.iter().zip(&surface.insets) {
            if let Some(quad) = quad {
                self.lofts(shift(*quad), shift(*ring));
            }
        }
        let patches = surface.quads.iter();
        self.mesh.patches.extend(patches.map(|&q| Patch {
            corners: shift(q),
            kind: PatchKind::Soma,
        }));
        let rings = stems.iter().zip(&surface.rings);
        self.soma_rings
            .extend(rings.map(|(&stem, &ring)| (stem, shift(ring))));
    }

    /// The tracing point of a ring that stands over its soma's surface, lifted by so much.
    fn soma_inset(&mut self, stem: u32, axis: DVec3, lifted: DVec3) -> u32 {
        let ring = &self.plan.paths[stem as usize].rings[0];
        let tracing = self.tracing(ring, Role::Inset);
        let point = &mut self.mesh.tracing[tracing as usize];
        point.tangent = axis.as_vec3();
        point.collar = collar(lifted.dot(axis), ring.radius) as f32;
        tracing
    }
}
