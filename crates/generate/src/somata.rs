//! The somata of a cell: how far each reaches, its surface, and where its rings ended up.

use std::collections::BTreeSet;

use glam::DVec3;
use neurotess_morphology::{Morphology, Soma};

use crate::prepare::SomaSphere;
use crate::rings::{self, Given, RingRequests};
use crate::skeleton::{Root, Skeleton, SkeletonNode};
use crate::soma::insertion_quads::Insertion;
use crate::soma::{self, SomaRequest, SomaSurface};
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

/// Shares of the way from the sphere to the farthest first ring that are tried in turn until the
/// surface has no fold: close neurites that pull far out would make spikes through one another.
const REACHES: [f64; 5] = [1.0, 0.6, 0.35, 0.15, 0.03];
/// Radii of the soma beyond which no ring goes by request where the surface does not stand what is asked
/// for. The same for all requests, so that a ring that is asked farther and farther out comes to a stop.
const FARTHEST: [f64; 14] = [
    1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.2, 2.4, 2.7, 3.0, 3.5, 4.0, 5.0,
];

/// What is tried for a soma.
#[derive(Clone, Copy, Debug)]
struct Trial {
    /// Farthest rings by request (radii of the soma).
    farthest: f64,
    /// Of [`FARTHEST`], those that may serve, while one is looked for.
    search: Option<(usize, usize)>,
    /// Of [`REACHES`].
    reach: usize,
}

/// The somata and their rings.
pub(crate) struct Built {
    pub(crate) somata: Vec<Option<BuiltSoma>>,
    pub(crate) rings: Vec<FirstRing>,
}

