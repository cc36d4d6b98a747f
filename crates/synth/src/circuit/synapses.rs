//! Synapses of synthetic circuits: on dendrites and somata, from cells chosen at random.

use std::f64::consts::TAU;

use glam::DVec3;
use neurotess_circuit::Synapses;
use neurotess_morphology::{Morphology, NeuriteKind};

use super::SyntheticCircuit;
use neurotess_morphology::random::Random;

/// Speed (µm/ms) of a spike along an axon, as of thin axons without myelin.
const SPEED: f64 = 300.0;
/// Delay (ms) of a synapse itself.
const SYNAPTIC_DELAY: f64 = 0.5;

/// Synapses, and numbers of each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SyntheticSynapses {
    /// Their ends and places.
    pub synapses: Synapses,
    /// From the source's spike to its effect (ms).
    pub delays: Vec<f64>,
    /// Peak conductances (nS): log-normal, with median 0.7.
    pub conductances: Vec<f64>,
}

/// So many synapses onto each cell of a circuit. `morphologies`: those of the circuit, grown. Places are spread
/// evenly over the segments of dendrites. Equal options give equal synapses on every machine.
///
/// # Panics
/// If there are not as many morphologies as the circuit has.
pub fn synapses(
    made: &SyntheticCircuit,
    morphologies: &[Morphology],
    per_cell: usize,
    seed: u64,
) -> SyntheticSynapses {
    assert_eq!(morphologies.len(), made.morphologies.len());
    let segments: Vec<Vec<[usize; 2]>> = morphologies.iter().map(dendritic_segments).collect();
    let population = &made.population;
    let names = population.attributes.get("morphology");
    let of_cell = |row: usize| {
        let name = names.and_then(|names| names.text(row));
        let place = made
            .morphologies
            .iter()
            .position(|m| Some(&*m.name) == name);
        place.unwrap_or(0)
    };
    let mut random = Random::new(seed, 211);
    let mut all = SyntheticSynapses::default();
    let cells = population.len();
    for target in 0..cells {
        let template = of_cell(target);
        let (morphology, segments) = (&morphologies[template], &segments[template]);
        if segments.is_empty() || cells < 2 {
            continue;
        }
        for _ in 0..per_cell {
            let draw =
                |random: &mut Random, n: usize| ((random.unit() * n as f64) as usize).min(n - 1);
            let segment = segments[draw(&mut random, segments.len())];
            let place = on_membrane(morphology, segment, &mut random);
            let rotation = population.rotations.get(target).copied();
            let scale = population.scales.get(target).copied();
            let turned = rotation.unwrap_or_default() * (place * scale.unwrap_or(1.0));
            let world = turned + population.positions[target];
            let source = (target + 1 + draw(&mut random, cells - 1)) % cells;
            let distance = population.positions[source].distance(world);
            all.synapses.sources.push(source as u64);
            all.synapses.targets.push(target as u64);
            all.synapses.positions.push(world);
            all.delays.push(SYNAPTIC_DELAY + distance / SPEED);
            all.conductances
                .push(0.7 * (0.4 * random.normal_pair().0).exp());
        }
    }
    all
}

/// Pairs of neighboring points of dendrites.
fn dendritic_segments(morphology: &Morphology) -> Vec<[usize; 2]> {
    let sections = morphology.sections.iter();
    let dendrites = sections.filter(|section| section.kind != NeuriteKind::AXON);
    let pairs = |range: std::ops::Range<usize>| {
        let after = range.clone().skip(1);
        range.zip(after).map(|(a, b)| [a, b])
    };
    dendrites
        .flat_map(|section| pairs(section.range()))
        .collect()
}

/// A place on the membrane of a segment, in the morphology's coordinates.
fn on_membrane(morphology: &Morphology, [a, b]: [usize; 2], random: &mut Random) -> DVec3 {
    let (a, b) = (morphology.points[a], morphology.points[b]);
    let along = random.unit();
    let (p, q) = (a.position.as_dvec3(), b.position.as_dvec3());
    let axis = (q - p).try_normalize().unwrap_or(DVec3::Y);
    let (side, across) = axis.any_orthonormal_pair();
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    let radius = f64::from(a.radius) + along * f64::from(b.radius - a.radius);
    morphology.origin + p.lerp(q, along) + radius * (cos * side + sin * across)
}
