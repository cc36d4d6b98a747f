//! Synthetic circuits: a piece of cortex of as many cells as wanted, with spikes and a report.
//!
//! **Theory.** Six layers' worth of depth, 2,000 µm, white matter at y = 0 and pia on top; the floor is a
//! square so large that there are 10⁵ cells in a mm³ (M. Beaulieu, 1993: 5 to 10·10⁴ in rat's cortex).
//! Shares and kinds of cells by layer are by eye. Cells are turned freely about the vertical and
//! leaned by a few degrees. Each fires by a Poisson process of its own rate, 0.5 to 20 Hz.
//!
//! **Practice.** A million cells take seconds: nodes are numbers, and of morphologies there are only as
//! many as asked for. Equal options give equal circuits on every machine.

mod configs;
mod synapses;
mod voltage;

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use neurotess_circuit::{Attribute, Population, SpikePopulation};

use crate::{Kind, Options};
pub use configs::{CIRCUIT, EDGES, SIMULATION, circuit_config, node_sets, simulation_config};
use neurotess_morphology::random::Random;
pub use synapses::{SyntheticSynapses, synapses};
pub use voltage::{DURATION, STEP, voltages};

/// Name of the population.
pub const POPULATION: &str = "cortex";

/// Which circuit to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CircuitOptions {
    /// How many cells.
    pub neurons: usize,
    /// How many distinct morphologies.
    pub morphologies: usize,
    /// Circuits differ by it.
    pub seed: u64,
    /// Points of a morphology; `None` for what is usual for its kind.
    pub points: Option<usize>,
    /// Branches of a cell may grow through one another: see [`Options::may_cross`].
    pub may_cross: bool,
    /// How many cells the report is about; they are spread evenly.
    pub reported: usize,
}

/// A layer: its name, lower and upper end (µm), share of the cells.
const LAYERS: [(&str, f64, f64, f64); 5] = [
    ("L1", 1850.0, 2000.0, 0.02),
    ("L2/3", 1350.0, 1850.0, 0.34),
    ("L4", 1100.0, 1350.0, 0.18),
    ("L5", 600.0, 1100.0, 0.20),
    ("L6", 0.0, 600.0, 0.26),
];
/// Kinds of morphologies, taken in turn.
const KINDS: [Kind; 5] = [
    Kind::Pyramidal,
    Kind::Basket,
    Kind::Pyramidal,
    Kind::Star,
    Kind::Pyramidal,
];
/// Cells in a µm³.
const DENSITY: f64 = 1e-4;
/// Depth of the whole (µm).
const DEPTH: f64 = 2000.0;
/// Least side of the floor (µm): a few cells do not stand in one another.
const MIN_SIDE: f64 = 200.0;

/// A morphology of the circuit: its name, and how to grow it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CircuitMorphology {
    /// Name of the file, without extension.
    pub name: String,
    /// What [`crate::grow`] takes.
    pub options: Options,
}

/// A circuit's parts; morphologies and the report are made one by one from here.
#[derive(Clone, Debug)]
pub struct SyntheticCircuit {
    /// The cells.
    pub population: Population,
    /// Their morphologies, in the order of the attribute's words.
    pub morphologies: Vec<CircuitMorphology>,
    /// When they fire, in the [`DURATION`] of the simulation.
    pub spikes: SpikePopulation,
    /// Rows of the cells that the report is about, ascending.
    pub reported: Vec<u64>,
}

/// Makes a circuit.
pub fn circuit(options: &CircuitOptions) -> SyntheticCircuit {
    let morphologies = morphologies(options);
    let population = population(options, &morphologies);
    let spikes = spikes(options);
    let (n, reported) = (options.neurons as u64, options.reported as u64);
    let reported = reported.min(n);
    SyntheticCircuit {
        population,
        morphologies,
        spikes,
        reported: (0..reported).map(|i| i * n / reported).collect(),
    }
}

fn morphologies(options: &CircuitOptions) -> Vec<CircuitMorphology> {
    let one = |index: usize| {
        let kind = KINDS[index % KINDS.len()];
        CircuitMorphology {
            name: format!("{kind}_{index:05}"),
            options: Options {
                kind,
                seed: options
                    .seed
                    .wrapping_mul(1_000_003)
                    .wrapping_add(index as u64),
                points: options.points,
                may_cross: options.may_cross,
            },
        }
    };
    (0..options.morphologies.max(1)).map(one).collect()
}

