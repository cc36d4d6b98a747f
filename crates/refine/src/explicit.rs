//! Which vertices are explicit: those that no point describes accurately enough.

use neurotess_mesh::PatchKind;

use crate::bounding_sphere::sphere_around;
use crate::decode::{POINTS_OF_SPHERE, accurate};
use crate::packer::{Packer, cap_ring};
use crate::runs::{Tube, implicit_ring};

impl Packer<'_> {
    /// Finds the explicit vertices. A ring is implicit, which means that its vertices are computed
    /// from its point, if it is a circle and belongs to a single run, and to no patch outside that
    /// run but its cap.
    pub(crate) fn find_explicit(&mut self) {
        let mut uses = vec![0_u8; self.mesh.vertices.len()];
        for ring in self.runs.iter().flat_map(|run| &run.rings) {
            for &v in ring {
                uses[v as usize] = uses[v as usize].saturating_add(1);
            }
        }
        let mut at_end = vec![false; self.mesh.vertices.len()];
        for run in &self.runs {
            at_end[run.rings[0][0] as usize] = true;
            at_end[run.rings[run.rings.len() - 1][0] as usize] = true;
        }
        for &other in &self.others {
            let patch = &self.mesh.patches[other];
            let ring = cap_ring(patch.corners).filter(|&(first, _)| at_end[first as usize]);
            let plain = patch.kind == PatchKind::Cap && ring.is_some();
            for v in patch.corners {
                self.explicit[v as usize] |= !plain || uses[v as usize] != 1;
            }
        }
        for run in &self.runs {
            for &ring in &run.rings {
                let implicit = implicit_ring(self.mesh, ring).is_some();
                let shared = ring
                    .iter()
                    .any(|&v| uses[v as usize] != 1 || self.explicit[v as usize]);
                if !implicit || shared {
                    ring.iter().for_each(|&v| self.explicit[v as usize] = true);
                }
            }
        }
        // At worst, a sphere holds points of two runs at opposite ends of the mesh.
        let reach = |run: &Tube| {
            let centers = run.rings.iter().map(|ring| (self.center(ring[0]), 0.0));
            sphere_around(centers)
        };
        let whole = sphere_around(self.runs.iter().map(reach)).1;
        let near = self.runs.iter().any(|run| {
            let mut rings = run
                .rings
                .iter()
                .filter(|ring| !self.explicit[ring[0] as usize]);
            rings.any(|ring| !accurate(whole * 1.5, self.radius(ring[0])))
        });
        if near {
            self.make_inaccurate_explicit();
        }
    }

    /// Makes rings explicit whose bounding sphere would be too large for accurate centers.
    fn make_inaccurate_explicit(&mut self) {
        loop {
            let mut found = Vec::new();
            for pile in self.piles(usize::MAX) {
                let rings = self.rings(&pile);
                for chunk in rings.chunks(POINTS_OF_SPHERE) {
                    let radius = self.sphere(chunk).1;
                    let rings = chunk.iter().filter_map(|slot| slot.ring);
                    let implicit = rings.filter(|ring| !self.explicit[ring[0] as usize]);
                    found.extend(implicit.filter(|ring| !accurate(radius, self.radius(ring[0]))));
                }
            }
            if found.is_empty() {
                return;
            }
            for ring in found {
                ring.iter().for_each(|&v| self.explicit[v as usize] = true);
            }
        }
    }
}
