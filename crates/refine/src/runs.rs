//! Runs of rings in a coarse mesh.

use neurotess_mesh::{CoarseMesh, PatchKind};

/// Most segments of a run; longer ones are cut.
const MAX_SEGMENTS: usize = 1 << 14;
/// In place of a patch where there is none.
pub(crate) const NO_PATCH: u32 = u32::MAX;

/// A run: rings in a row, with lateral patches from each to the next.
#[derive(Clone, Debug)]
pub(crate) struct Tube {
    pub(crate) rings: Vec<[u32; 4]>,
    /// From each ring to the next; [`NO_PATCH`] where a branch leaves.
    pub(crate) patches: Vec<[u32; 4]>,
}

/// Lateral patches between two rings.
struct Segment {
    ring: [u32; 4],
    next: [u32; 4],
    patches: [u32; 4],
}

/// All runs, and the patches that belong to none.
pub(crate) fn find_runs(mesh: &CoarseMesh) -> (Vec<Tube>, Vec<usize>) {
    let mut runs: Vec<Tube> = Vec::new();
    let mut others = Vec::new();
    // Where the last run ends.
    let mut end = usize::MAX;
    let mut i = 0;
    while i < mesh.patches.len() {
        let run = runs.last();
        let run = run.filter(|run| end == i && run.patches.len() < MAX_SEGMENTS);
        let last = run.map(|run| run.rings[run.rings.len() - 1]);
        let open = || last.and_then(|ring| open_segment(mesh, i, ring));
        let Some(segment) = whole_segment(mesh, i).or_else(open) else {
            others.push(i);
            i += 1;
            continue;
        };
        i += segment.patches.iter().filter(|&&p| p != NO_PATCH).count();
        end = i;
        match runs.last_mut() {
            Some(run) if last == Some(segment.ring) => {
                run.rings.push(segment.next);
                run.patches.push(segment.patches);
            }
            _ => runs.push(Tube {
                rings: vec![segment.ring, segment.next],
                patches: vec![segment.patches],
            }),
        }
    }
    (runs, others)
}

/// Four lateral patches that follow one another around a tube.
fn whole_segment(mesh: &CoarseMesh, first: usize) -> Option<Segment> {
    let patches = mesh.patches.get(first..first + 4)?;
    let ring = [0, 1, 2, 3].map(|k: usize| patches[k].corners[0]);
    let next = [0, 1, 2, 3].map(|k: usize| patches[k].corners[3]);
    let fits = (0..4).all(|k| {
        let patch = &patches[k];
        let after = (k + 1) % 4;
        patch.kind == PatchKind::Lateral
            && patch.corners == [ring[k], ring[after], next[after], next[k]]
    });
    fits.then_some(Segment {
        ring,
        next,
        patches: [0, 1, 2, 3].map(|k| first as u32 + k),
    })
}

/// Lateral patches around a tube from a ring on, some of which are missing; all corners of the next ring are
/// in those that are there.
fn open_segment(mesh: &CoarseMesh, first: usize, ring: [u32; 4]) -> Option<Segment> {
    let mut patches = [NO_PATCH; 4];
    let mut next: [Option<u32>; 4] = [None; 4];
    let mut i = first;
    for k in 0..4 {
        let after = (k + 1) % 4;
        let Some(patch) = mesh.patches.get(i) else {
            break;
        };
        let [a, b, c, d] = patch.corners;
        if patch.kind != PatchKind::Lateral || [a, b] != [ring[k], ring[after]] {
            continue;
        }
        if next[k].is_some_and(|v| v != d) || next[after].is_some_and(|v| v != c) {
            return None;
        }
        (next[k], next[after]) = (Some(d), Some(c));
        patches[k] = i as u32;
        i += 1;
    }
    let [Some(a), Some(b), Some(c), Some(d)] = next else {
        return None;
    };
    Some(Segment {
        ring,
        next: [a, b, c, d],
        patches,
    })
}