/// Gives every neurite of a soma its first ring and rebuilds the somata.
pub(crate) fn build(
    skeleton: &mut Skeleton,
    soma_spheres: &mut [Option<SomaSphere>],
    requests: &RingRequests<'_>,
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Built {
    let farthest: Vec<f64> = soma_spheres
        .iter()
        .map(|b| b.map_or(1.0, |b| b.reach))
        .collect();
    let mut trials = vec![Trial::new(); soma_spheres.len()];
    loop {
        let mut said = warnings.clone();
        let limits: Vec<f64> = trials.iter().map(|t| t.farthest).collect();
        let (mut tried, given) =
            rings::insert(skeleton, soma_spheres, requests, &limits, &mut said);
        let nodes = ring_nodes(&tried, soma_spheres.len());
        let wished = farthest_requests(&given, soma_spheres.len());
        let somata: Vec<Option<BuiltSoma>> = (soma_spheres.iter().zip(nodes).zip(&trials))
            .map(|((soma_sphere, nodes), trial)| {
                Some(build_one(
                    &mut tried,
                    (*soma_sphere)?,
                    &nodes,
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
            if trials[index].go_on(soma.surface.sound(), wished[index], farthest[index]) {
                soma_sphere.reach = 1.0 + (farthest[index] - 1.0) * REACHES[trials[index].reach];
                again = true;
            }
        }
        if again {
            continue;
        }
        (somata.iter().flatten()).for_each(|soma| warn(&soma.surface, &mut said));
        warn_of_rings(&given, &trials, requests, &mut said);
        let rings = given
            .iter()
            .filter_map(|g| first_ring(&tried, g, soma_spheres));
        let rings = rings.collect();
        (*skeleton, *warnings) = (tried, said);
        return Built { somata, rings };
    }
}

/// Per soma: radii of the farthest ring that is there by request alone.
fn farthest_requests(given: &[Given], somata: usize) -> Vec<Option<f64>> {
    let mut farthest: Vec<Option<f64>> = vec![None; somata];
    for ring in given.iter().filter(|g| g.farther) {
        let most = &mut farthest[ring.soma as usize];
        *most = Some(most.map_or(ring.reach, |most| most.max(ring.reach)));
    }
    farthest
}

impl Trial {
    fn new() -> Self {
        Self {
            farthest: f64::INFINITY,
            search: None,
            reach: 0,
        }
    }

    /// Whether there is something else to try. `wished`: radii of the farthest ring that is there by
    /// request alone. `most`: farthest of those that nobody asked for.
    fn go_on(&mut self, sound: bool, wished: Option<f64>, most: f64) -> bool {
        match self.search {
            None if sound => return false,
            None => {
                let Some(wished) = wished.filter(|_| self.farthest == f64::INFINITY) else {
                    return self.go_nearer(most);
                };
                let below = FARTHEST.partition_point(|&f| f < wished - 1e-9);
                self.search = Some((0, below));
            }
            Some((low, high)) => {
                let middle = usize::midpoint(low, high);
                self.search = Some(if sound {
                    (middle + 1, high)
                } else {
                    (low, middle)
                });
            }
        }
        // Those before `low` serve, those from `high` on do not.
        let (low, high) = self.search.unwrap_or_default();
        if low < high {
            self.farthest = FARTHEST[usize::midpoint(low, high)];
            return true;
        }
        self.search = None;
        // Without any request that is too far, the rings that nobody asked for have their turn.
        let best = low.checked_sub(1).map_or(0.0, |best| FARTHEST[best]);
        let known = sound && self.farthest == best;
        self.farthest = best;
        !known
    }

    fn go_nearer(&mut self, most: f64) -> bool {
        let nearer = self.reach + 1 < REACHES.len() && most > 1.0;
        self.reach += usize::from(nearer);
        nearer
    }
}

/// A ring where it is in the end; none: its neurite found no insertion_quad.
fn first_ring(
    skeleton: &Skeleton,
    given: &Given,
    soma_spheres: &[Option<SomaSphere>],
) -> Option<FirstRing> {
    let node = skeleton.node(given.node);
    let soma_sphere = soma_spheres[given.soma as usize]?;
    (node.root == Root::Insertion(given.soma)).then(|| FirstRing {
        neurite: given.neurite,
        position: given.position,
        center: node.center,
        outwards: (node.center - soma_sphere.center).normalize_or(DVec3::Y),
        radius: node.radius,
    })
}

fn warn_of_rings(
    given: &[Given],
    trials: &[Trial],
    requests: &RingRequests<'_>,
    warnings: &mut Warnings,
) {
    warnings.add_many(
        "ring_nearer",
        trials.iter().filter(|t| t.reach > 0).count(),
        "neurites crowd on the soma: it was pulled out less towards them",
    );
    warnings.add_many(
        "ring_limited",
        given.iter().filter(|g| g.limited()).count(),
        "first ring cannot be as far out as asked for (a fork, an end, a turn of the path, or the \
         soma would fold): it is nearer",
    );
    warnings.add_many(
        "ring_unused",
        requests.unused(given),
        "no neurite of this number has a first ring: its position is not used",
    );
}

/// Nodes of each soma's rings, in order.
pub(crate) fn ring_nodes(skeleton: &Skeleton, somata: usize) -> Vec<Vec<u32>> {
    let mut rings: Vec<Vec<u32>> = vec![Vec::new(); somata];
    for (index, node) in skeleton.nodes().iter().enumerate() {
        if let Root::Insertion(soma) = node.root {
            rings[soma as usize].push(index as u32);
        }
    }
    rings
}

fn build_one(
    skeleton: &mut Skeleton,
    soma_sphere: SomaSphere,
    nodes: &[u32],
    options: &GenerateOptions,
    trial: &Trial,
) -> BuiltSoma {
    let insertions: Vec<Insertion> = nodes
        .iter()
        .map(|&n| insertion(skeleton.node(n), &soma_sphere))
        .collect();
    let request = SomaRequest {
        center: soma_sphere.center,
        radius: soma_sphere.radius,
        method: options.soma,
        poisson: options.poisson,
        kind: options.sphere,
        level: options.sphere_level,
        at_any_price: trial.reach + 1 == REACHES.len(),
        // What is only tried need not be tried by all means.
        attempts: match trial.search {
            Some(_) => soma::ATTEMPTS - 1,
            None => soma::ATTEMPTS,
        },
    };
    let mut surface = soma::rebuild(&request, &insertions);
    keep_seated(skeleton, &mut surface, nodes, &soma_sphere);
    let report = measure(&surface, soma_sphere.radius);
    BuiltSoma { surface, report }
}

fn insertion(node: &SkeletonNode, soma_sphere: &SomaSphere) -> Insertion {
    let offset = node.center - soma_sphere.center;
    Insertion {
        direction: offset.try_normalize().unwrap_or(DVec3::Y),
        distance: offset.length(),
        radius: node.radius,
    }
}

/// Puts the rings' nodes where the soma has them. Neurites without a insertion_quad become free.
fn keep_seated(
    skeleton: &mut Skeleton,
    surface: &mut SomaSurface,
    nodes: &[u32],
    soma_sphere: &SomaSphere,
) {
    let (mut shapes, _) = skeleton.shapes();
    let dropped: BTreeSet<usize> = surface.dropped.iter().copied().collect();
    let (mut rings, mut insertions) = (Vec::new(), Vec::new());
    for (slot, &node) in nodes.iter().enumerate() {
        let insertion = surface.insertions[slot];
        if dropped.contains(&slot) {
            shapes.set_root(node, Root::Free);
            continue;
        }
        let center = soma_sphere.center + insertion.direction * insertion.distance;
        shapes.set_center(node, center);
        shapes.set_radius(node, insertion.radius);
        rings.push(surface.rings[slot]);
        insertions.push(insertion);
    }
    (surface.rings, surface.insertions) = (rings, insertions);
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
    volume += surface.rings.iter().map(|ring| quad(ring).1).sum::<f64>();
    SomaReport {
        volume,
        area,
        sphere_volume: 4.0 / 3.0 * PI * radius.powi(3),
        sphere_area: 4.0 * PI * radius * radius,
    }
}