fn population(options: &CircuitOptions, morphologies: &[CircuitMorphology]) -> Population {
    let n = options.neurons;
    let mut random = Random::new(options.seed, 101);
    let side = (n as f64 / (DENSITY * DEPTH)).sqrt().max(MIN_SIDE);
    let of_kind: BTreeMap<Kind, Vec<u32>> = KINDS
        .into_iter()
        .map(|kind| {
            let own = (0..)
                .zip(morphologies)
                .filter(|(_, m)| m.options.kind == kind);
            (kind, own.map(|(index, _)| index).collect())
        })
        .collect();
    let mut population = Population {
        name: POPULATION.into(),
        kind: "biophysical".into(),
        ids: (0..n as u64).collect(),
        templates: vec![None; n],
        ..Population::default()
    };
    let (mut layers, mut kinds, mut shapes) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..n {
        let layer = layer(random.unit());
        let (_, low, high, _) = LAYERS[layer];
        let floor = (-side / 2.0, side / 2.0);
        population.positions.push(DVec3::new(
            random.between(floor),
            random.between((low, high)),
            random.between(floor),
        ));
        let turn = DQuat::from_rotation_y(random.between((0.0, std::f64::consts::TAU)));
        let (lean_x, lean_z) = random.normal_pair();
        let lean = DQuat::from_rotation_x(0.05 * lean_x) * DQuat::from_rotation_z(0.05 * lean_z);
        population.rotations.push(lean * turn);
        let kind = kind(layer, random.unit());
        let own = &of_kind[&kind];
        // With few morphologies a kind may have none.
        let place = random.unit();
        let shape = match own.len() {
            0 => (place * morphologies.len() as f64) as u32,
            count => own[(place * count as f64) as usize],
        };
        layers.push(layer as u32);
        kinds.push(KINDS.iter().position(|&k| k == kind).unwrap_or(0) as u32);
        shapes.push(shape);
    }
    let exciting: Vec<u32> = kinds
        .iter()
        .map(|&k| u32::from(KINDS[k as usize] == Kind::Basket))
        .collect();
    let one = || vec![0; n];
    let columns: [(&str, Vec<String>, Vec<u32>); 7] = [
        ("layer", LAYERS.map(|l| l.0.into()).to_vec(), layers),
        ("mtype", KINDS.map(|k| k.name().into()).to_vec(), kinds),
        ("morphology", names(morphologies), shapes),
        ("synapse_class", vec!["EXC".into(), "INH".into()], exciting),
        ("etype", vec!["cADpyr".into()], one()),
        ("model_type", vec!["biophysical".into()], one()),
        ("model_template", vec!["hoc:none".into()], one()),
    ];
    population.attributes = columns
        .into_iter()
        .map(|(name, library, indices)| (name.into(), words(library, indices)))
        .collect();
    population
}

fn names(morphologies: &[CircuitMorphology]) -> Vec<String> {
    morphologies.iter().map(|m| m.name.clone()).collect()
}

/// A column whose library has each word once.
fn words(library: Vec<String>, mut indices: Vec<u32>) -> Attribute {
    let mut distinct: Vec<String> = Vec::new();
    let place = |word: String| {
        let known = distinct.iter().position(|other| *other == word);
        known.unwrap_or_else(|| {
            distinct.push(word);
            distinct.len() - 1
        }) as u32
    };
    // Names of morphologies differ anyway, and there may be many of them.
    if library.len() > 100 {
        return Attribute::Text { library, indices };
    }
    let places: Vec<u32> = library.into_iter().map(place).collect();
    for index in &mut indices {
        *index = places[*index as usize];
    }
    Attribute::Text {
        library: distinct,
        indices,
    }
}

fn layer(mut share: f64) -> usize {
    for (index, (_, _, _, own)) in LAYERS.iter().enumerate() {
        if share < *own {
            return index;
        }
        share -= own;
    }
    LAYERS.len() - 1
}

fn kind(layer: usize, share: f64) -> Kind {
    match (LAYERS[layer].0, share) {
        ("L1", _) => Kind::Star,
        (_, share) if share < 0.15 => Kind::Basket,
        ("L4", share) if share < 0.6 => Kind::Star,
        _ => Kind::Pyramidal,
    }
}

/// Poisson processes, sorted by time.
fn spikes(options: &CircuitOptions) -> SpikePopulation {
    let mut random = Random::new(options.seed, 102);
    let mut spikes: Vec<(f64, u64)> = Vec::new();
    for node in 0..options.neurons as u64 {
        // Rates are far apart: many cells hardly fire.
        let rate = 0.0005 * libm::pow(40.0, random.unit());
        let mut time = 0.0;
        loop {
            // 1 ms without any, as after each spike.
            time += 1.0 - libm::log(1.0 - random.unit()) / rate;
            if time >= DURATION {
                break;
            }
            spikes.push((time, node));
        }
    }
    spikes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (times, nodes) = spikes.into_iter().unzip();
    SpikePopulation {
        name: POPULATION.into(),
        times,
        nodes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(neurons: usize, morphologies: usize) -> CircuitOptions {
        CircuitOptions {
            neurons,
            morphologies,
            seed: 3,
            points: Some(200),
            may_cross: false,
            reported: 10,
        }
    }

    #[test]
    fn the_seed_decides() {
        let one = circuit(&options(100, 7));
        let same = circuit(&options(100, 7));
        assert_eq!(one.population.positions, same.population.positions);
        assert_eq!(one.spikes, same.spikes);
        let other = circuit(&CircuitOptions {
            seed: 4,
            ..options(100, 7)
        });
        assert_ne!(one.population.positions, other.population.positions);
    }

    #[test]
    fn cells_stand_in_their_layers_with_their_kind() {
        let made = circuit(&options(2000, 10)).population;
        let mut seen = std::collections::BTreeSet::new();
        for row in 0..made.len() {
            let word = |name: &str| made.attributes[name].text(row).expect("a word");
            let (_, low, high, _) = LAYERS
                .into_iter()
                .find(|l| l.0 == word("layer"))
                .expect("a layer");
            assert!((low..high).contains(&made.positions[row].y));
            assert!(word("morphology").starts_with(word("mtype")));
            assert!(made.rotations[row].is_normalized());
            seen.insert((word("layer").to_owned(), word("mtype").to_owned()));
        }
        assert!(seen.len() > 8, "{seen:?}");
    }

    #[test]
    fn few_morphologies_serve_all_cells() {
        let made = circuit(&options(50, 1));
        assert_eq!(made.morphologies.len(), 1);
        let Attribute::Text { library, indices } = &made.population.attributes["morphology"] else {
            panic!("no words");
        };
        assert!(library.len() == 1 && indices.iter().all(|&i| i == 0));
    }
}
