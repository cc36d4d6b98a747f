//! Which rings follow one another, through forks and insets too.

use std::ops::Range;

use neurotess_mesh::{CoarseMesh, PatchKind, Role};

/// Tracing points of a mesh with the tubes and lofts between them. Vertices of somata have none.
pub(super) struct RingGraph {
    /// By the tracing points at their ends.
    tubes: Vec<[u32; 2]>,
    /// Where the neighbors of each tracing point begin in the list, and one past the last.
    first: Vec<u32>,
    neighbors: Vec<u32>,
    /// How far (µm) each of them is.
    ways: Vec<f32>,
}

impl RingGraph {
    pub(super) fn new(mesh: &CoarseMesh) -> Self {
        let mut tubes: Vec<[u32; 2]> = Vec::with_capacity(mesh.tracing.len());
        for patch in &mesh.patches {
            if !matches!(patch.kind, PatchKind::Lateral | PatchKind::Loft) {
                continue;
            }
            let ends = [patch.corners[0], patch.corners[3]];
            let ends = ends.map(|v| mesh.vertices[v as usize].tracing);
            let of_soma = |t: u32| mesh.tracing[t as usize].role == Role::Soma;
            // The four patches of a tube follow one another.
            if tubes.last() != Some(&ends) && !ends.into_iter().any(of_soma) {
                tubes.push(ends);
            }
        }
        let mut first = vec![0_u32; mesh.tracing.len() + 1];
        for &ring in tubes.iter().flatten() {
            first[ring as usize + 1] += 1;
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut fill = first.clone();
        let mut neighbors = vec![0; 2 * tubes.len()];
        let mut ways = vec![0.0; 2 * tubes.len()];
        for &[a, b] in &tubes {
            let [center_a, center_b] = [a, b].map(|t| mesh.tracing[t as usize].center);
            let way = center_a.distance(center_b);
            for (from, to) in [(a, b), (b, a)] {
                let slot = &mut fill[from as usize];
                neighbors[*slot as usize] = to;
                ways[*slot as usize] = way;
                *slot += 1;
            }
        }
        Self {
            tubes,
            first,
            neighbors,
            ways,
        }
    }

    pub(super) fn tubes(&self) -> &[[u32; 2]] {
        &self.tubes
    }

    /// Tracing points at the other ends of the tubes from one.
    pub(super) fn neighbors(&self, of: u32) -> &[u32] {
        &self.neighbors[self.range(of)]
    }

    /// The same, and how far (µm) each is.
    pub(super) fn ways(&self, of: u32) -> impl Iterator<Item = (u32, f32)> {
        let range = self.range(of);
        let neighbors = self.neighbors[range.clone()].iter().copied();
        neighbors.zip(self.ways[range].iter().copied())
    }

    fn range(&self, of: u32) -> Range<usize> {
        let [from, to] = [of, of + 1].map(|ring| self.first[ring as usize] as usize);
        from..to
    }
}
