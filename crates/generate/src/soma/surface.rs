//! Somata: a sphere deformed towards its neurites.
//!
//! **Theory.** García-Cantero et al. 2017: every neurite takes a quad of a tetrahedral sphere; the
//! quad's corners move to the neurite's first ring and the rest follows by static linear
//! elasticity. Where we depart from it: the pull is solved on the canonical sphere, along the
//! radius only, so that one factorization serves all cells; turning and widening the quads is a
//! warp of directions applied to the result ([`warp`]), which cannot fold.
//!
//! **Practice.** [`Reference`] is made once per (sphere, level, ν) and kept; [`rebuild`] per soma.
//!
//! A soma is accepted if it is star-shaped about its center (every quad faces outwards), which excludes
//! folds and self-intersections alike.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use glam::DVec3;

use super::elasticity::Elasticity;
use super::flow::Flow;
use super::insertion_quads::{self, Insertion, InsertionQuads};
use super::profile;
use super::sphere::{self, Sphere};
use crate::{SomaMethod, SphereKind};

/// A soma's surface in µm.
pub(crate) struct SomaSurface {
    /// Positions of all vertices, those of the rings included.
    pub(crate) vertices: Vec<DVec3>,
    /// Quads that are left, counter-clockwise seen from outside.
    pub(crate) quads: Vec<[u32; 4]>,
    /// The four vertices of each neurite's first ring, counter-clockwise about its direction.
    pub(crate) rings: Vec<[u32; 4]>,
    /// Of a neurite that leaves its quad through an inset: the quad, corner by corner of the ring.
    pub(crate) insets: Vec<Option<[u32; 4]>>,
    /// The insertions as they were in the end: direction, distance and radius.
    pub(crate) insertions: Vec<Insertion>,
    /// Rings made smaller to find room, or to avoid folds.
    pub(crate) shrunk: usize,
    /// Rings moved off their neurite's direction by more than a degree.
    pub(crate) turned: usize,
    /// Neurites whose quad was more than 1.5 quad widths away before the warp.
    pub(crate) misfits: usize,
    /// Tetrahedra turned inside out.
    pub(crate) inverted: usize,
    /// Quads that face inwards; zero unless every remedy failed.
    pub(crate) folded: usize,
    /// Neurites that found no insertion quad.
    pub(crate) dropped: Vec<usize>,
}

/// The sphere that a soma is made from, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SomaRequest {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    pub(crate) method: SomaMethod,
    pub(crate) poisson: f64,
    pub(crate) kind: SphereKind,
    pub(crate) level: Option<u32>,
    /// Whether neurites may be left unattached to avoid folds.
    pub(crate) may_leave_out: bool,
    /// Number of remedies against folds that are tried, up to [`ATTEMPTS`].
    pub(crate) attempts: u32,
}

/// A sphere with its factored stiffness, which is made at its first use.
struct Reference {
    sphere: Sphere,
    poisson: f64,
    elasticity: OnceLock<Option<Elasticity>>,
}

impl Reference {
    fn elasticity(&self) -> Option<&Elasticity> {
        // Not by `get_or_init`: a thread that waits for parts of the factor may take up another soma, which
        // would wait for this one.
        if self.elasticity.get().is_none() {
            let made = Elasticity::new(&self.sphere, self.poisson);
            // Another thread may have been faster, with the same.
            let _ = self.elasticity.set(made);
        }
        self.elasticity.get()?.as_ref()
    }
}

/// Rebuilds a soma: rings of the neurites at their traced insertions, joined by a smooth surface.
///
/// Remedies against folds, in turn: a finer sphere with the rings farther apart, smaller rings. A
/// nearer ring is the caller's to try.
pub(crate) fn rebuild(request: &SomaRequest, traced: &[Insertion]) -> SomaSurface {
    if traced.is_empty() {
        return lone(request);
    }
    let finest = finest_fitting(request.kind);
    let mut level = request
        .level
        .unwrap_or_else(|| fitting_level(request.kind, traced));
    for attempt in 0..request.attempts {
        let mut insertions = traced.to_vec();
        let smaller = attempt + 1 == ATTEMPTS;
        if smaller {
            insertions.iter_mut().for_each(|i| i.radius *= 0.7);
        }
        let gap = insertion_quads::MIN_GAP * f64::from(2_u32.pow(attempt));
        let (shrunk, turned) = insertion_quads::make_room(&mut insertions, gap);
        let shrunk = if smaller { traced.len() } else { shrunk };
        let reference = reference(request.kind, level, request.poisson);
        if let Some(insertion_quads) = insertion_quads::assign(&reference.sphere, &insertions) {
            let mut surface = deform(request, &reference, &insertion_quads, &insertions);
            (surface.shrunk, surface.turned) = (shrunk, turned);
            let last = attempt + 1 == request.attempts;
            let enough = !request.may_leave_out || surface.folded == 0;
            if surface.sound() || (last && enough) {
                return surface;
            }
        }
        if request.level.is_none() && level < finest {
            level = (level + finer(request.kind)).min(finest);
        }
    }
    without_thinnest(request, traced)
}

