//! The somata of a cell: how far each reaches, its surface, and where its rings ended up.

use glam::DVec3;
use neurotess_morphology::{Morphology, Soma};

use crate::prepare::{self, Ball};
use crate::skeleton::{Node, Root, Skeleton};
use crate::soma::seats::Insertion;
use crate::soma::{self, SomaRequest, SomaSurface};
use crate::warning::Warnings;
use crate::{GenerateOptions, SomaMethod, SomaReport};

/// The sphere of each soma that is to be meshed.
pub(crate) fn balls(
    morphology: &Morphology,
    skeleton: &Skeleton,
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Vec<Option<Ball>> {
    let reach = match options.soma {
        SomaMethod::Fem => FEM_REACH,
        SomaMethod::Sphere => 1.0,
        SomaMethod::Profile => PROFILE_REACH,
        SomaMethod::None => return vec![None; morphology.somata.len()],
    };
    let ball = |(index, soma): (usize, &Soma)| {
        let mut radius = f64::from(soma.radius);
        if !(radius.is_finite() && radius > 0.0) {
            radius = radius_from_neurites(skeleton, index as u32, soma.center.as_dvec3());
            warnings.add(
                "soma_radius_mended",
                soma.samples.first().map(|s| s.id),
                "soma has no radius: taken from where its neurites start",
            );
        }
        Some(Ball {
            center: soma.center.as_dvec3(),
            radius: radius * options.soma_scale,
            reach,
        })
    };
    morphology.somata.iter().enumerate().map(ball).collect()
}

/// Farthest first ring of an elastic soma, in radii: beyond, the pull inverts tetrahedra. Chosen by
/// eye among 1.2 to 1.6: farther ones look like stars.
const FEM_REACH: f64 = 1.35;
/// LiveMesh's: the tube has its own radius from 1.5 R on.
const PROFILE_REACH: f64 = 1.5;

/// A radius for a soma that has none: half-way to the nearest start of a neurite, and no thinner
/// than the thickest of them.
fn radius_from_neurites(skeleton: &Skeleton, soma: u32, center: DVec3) -> f64 {
    let starts = skeleton.nodes.iter().filter(|n| n.root == Root::Soma(soma));
    let (mut nearest, mut thickest) = (f64::INFINITY, 0.0_f64);
    for start in starts {
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

/// Gives every neurite of a soma its first ring and rebuilds the somata.
pub(crate) fn build(
    skeleton: &mut Skeleton,
    balls: &mut [Option<Ball>],
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Vec<Option<BuiltSoma>> {
    let farthest: Vec<f64> = balls.iter().flatten().map(|b| b.reach).collect();
    let mut nearer = vec![0; balls.len()];
    loop {
        let mut tried = skeleton.clone();
        let mut said = warnings.clone();
        prepare::insert_first_rings(&mut tried, balls, &mut said);
        let rings = ring_nodes(&tried, balls.len());
        let built: Vec<Option<BuiltSoma>> = balls
            .iter()
            .zip(rings)
            .zip(&nearer)
            .map(|((ball, nodes), &nearer)| {
                let last = nearer + 1 == REACHES.len();
                Some(build_one(&mut tried, (*ball)?, &nodes, options, last))
            })
            .collect();
        let mut again = false;
        for (index, soma) in built.iter().enumerate() {
            let unsound = soma.as_ref().is_some_and(|s| !s.surface.sound());
            if let Some(ball) = &mut balls[index]
                && unsound
                && nearer[index] + 1 < REACHES.len()
                && farthest[index] > 1.0
            {
                nearer[index] += 1;
                ball.reach = 1.0 + (farthest[index] - 1.0) * REACHES[nearer[index]];
                again = true;
            }
        }
        if again {
            continue;
        }
        built
            .iter()
            .flatten()
            .for_each(|soma| warn(&soma.surface, &mut said));
        said.add_many(
            "ring_nearer",
            nearer.iter().filter(|&&n| n > 0).count(),
            "neurites crowd on the soma: it was pulled out less towards them",
        );
        (*skeleton, *warnings) = (tried, said);
        return built;
    }
}

/// Nodes of each soma's rings, in order.
pub(crate) fn ring_nodes(skeleton: &Skeleton, somata: usize) -> Vec<Vec<u32>> {
    let mut rings: Vec<Vec<u32>> = vec![Vec::new(); somata];
    for (index, node) in skeleton.nodes.iter().enumerate() {
        if let Root::Insertion(soma) = node.root {
            rings[soma as usize].push(index as u32);
        }
    }
    rings
}

fn build_one(
    skeleton: &mut Skeleton,
    ball: Ball,
    nodes: &[u32],
    options: &GenerateOptions,
    at_any_price: bool,
) -> BuiltSoma {
    let insertions: Vec<Insertion> = nodes
        .iter()
        .map(|&n| insertion(skeleton.node(n), &ball))
        .collect();
    let request = SomaRequest {
        center: ball.center,
        radius: ball.radius,
        method: options.soma,
        poisson: options.poisson,
        kind: options.sphere,
        level: options.sphere_level,
        at_any_price,
    };
    let mut surface = soma::rebuild(&request, &insertions);
    keep_seated(skeleton, &mut surface, nodes, &ball);
    let report = measure(&surface, ball.radius);
    BuiltSoma { surface, report }
}

fn insertion(node: &Node, ball: &Ball) -> Insertion {
    let offset = node.center - ball.center;
    Insertion {
        direction: offset.try_normalize().unwrap_or(DVec3::Y),
        distance: offset.length(),
        radius: node.radius,
    }
}

/// Puts the rings' nodes where the soma has them. Neurites without a seat become free.
fn keep_seated(skeleton: &mut Skeleton, surface: &mut SomaSurface, nodes: &[u32], ball: &Ball) {
    let (mut rings, mut insertions) = (Vec::new(), Vec::new());
    for (slot, &node) in nodes.iter().enumerate() {
        let insertion = surface.insertions[slot];
        let target = &mut skeleton.nodes[node as usize];
        if surface.dropped.contains(&slot) {
            target.root = Root::Free;
            continue;
        }
        target.center = ball.center + insertion.direction * insertion.distance;
        target.radius = insertion.radius;
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
        "seat_far",
        surface.misfits,
        "no free place on the soma within 1.5 quads of a neurite: the surface was warped towards it",
    );
    warnings.add_many(
        "no_seat",
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
