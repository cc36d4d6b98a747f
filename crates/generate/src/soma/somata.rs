//! The somata of a cell: how far each reaches, its surface, and where its rings ended up.

use std::collections::BTreeSet;

use glam::DVec3;
use neurotess_morphology::{Morphology, Soma};

use crate::soma::first_rings::{self, PlacedRing, RingRequests};
use crate::soma::insertion_quads::Insertion;
use crate::soma::surface::{self, SomaRequest, SomaSurface};
use crate::soma::trials::Trial;
use crate::stop::Stop;
use crate::tracing::SomaSphere;
use crate::tracing::{Root, Skeleton};
use crate::warning::Warnings;
use crate::{FirstRing, GenerateOptions, SomaMethod, SomaReport};

/// The sphere of each soma that is to be meshed.
pub(crate) fn soma_spheres(
    morphology: &Morphology,
    skeleton: &Skeleton,
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Vec<Option<SomaSphere>> {
    let starts = starts(skeleton, morphology.somata.len());
    let reach = match options.soma {
        SomaMethod::Fem => FEM_REACH,
        SomaMethod::Sphere => 1.0,
        SomaMethod::Profile => PROFILE_REACH,
        SomaMethod::None => return vec![None; morphology.somata.len()],
    };
    let soma_sphere = |(index, soma): (usize, &Soma)| {
        let mut radius = f64::from(soma.radius);
        if !(radius.is_finite() && radius > 0.0) {
            radius = radius_from_neurites(skeleton, &starts[index], soma.center.as_dvec3());
            warnings.add(
                "soma_radius_mended",
                soma.samples.first().map(|s| s.id),
                "soma has no radius: taken from where its neurites start",
            );
        }
        Some(SomaSphere {
            center: soma.center.as_dvec3(),
            radius: radius * options.soma_scale,
            reach,
        })
    };
    morphology
        .somata
        .iter()
        .enumerate()
        .map(soma_sphere)
        .collect()
}

/// Farthest first ring of an elastic soma, in radii: beyond, the pull inverts tetrahedra. Chosen by
/// eye among 1.2 to 1.6: farther ones look like stars.
const FEM_REACH: f64 = 1.35;
/// LiveMesh's: the tube has its own radius from 1.5 R on.
const PROFILE_REACH: f64 = 1.5;

/// First nodes of each soma's neurites.
fn starts(skeleton: &Skeleton, somata: usize) -> Vec<Vec<u32>> {
    let mut starts = vec![Vec::new(); somata];
    for (index, node) in skeleton.nodes().iter().enumerate() {
        if let Root::Soma(soma) = node.root {
            starts[soma as usize].push(index as u32);
        }
    }
    starts
}

/// A radius for a soma that has none: half-way to the nearest start of a neurite, and no thinner
/// than the thickest of them.
fn radius_from_neurites(skeleton: &Skeleton, starts: &[u32], center: DVec3) -> f64 {
    let (mut nearest, mut thickest) = (f64::INFINITY, 0.0_f64);
    for &start in starts {
        let start = skeleton.node(start);
        nearest = nearest.min(start.center.distance(center));
        thickest = thickest.max(start.radius);
    }
    let half = if nearest.is_finite() {
        0.5 * nearest
    } else {
        0.0
    };
    half.min(10.0).max(1.5 * thickest).max(0.5)
}

/// A rebuilt soma.
pub(crate) struct BuiltSoma {
    pub(crate) surface: SomaSurface,
    pub(crate) report: SomaReport,
}

/// The somata and their rings.
pub(crate) struct Built {
    pub(crate) somata: Vec<Option<BuiltSoma>>,
    pub(crate) rings: Vec<FirstRing>,
}

/// Inserts the first ring of every neurite of a soma and rebuilds the somata.
pub(crate) fn build(
    skeleton: &mut Skeleton,
    soma_spheres: &mut [Option<SomaSphere>],
    requests: &RingRequests<'_>,
    options: &GenerateOptions,
    warnings: &mut Warnings,
    stop: Stop<'_>,
) -> Built {
    let farthest: Vec<f64> = soma_spheres
        .iter()
        .map(|sphere| sphere.map_or(1.0, |sphere| sphere.reach))
        .collect();
    let mut trials = vec![Trial::new(); soma_spheres.len()];
    loop {
        let mut trial_warnings = warnings.clone();
        let limits: Vec<f64> = trials.iter().map(|t| t.farthest).collect();
        let (mut trial_skeleton, placed) = first_rings::insert(
            skeleton,
            soma_spheres,
            requests,
            &limits,
            &mut trial_warnings,
        );
        let mut rings_of = vec![Vec::new(); soma_spheres.len()];
        for ring in &placed {
            rings_of[ring.soma as usize].push(*ring);
        }
        let requested = farthest_requests(&placed, soma_spheres.len());
        let somata: Vec<Option<BuiltSoma>> = (soma_spheres.iter().zip(&rings_of).zip(&trials))
            .map(|((soma_sphere, rings), trial)| {
                Some(build_one(
                    &mut trial_skeleton,
                    (*soma_sphere)?,
                    rings,
                    options,
                    trial,
                ))
            })
            .collect();
        let mut again = false;
        for (index, soma) in somata.iter().enumerate() {
            let (Some(soma_sphere), Some(soma)) = (&mut soma_spheres[index], soma) else {
                continue;
            };
            if trials[index].advance(soma.surface.sound(), requested[index], farthest[index]) {
                soma_sphere.reach = 1.0 + (farthest[index] - 1.0) * trials[index].share();
                again = true;
            }
        }
        if again && !stop.asked() {
            continue;
        }
        (somata.iter().flatten()).for_each(|soma| warn(&soma.surface, &mut trial_warnings));
        warn_of_rings(&placed, &trials, requests, &mut trial_warnings);
        let rings = placed
            .iter()
            .filter_map(|ring| first_ring(&trial_skeleton, ring, soma_spheres));
        let rings = rings.collect();
        (*skeleton, *warnings) = (trial_skeleton, trial_warnings);
        return Built { somata, rings };
    }
}

/// Per soma: distance (radii) of the ring that a request took farthest out.
fn farthest_requests(rings: &[PlacedRing], somata: usize) -> Vec<Option<f64>> {
    let mut farthest: Vec<Option<f64>> = vec![None; somata];
    for ring in rings.iter().filter(|ring| ring.farther) {
        let most = &mut farthest[ring.soma as usize];
        *most = Some(most.map_or(ring.reach, |most| most.max(ring.reach)));
    }
    farthest
}

/// A ring where it is in the end; none: its neurite found no insertion quad.
fn first_ring(
    skeleton: &Skeleton,
    ring: &PlacedRing,
    soma_spheres: &[Option<SomaSphere>],
) -> Option<FirstRing> {
    let node = skeleton.node(ring.node);
    let soma_sphere = soma_spheres[ring.soma as usize]?;
    (node.root == Root::Insertion(ring.soma)).then(|| FirstRing {
        neurite: ring.neurite,
        position: ring.position,
        center: node.center,
        outwards: (node.center - soma_sphere.center).normalize_or(DVec3::Y),
        radius: node.radius,
    })
}

fn warn_of_rings(
    rings: &[PlacedRing],
    trials: &[Trial],
    requests: &RingRequests<'_>,
    warnings: &mut Warnings,
) {
    warnings.add_many(
        "ring_nearer",
        trials.iter().filter(|t| t.is_nearer()).count(),
        "neurites crowd on the soma: it was pulled out less towards them",
    );
    warnings.add_many(
        "ring_limited",
        rings.iter().filter(|ring| ring.limited()).count(),
        "first ring cannot be as far out as asked for (a fork, an end, a turn of the path, or the \
         soma would fold): it is nearer",
    );
    warnings.add_many(
        "ring_unused",
        requests.unused(rings),
        "no neurite of this number has a first ring: its position is not used",
    );
}

fn build_one(
    skeleton: &mut Skeleton,
    soma_sphere: SomaSphere,
    rings: &[PlacedRing],
    options: &GenerateOptions,
    trial: &Trial,
) -> BuiltSoma {
    let insertions: Vec<Insertion> = rings
        .iter()
        .map(|ring| insertion(skeleton, ring, &soma_sphere))
        .collect();
    let request = SomaRequest {
        center: soma_sphere.center,
        radius: soma_sphere.radius,
        method: options.soma,
        poisson: options.poisson,
        kind: options.sphere,
        level: options.sphere_level,
        may_leave_out: trial.is_nearest(),
        // While a limit is searched for, the last remedy (smaller rings) is not used.
        attempts: match trial.searches() {
            true => surface::ATTEMPTS - 1,
            false => surface::ATTEMPTS,
        },
    };
    let mut surface = surface::rebuild(&request, &insertions);
    move_rings(skeleton, &mut surface, rings, &soma_sphere);
    let report = measure(&surface, soma_sphere.radius);
    BuiltSoma { surface, report }
}

fn insertion(skeleton: &Skeleton, ring: &PlacedRing, soma_sphere: &SomaSphere) -> Insertion {
    let node = skeleton.node(ring.node);
    let offset = node.center - soma_sphere.center;
    let distance = offset.length();
    let next = skeleton.children().of(ring.node).first();
    let next = next.map_or(distance, |&next| {
        skeleton.node(next).center.distance(soma_sphere.center)
    });
    Insertion {
        direction: offset.try_normalize().unwrap_or(DVec3::Y),
        distance,
        radius: node.radius,
        inset: ring.inset,
        highest: distance.max(next - node.radius),
    }
}

/// Puts the rings' nodes where the soma has them. Neurites without an insertion quad become free.
fn move_rings(
    skeleton: &mut Skeleton,
    surface: &mut SomaSurface,
    placed: &[PlacedRing],
    soma_sphere: &SomaSphere,
) {
    let (mut shapes, _) = skeleton.shapes();
    let dropped: BTreeSet<usize> = surface.dropped.iter().copied().collect();
    let (mut rings, mut insets, mut insertions) = (Vec::new(), Vec::new(), Vec::new());
    for (slot, node) in placed.iter().map(|ring| ring.node).enumerate() {
        let insertion = surface.insertions[slot];
        if dropped.contains(&slot) {
            shapes.set_root(node, Root::Free);
            continue;
        }
        let center = soma_sphere.center + insertion.direction * insertion.distance;
        shapes.set_center(node, center);
        shapes.set_radius(node, insertion.radius);
        rings.push(surface.rings[slot]);
        insets.push(surface.insets[slot]);
        insertions.push(insertion);
    }
    (surface.rings, surface.insets, surface.insertions) = (rings, insets, insertions);
}

fn warn(surface: &SomaSurface, warnings: &mut Warnings) {
    warnings.add_many(
        "ring_shrunk",
        surface.shrunk,
        "neurite too thick for its place on the soma: its first ring was made smaller",
    );
    warnings.add_many(
        "ring_moved",
        surface.turned,
        "neurites crowd on the soma: the first ring was moved aside",
    );
    warnings.add_many(
        "insertion_quad_far",
        surface.misfits,
        "no free place on the soma within 1.5 quads of a neurite: the surface was warped towards it",
    );
    warnings.add_many(
        "no_insertion_quad",
        surface.dropped.len(),
        "more neurites than the soma has places for: left unattached",
    );
    warnings.add_many(
        "soma_folded",
        surface.folded,
        "quad of the soma's surface faces inwards: try --soma sphere or a larger --soma-scale",
    );
    warnings.add_many(
        "soma_inverted",
        surface.inverted,
        "tetrahedron of the soma turned inside out: the surface is valid all the same",
    );
}

/// Volume and area of a soma's surface, and of the sphere that it was.
fn measure(surface: &SomaSurface, radius: f64) -> SomaReport {
    use std::f64::consts::PI;
    let center = surface.vertices.first().copied().unwrap_or_default();
    let quad = |q: &[u32; 4]| {
        let [a, b, c, d] = q.map(|v| surface.vertices[v as usize] - center);
        let (left, right) = ((b - a).cross(c - a), (c - a).cross(d - a));
        (
            0.5 * (left.length() + right.length()),
            (a.dot(left) + a.dot(right)) / 6.0,
        )
    };
    let (mut area, mut volume) = (0.0, 0.0);
    for q in &surface.quads {
        let (a, v) = quad(q);
        area += a;
        volume += v;
    }
    // Closed where neurites leave.
    let open = surface.rings.iter().zip(&surface.insets);
    let open = open.map(|(ring, inset)| inset.as_ref().unwrap_or(ring));
    volume += open.map(|ring| quad(ring).1).sum::<f64>();
    SomaReport {
        volume,
        area,
        sphere_volume: 4.0 / 3.0 * PI * radius.powi(3),
        sphere_area: 4.0 * PI * radius * radius,
    }
}