/// A soma that no neurite leaves: the sphere itself.
fn lone(request: &SomaRequest) -> SomaSurface {
    let level = request.level.unwrap_or(match request.kind {
        SphereKind::Octahedron => 3,
        SphereKind::Cube => LONE_LEVEL,
    });
    let reference = reference(request.kind, level, request.poisson);
    let sphere = &reference.sphere;
    let nodes = sphere.nodes[..sphere.surface].iter();
    SomaSurface {
        vertices: nodes
            .map(|&x| request.center + x * request.radius)
            .collect(),
        quads: sphere.quads.clone(),
        rings: Vec::new(),
        insets: Vec::new(),
        insertions: Vec::new(),
        shrunk: 0,
        turned: 0,
        misfits: 0,
        inverted: 0,
        folded: 0,
        dropped: Vec::new(),
    }
}

/// Quads along an edge of the cube of a soma without neurites. Refined, 96 quads are the sphere to some
/// 0.01 % of its volume, and files with tens of thousands of lone soma samples exist.
const LONE_LEVEL: u32 = 4;

/// Tries before a surface with folds is handed back.
pub(crate) const ATTEMPTS: u32 = 3;

fn finer(kind: SphereKind) -> u32 {
    match kind {
        SphereKind::Octahedron => 1,
        SphereKind::Cube => 4,
    }
}

impl SomaSurface {
    /// No fold and no tetrahedron inside out.
    pub(crate) fn sound(&self) -> bool {
        self.folded == 0 && self.inverted == 0
    }
}

fn without_thinnest(request: &SomaRequest, insertions: &[Insertion]) -> SomaSurface {
    let mut order: Vec<usize> = (0..insertions.len()).collect();
    order.sort_by(|&a, &b| insertions[b].radius.total_cmp(&insertions[a].radius));
    let (kept, dropped) =
        order.split_at((insertions.len() * 7 / 8).min(insertions.len().saturating_sub(1)));
    let mut kept = kept.to_vec();
    kept.sort_unstable();
    let subset: Vec<Insertion> = kept.iter().map(|&k| insertions[k]).collect();
    let mut surface = rebuild(request, &subset);
    let mut rings = vec![[0; 4]; insertions.len()];
    let mut insets = vec![None; insertions.len()];
    let mut all = insertions.to_vec();
    for (slot, &k) in kept.iter().enumerate() {
        rings[k] = surface.rings[slot];
        insets[k] = surface.insets[slot];
        all[k] = surface.insertions[slot];
    }
    let inner = surface.dropped.iter().map(|&slot| kept[slot]);
    surface.dropped = dropped.iter().copied().chain(inner).collect();
    surface.rings = rings;
    surface.insets = insets;
    surface.insertions = all;
    surface
}

/// Finest sphere that is tried unless a level is set: beyond, a first soma takes seconds.
fn finest_fitting(kind: SphereKind) -> u32 {
    match kind {
        SphereKind::Octahedron => 4,
        SphereKind::Cube => 14,
    }
}

/// Level at which a quad takes about the angle of the median ring, with quads enough for all.
fn fitting_level(kind: SphereKind, insertions: &[Insertion]) -> u32 {
    if kind == SphereKind::Octahedron {
        return 3;
    }
    let mut angles: Vec<f64> = insertions.iter().map(Insertion::angle).collect();
    angles.sort_by(f64::total_cmp);
    let median = angles.get(angles.len() / 2).copied().unwrap_or(0.15);
    let fit = (std::f64::consts::FRAC_PI_4 * std::f64::consts::SQRT_2 / median).round();
    let room = (4.0 * insertions.len() as f64).sqrt().ceil();
    let level = fit.clamp(6.0, 10.0).max(room).min(14.0) as u32;
    // A sphere that is its own mirror image is factored in a fraction of the time.
    level.next_multiple_of(2)
}

/// Spheres that are kept for later somata: (kind, level, ν in bits).
type Kept = HashMap<(SphereKind, u32, u64), Arc<Reference>>;

fn reference(kind: SphereKind, level: u32, poisson: f64) -> Arc<Reference> {
    static KEPT: Mutex<Option<Kept>> = Mutex::new(None);
    let mut kept = KEPT
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let kept = kept.get_or_insert_default();
    // ν slides in the editor: do not keep every value that it passed.
    if kept.len() > 32 {
        kept.clear();
    }
    let make = || {
        Arc::new(Reference {
            sphere: Sphere::new(kind, level),
            poisson: poisson.clamp(0.0, 0.49),
            elasticity: OnceLock::new(),
        })
    };
    Arc::clone(
        kept.entry((kind, level, poisson.to_bits()))
            .or_insert_with(make),
    )
}

