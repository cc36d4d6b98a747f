//! Somata: what was traced, drawn out towards the neurites.
//!
//! **Theory.** García-Cantero et al. 2017: every neurite takes a quad of a tetrahedral sphere; the
//! quad's corners move to the neurite's first ring and the rest follows by static linear
//! elasticity. Where we depart from it: the pull is solved on the canonical sphere, along the
//! radius only, so that one factorization serves all cells; turning and widening the quads is a
//! warp of directions applied to the result ([`warp`]), which cannot fold. And the sphere is only where it is solved: in
//! each direction the result is multiplied by the distance of the traced surface, and the whole by a size that keeps
//! the traced volume ([`draft`](super::draft)).
//!
//! **Practice.** [`Reference`] is made once per (sphere, level, ν) and kept; [`rebuild`] per soma.
//!
//! A soma is accepted if it is star-shaped about its center (every quad faces outwards), which excludes
//! folds and self-intersections alike.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use glam::{DMat3, DVec3};

use super::draft::Draft;
use super::elasticity::Elasticity;
use super::flow::{Flow, Stretch};
use super::insertion_quads::{self, Insertion, InsertionQuads};
use super::profile;
use super::pull::Pull;
use super::soma_surface::{ATTEMPTS, SomaRequest, SomaSurface};
use super::sphere::Sphere;
use crate::{SomaMethod, SphereKind};

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
pub(crate) fn rebuild(request: &SomaRequest<'_>, traced: &[Insertion]) -> SomaSurface {
    if traced.is_empty() {
        return lone(request);
    }
    let finest = finest_fitting(request.kind);
    let mut level = request
        .level
        .unwrap_or_else(|| fitting_level(request, traced));
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
        let stretch = Stretch::of(request.soma);
        let directions = insertions.iter().map(|i| stretch.undo(i.foot));
        let directions: Vec<DVec3> = directions.collect();
        let assigned = insertion_quads::assign(&reference.sphere, &insertions, &directions);
        if let Some(insertion_quads) = assigned {
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

/// A soma that no neurite leaves: what was traced itself.
fn lone(request: &SomaRequest<'_>) -> SomaSurface {
    let level = request.level.unwrap_or(match request.kind {
        SphereKind::Octahedron => 3,
        SphereKind::Cube if request.soma.is_sphere() => LONE_LEVEL,
        SphereKind::Cube => SHAPED_LEVEL,
    });
    let reference = reference(request.kind, level, request.poisson);
    let none = InsertionQuads {
        rotation: DMat3::IDENTITY,
        quads: Vec::new(),
        worst: 0.0,
    };
    deform(request, &reference, &none, &[])
}

/// Quads along an edge of the cube of a soma without neurites. Refined, 96 quads are the sphere to some
/// 0.01 % of its volume, and files with tens of thousands of lone soma samples exist.
const LONE_LEVEL: u32 = 4;

/// Most quads along an edge of the cube, if neurites are thin and have room: more take longer.
const USUAL_LEVEL: f64 = 10.0;

/// Least quads along an edge of the cube for what is no sphere.
const SHAPED_LEVEL: u32 = 8;

fn finer(kind: SphereKind) -> u32 {
    match kind {
        SphereKind::Octahedron => 1,
        SphereKind::Cube => 4,
    }
}

fn without_thinnest(request: &SomaRequest<'_>, insertions: &[Insertion]) -> SomaSurface {
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
fn fitting_level(request: &SomaRequest<'_>, insertions: &[Insertion]) -> u32 {
    if request.kind == SphereKind::Octahedron {
        return 3;
    }
    let mut angles: Vec<f64> = insertions.iter().map(Insertion::angle).collect();
    angles.sort_by(f64::total_cmp);
    let median = angles[angles.len() / 2];
    let fit = (std::f64::consts::FRAC_PI_4 * std::f64::consts::SQRT_2 / median).round();
    let room = (4.0 * insertions.len() as f64).sqrt().ceil();
    let least = match request.soma.is_sphere() {
        true => 6,
        false => SHAPED_LEVEL,
    };
    let finest = finest_fitting(request.kind);
    let level = (fit.min(USUAL_LEVEL).max(room) as u32).clamp(least, finest);
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

/// Pulls, warps, finds the size and judges.
fn deform(
    request: &SomaRequest<'_>,
    reference: &Reference,
    insertion_quads: &InsertionQuads,
    insertions: &[Insertion],
) -> SomaSurface {
    let sphere = &reference.sphere;
    let stretch = Stretch::of(request.soma);
    let flow = Flow::new(sphere, insertion_quads, insertions, &stretch);
    let share = |corner: DVec3| {
        let (direction, distance) = (corner.normalize_or_zero(), corner.length());
        distance / request.soma.surface(direction)
    };
    let reaches: Vec<[f64; 4]> = flow.rings.iter().map(|ring| ring.map(share)).collect();
    let pull = match request.method {
        SomaMethod::Fem => Pull::new(sphere, &insertion_quads.quads, insertions, &reaches, || {
            reference.elasticity()
        }),
        SomaMethod::Sphere | SomaMethod::Profile | SomaMethod::None => Pull::none(sphere),
    };
    let surface = 0..sphere.surface;
    let mut nodes: Vec<DVec3> = surface
        .map(|node| flow.apply(pull.node(node, 1.0)))
        .collect();
    if request.method == SomaMethod::Profile {
        profile::apply(&mut nodes, request.soma.radius, insertions);
    }
    let quads = insertion_quads.quads.iter();
    let pulling = quads.zip(&flow.rings).zip(insertions.iter().zip(&reaches));
    for ((&quad, ring), (_, reaches)) in pulling.filter(|(_, (insertion, _))| !insertion.inset) {
        let corners = sphere.quads[quad].into_iter().zip(ring.iter().zip(reaches));
        corners.for_each(|(vertex, (corner, &reach))| {
            nodes[vertex as usize] = corner.normalize_or_zero() * reach;
        });
    }
    let directions: Vec<DVec3> = nodes.iter().map(|node| node.normalize_or_zero()).collect();
    let draft = Draft {
        request,
        sphere,
        pull: &pull,
        surface: directions
            .iter()
            .map(|&d| request.soma.surface(d))
            .collect(),
        lengths: nodes.iter().map(|node| node.length()).collect(),
        directions,
        insertion_quads,
        corners: &flow.rings,
        insertions,
    };
    let mut surface = draft.fitting();
    surface.folded = sphere.quads.iter().filter(|q| folded(&nodes, **q)).count();
    let width = 2.0 * std::f64::consts::PI.sqrt() / (sphere.quads.len() as f64).sqrt();
    surface.misfits = usize::from(insertion_quads.worst > 1.5 * width);
    surface
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
