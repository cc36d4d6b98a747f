//! The somata of a cell: each one's surface, and where its rings ended up.

use std::collections::BTreeSet;

use glam::DVec3;
use neurotess_mesh::Watch;

use crate::soma::draft;
use crate::soma::first_rings::{self, PlacedRing, RingRequests};
use crate::soma::insertion_quads::Insertion;
use crate::soma::soma_surface::{ATTEMPTS, SomaRequest, SomaSurface};
use crate::soma::surface;
use crate::soma::trials::Trial;
use crate::tracing::SomaSphere;
use crate::tracing::{Root, Skeleton};
use crate::warning::Warnings;
use crate::{FirstRing, GenerateOptions, SomaReport};

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
    watch: &Watch<'_>,
) -> Built {
    let farthest: Vec<f64> = soma_spheres
        .iter()
        .map(|sphere| sphere.as_ref().map_or(1.0, |sphere| sphere.reach))
        .collect();
    let mut trials = vec![Trial::new(); soma_spheres.len()];
    let mut rounded = 0;
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
                    soma_sphere.as_ref()?,
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
                soma_sphere.set_share(farthest[index], trials[index].share());
                again = true;
            } else if !(soma.surface.is_whole() || soma_sphere.is_sphere()) {
                *soma_sphere = soma_sphere.rounded(farthest[index]);
                trials[index] = Trial::new();
                rounded += 1;
                again = true;
            }
        }
        if again && !watch.is_stopped() {
            continue;
        }
        (somata.iter().flatten()).for_each(|soma| warn(&soma.surface, &mut trial_warnings));
        for (soma_sphere, soma) in soma_spheres.iter_mut().zip(&somata) {
            if let (Some(soma_sphere), Some(soma)) = (soma_sphere, soma) {
                let center = soma_sphere.center;
                let rings = soma.surface.insertions.iter();
                soma_sphere.set_rings(rings.map(|i| [center + i.center(), i.axis]).collect());
            }
        }
        trial_warnings.add_many(
            "soma_rounded",
            rounded,
            "neurites find no room on the soma as it was traced: a sphere of its volume stands for it",
        );
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
    let soma_sphere = soma_spheres[ring.soma as usize].as_ref()?;
    (node.root == Root::Insertion(ring.soma)).then(|| FirstRing {
        neurite: ring.neurite,
        position: ring.position,
        center: node.center,
        outwards: soma_sphere.axis(node.center),
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
    soma_sphere: &SomaSphere,
    rings: &[PlacedRing],
    options: &GenerateOptions,
    trial: &Trial,
) -> BuiltSoma {
    let insertions: Vec<Insertion> = rings
        .iter()
        .map(|ring| insertion(skeleton, ring, soma_sphere))
        .collect();
    let request = SomaRequest {
        soma: soma_sphere,
        keep: options.soma_keep,
        method: options.soma,
        poisson: options.poisson,
        kind: options.sphere,
        level: options.sphere_level,
        may_leave_out: trial.is_nearest(),
        // While a limit is searched for, the last remedy (smaller rings) is not used.
        attempts: match trial.searches() {
            true => ATTEMPTS - 1,
            false => ATTEMPTS,
        },
    };
    let mut surface = surface::rebuild(&request, &insertions);
    move_rings(skeleton, &mut surface, rings, soma_sphere);
    let (traced_volume, traced_area) = draft::traced(&request, &surface.insertions);
    let report = SomaReport {
        volume: surface.extent.volume,
        area: surface.extent.area,
        traced_volume,
        traced_area,
    };
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
    let direction = offset.try_normalize().unwrap_or(DVec3::Y);
    let height = distance - soma_sphere.surface(direction);
    let most = match ring.inset {
        true => (height / node.radius).clamp(0.0, MOST_LEANING) * soma_sphere.hillocks(),
        false => 0.0,
    };
    let axis = leaning(direction, path_direction(skeleton, ring.node), most);
    let foot = match ring.inset {
        true => offset - axis * (height / axis.dot(direction)),
        false => offset,
    };
    Insertion {
        direction,
        axis,
        foot: foot.try_normalize().unwrap_or(direction),
        distance,
        radius: node.radius,
        inset: ring.inset,
        highest: distance.max(next - node.radius),
    }
}

/// Sine of the greatest angle between the normal of an inset's ring and the direction from the soma's center: 40°. A ring
/// that leans dips into the surface on one side, so low ones lean less. Thick rings, which pull the surface, do not
/// lean: on one side it would be drawn into the tube (99th percentile of the angles at necks of 23 cells: 48° for 35°).
const MOST_LEANING: f64 = 0.65;
/// Way along a neurite that tells its direction where it leaves its soma, in its radii.
const DIRECTION_WAY: f64 = 2.5;

/// Unit direction of a neurite from its first ring, if it goes anywhere before it forks.
fn path_direction(skeleton: &Skeleton, ring: u32) -> Option<DVec3> {
    let from = skeleton.node(ring);
    let (mut here, mut left) = (ring, DIRECTION_WAY * from.radius);
    while let [next] = *skeleton.children().of(here) {
        let [a, b] = [here, next].map(|node| skeleton.node(node).center);
        let length = a.distance(b);
        if length >= left {
            return (a.lerp(b, left / length) - from.center).try_normalize();
        }
        left -= length;
        here = next;
    }
    (skeleton.node(here).center - from.center).try_normalize()
}

/// `direction`, turned towards another by an angle of at most this sine.
fn leaning(direction: DVec3, towards: Option<DVec3>, most: f64) -> DVec3 {
    let Some(towards) = towards else {
        return direction;
    };
    let side = (towards - direction * towards.dot(direction)).try_normalize();
    let wanted = direction.angle_between(towards).min(most.asin());
    side.map_or(direction, |side| {
        direction * wanted.cos() + side * wanted.sin()
    })
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
}