/// Pulls, warps and judges.
fn deform(
    request: &SomaRequest,
    reference: &Reference,
    insertion_quads: &InsertionQuads,
    insertions: &[Insertion],
) -> SomaSurface {
    let sphere = &reference.sphere;
    let warp = Flow::new(sphere, insertion_quads, insertions);
    let pulled = match request.method {
        SomaMethod::Fem => pull(request, reference, insertion_quads, insertions),
        SomaMethod::Sphere | SomaMethod::Profile | SomaMethod::None => sphere.nodes.clone(),
    };
    let mut nodes: Vec<DVec3> = pulled.iter().map(|&x| warp.apply(x)).collect();
    if request.method == SomaMethod::Profile {
        profile::apply(&mut nodes[..sphere.surface], request.radius, insertions);
    }
    let mut rings: Vec<[u32; 4]> = insertion_quads
        .quads
        .iter()
        .map(|&q| sphere.quads[q])
        .collect();
    // What stands off the surface: rings of insets.
    let mut lifted = Vec::new();
    let mut insets = vec![None; rings.len()];
    let mut insertions = insertions.to_vec();
    for ((ring, goals), (insertion, inset)) in rings
        .iter_mut()
        .zip(&warp.rings)
        .zip(insertions.iter_mut().zip(&mut insets))
    {
        if insertion.inset {
            let heights = ring.map(|v| nodes[v as usize].length() * request.radius);
            insertion.raise(heights);
            *inset = Some(*ring);
            let first = (sphere.surface + lifted.len()) as u32;
            *ring = [0, 1, 2, 3].map(|k| first + k);
            lifted.extend(goals.map(|goal| goal * insertion.reach()));
            continue;
        }
        for (&vertex, &goal) in ring.iter().zip(goals) {
            nodes[vertex as usize] = goal * insertion.reach() / request.radius;
        }
    }
    let taken: Vec<bool> = {
        let mut taken = vec![false; sphere.quads.len()];
        insertion_quads.quads.iter().for_each(|&q| taken[q] = true);
        taken
    };
    let left = sphere
        .quads
        .iter()
        .zip(&taken)
        .filter(|(_, taken)| !**taken)
        .map(|(q, _)| *q);
    let quads: Vec<[u32; 4]> = left.collect();
    let inverted = if request.method == SomaMethod::Fem {
        sphere
            .tetrahedra
            .iter()
            .filter(|t| sphere::volume(&nodes, **t) <= 0.0)
            .count()
    } else {
        0
    };
    let folded = sphere.quads.iter().filter(|q| folded(&nodes, **q)).count();
    let width = 2.0 * std::f64::consts::PI.sqrt() / (sphere.quads.len() as f64).sqrt();
    SomaSurface {
        vertices: nodes[..sphere.surface]
            .iter()
            .map(|&x| request.center + x * request.radius)
            .chain(lifted.iter().map(|&x| request.center + x))
            .collect(),
        quads,
        rings,
        insets,
        insertions,
        shrunk: 0,
        turned: 0,
        misfits: usize::from(insertion_quads.worst > 1.5 * width),
        inverted,
        folded,
        dropped: Vec::new(),
    }
}

/// Whether a quad is folded as seen from the center: neither of its diagonals halves it into two
/// triangles that both face outwards.
fn folded(nodes: &[DVec3], quad: [u32; 4]) -> bool {
    let [a, b, c, d] = quad.map(|v| nodes[v as usize]);
    let outwards = |p: DVec3, q: DVec3, r: DVec3| p.dot(q.cross(r)) > 0.0;
    let first = outwards(a, b, c) && outwards(a, c, d);
    let second = outwards(a, b, d) && outwards(b, c, d);
    !first && !second
}

/// The elastic answer, on the canonical sphere of radius 1, to pulling each insertion quad's corners out
/// to where its ring's corners are.
fn pull(
    request: &SomaRequest,
    reference: &Reference,
    insertion_quads: &InsertionQuads,
    insertions: &[Insertion],
) -> Vec<DVec3> {
    let sphere = &reference.sphere;
    let mut prescribed = Vec::with_capacity(4 * insertions.len());
    let pulled = insertion_quads.quads.iter().zip(insertions);
    for (&quad, insertion) in pulled.filter(|(_, insertion)| !insertion.inset) {
        let reach = insertion.reach() / request.radius;
        for vertex in sphere.quads[quad] {
            prescribed.push((vertex, sphere.nodes[vertex as usize] * (reach - 1.0)));
        }
    }
    if prescribed.is_empty() {
        return sphere.nodes.clone();
    }
    let solved = reference.elasticity().and_then(|e| e.solve(&prescribed));
    let Some(displacement) = solved else {
        return sphere.nodes.clone();
    };
    sphere
        .nodes
        .iter()
        .zip(displacement)
        .map(|(&x, u)| x + u)
        .collect()
}
