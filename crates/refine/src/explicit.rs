//! Which vertices are explicit: those that no point describes accurately enough.

use neurotess_mesh::PatchKind;

use crate::bounding_sphere::sphere_around;
use crate::decode::{POINTS_OF_SPHERE, accurate};
use crate::packer::{Packer, Pile, cap_ring};
use crate::runs::Tube;

impl Packer<'_> {
    /// Finds the explicit vertices. A ring is implicit, which means that its vertices are computed
    /// from its point, if it is a circle and belongs to a single run, and to no patch outside that
    /// run but its cap. Other rings of a single run, those at bends among them, are shaped, if they are near enough to what
    /// can be computed.
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
                self.named[v as usize] |= !plain;
                self.explicit[v as usize] |= uses[v as usize] != 1;
            }
        }
        for run in 0..self.runs.len() {
            for i in 0..self.runs[run].rings.len() {
                let ring = self.runs[run].rings[i];
                let shared = ring.iter().any(|&v| uses[v as usize] != 1);
                if !shared && self.fit(ring).is_none() {
                    // At a bend: no circle, and perhaps a shaped ring.
                    ring.iter().for_each(|&v| self.named[v as usize] = true);
                }
                if shared || self.fit(ring).is_none() {
                    ring.iter().for_each(|&v| self.explicit[v as usize] = true);
                }
            }
        }
        self.spread_explicit();
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
            self.spread_explicit();
        }
    }

    /// Makes shaped rings explicit whose patches are in several parts. Returns whether there were any.
    pub(crate) fn make_parted_explicit(&mut self, piles: &[Pile]) -> bool {
        let mut pile_of = vec![usize::MAX; self.runs.len()];
        for (p, pile) in piles.iter().enumerate() {
            pile.runs.iter().for_each(|&run| pile_of[run] = p);
        }
        let mut found = false;
        for (p, pile) in piles.iter().enumerate() {
            for &other in &pile.others {
                for v in self.mesh.patches[other].corners.map(|v| v as usize) {
                    if !self.explicit[v] && pile_of[self.run_of[v] as usize] != p {
                        self.explicit[v] = true;
                        found = true;
                    }
                }
            }
        }
        if found {
            self.spread_explicit();
        }
        found
    }

    /// Makes a ring explicit where one of its vertices is, and both rings beside a branch where one of them
    /// is: shaders order corners by their kinds, and the side of a loft must have the direction of the tube
    /// beside it.
    fn spread_explicit(&mut self) {
        loop {
            let mut changed = false;
            for ring in self.runs.iter().flat_map(|run| &run.rings) {
                let count = ring.iter().filter(|&&v| self.explicit[v as usize]).count();
                if (1..4).contains(&count) {
                    ring.iter().for_each(|&v| self.explicit[v as usize] = true);
                    changed = true;
                }
            }
            for &other in &self.others {
                let patch = &self.mesh.patches[other];
                let [a, b, ..] = patch.corners.map(|v| v as usize);
                if patch.kind == PatchKind::Loft && self.explicit[a] != self.explicit[b] {
                    (self.explicit[a], self.explicit[b]) = (true, true);
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }
}
