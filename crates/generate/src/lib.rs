//! From a morphology to a closed coarse mesh.
#![forbid(unsafe_code)]

mod assemble;
mod fork;
mod frame;
mod joint;
mod options;
mod prepare;
mod skeleton;
mod soma;
mod thin;
mod warning;

pub use options::{GenerateOptions, SomaMethod, SphereKind};
pub use warning::Warning;

use std::time::Instant;

use neurotess_mesh::CoarseMesh;
use neurotess_morphology::Morphology;

use assemble::Assembly;
use prepare::Ball;
use skeleton::{Root, Skeleton};
use soma::seats::Insertion;
use soma::{SomaRequest, SomaSurface};
use warning::Warnings;

/// A coarse mesh and what there is to say about it.
#[derive(Clone, Debug, Default)]
pub struct Generated {
    /// The closed coarse mesh.
    pub mesh: CoarseMesh,
    /// One report per soma.
    pub somata: Vec<SomaReport>,
    /// What was mended, counted by cause.
    pub warnings: Vec<Warning>,
    /// Seconds spent in somata (solve and seats).
    pub soma_seconds: f64,
}

/// Figures of a rebuilt soma.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SomaReport {
    /// Volume (µm³) within the soma's surface, closed by the planes of the first rings.
    pub volume: f64,
    /// Area (µm²) of the soma's surface without the quads that neurites took.
    pub area: f64,
    /// Volume (µm³) of the undeformed sphere.
    pub sphere_volume: f64,
    /// Area (µm²) of the undeformed sphere.
    pub sphere_area: f64,
}

/// Builds the closed coarse mesh of a cell. Never fails: what cannot be meshed as traced is mended
/// or left out, and reported.
pub fn generate(morphology: &Morphology, options: &GenerateOptions) -> Generated {
    let mut warnings = Warnings::default();
    let mut skeleton = Skeleton::new(morphology, options.kinds.as_deref());
    prepare::mend_radii(&mut skeleton, &mut warnings);
    prepare::merge_coincident(&mut skeleton, &mut warnings);
    let balls = balls(morphology, &skeleton, options, &mut warnings);
    prepare::leave_out_inside(&mut skeleton, &balls, &mut warnings);
    prepare::insert_first_rings(&mut skeleton, &balls, &mut warnings);

    thin::drop_buried_twigs(&mut skeleton, &mut warnings);
    thin::merge_close_forks(&mut skeleton, &mut warnings);
    skeleton.start_free_trees_at_an_end();
    prepare::lengthen_single_points(&mut skeleton, &mut warnings);
    thin::space_points(&mut skeleton, &mut warnings);
    fork::split_crowded(&mut skeleton, &mut warnings);
    fork::clear_the_way(&mut skeleton, &mut warnings);
    let orientations = thin::uncross_rings(&mut skeleton, &balls, &mut warnings);

    let clock = Instant::now();
    let built = build_somata(morphology, &mut skeleton, &balls, options, &mut warnings);
    let soma_seconds = clock.elapsed().as_secs_f64();
    let mut orientations = orientations;
    for (surface, nodes, _) in built.iter().flatten() {
        for (&node, insertion) in nodes.iter().zip(&surface.insertions) {
            orientations[node as usize] = insertion.direction;
        }
    }
    let mut assembly = Assembly::new(&skeleton, &orientations);
    let mut somata = Vec::new();
    for (index, soma) in built.iter().enumerate() {
        if let (Some((surface, nodes, report)), Some(ball)) = (soma, balls[index]) {
            let sample = morphology.somata[index]
                .samples
                .first()
                .map_or(-1, |s| s.id);
            assembly.soma(surface, ball.center, sample, nodes);
            somata.push(*report);
        }
    }
    let mut mesh = assembly.finish();
    mesh.origin = morphology.origin;
    Generated {
        mesh,
        somata,
        warnings: warnings.into_vec(),
        soma_seconds,
    }
}

/// The sphere of each soma that is to be meshed.
fn balls(
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
    let ball = |(index, soma): (usize, &neurotess_morphology::Soma)| {
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
fn radius_from_neurites(skeleton: &Skeleton, soma: u32, center: glam::DVec3) -> f64 {
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

/// A soma's surface, the nodes of its rings, and its figures.
type BuiltSoma = (SomaSurface, Vec<u32>, SomaReport);

fn build_somata(
    morphology: &Morphology,
    skeleton: &mut Skeleton,
    balls: &[Option<Ball>],
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Vec<Option<BuiltSoma>> {
    let mut rings: Vec<Vec<u32>> = vec![Vec::new(); morphology.somata.len()];
    for (index, node) in skeleton.nodes.iter().enumerate() {
        if let Root::Insertion(soma) = node.root {
            rings[soma as usize].push(index as u32);
        }
    }
    balls
        .iter()
        .zip(rings)
        .map(|(ball, nodes)| {
            let ball = (*ball)?;
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
            };
            let mut surface = soma::rebuild(&request, &insertions);
            report_soma(&surface, warnings);
            let nodes = keep_seated(skeleton, &mut surface, nodes, &ball);
            let report = measure_soma(&surface, ball.radius);
            Some((surface, nodes, report))
        })
        .collect()
}

fn insertion(node: &skeleton::Node, ball: &Ball) -> Insertion {
    let offset = node.center - ball.center;
    Insertion {
        direction: offset.try_normalize().unwrap_or(glam::DVec3::Y),
        distance: offset.length(),
        radius: node.radius,
    }
}

/// Puts the rings' nodes where the soma has them. Neurites without a seat become free.
fn keep_seated(
    skeleton: &mut Skeleton,
    surface: &mut SomaSurface,
    nodes: Vec<u32>,
    ball: &Ball,
) -> Vec<u32> {
    let mut seated = Vec::with_capacity(nodes.len());
    let (mut rings, mut insertions) = (Vec::new(), Vec::new());
    for (slot, node) in nodes.into_iter().enumerate() {
        let insertion = surface.insertions[slot];
        let target = &mut skeleton.nodes[node as usize];
        if surface.dropped.contains(&slot) {
            target.root = Root::Free;
            continue;
        }
        target.center = ball.center + insertion.direction * insertion.distance;
        target.radius = insertion.radius;
        seated.push(node);
        rings.push(surface.rings[slot]);
        insertions.push(insertion);
    }
    (surface.rings, surface.insertions) = (rings, insertions);
    seated
}

fn report_soma(surface: &SomaSurface, warnings: &mut Warnings) {
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
        "corner of the soma's surface turns inwards: try --soma sphere or a larger --soma-scale",
    );
    warnings.add_many(
        "soma_inverted",
        surface.inverted,
        "tetrahedron of the soma turned inside out: the surface is valid all the same",
    );
}

/// Volume and area of a soma's surface, and of the sphere that it was.
fn measure_soma(surface: &SomaSurface, radius: f64) -> SomaReport {
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
