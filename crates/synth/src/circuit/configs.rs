//! The JSON files of a circuit and its simulation.

use neurotess_circuit::{Attribute, Population};
use serde_json::{Map, Value, json};

use super::{DURATION, POPULATION, STEP};

/// Name of the circuit's configuration.
pub const CIRCUIT: &str = "circuit_config.json";
/// Name of the simulation's configuration.
pub const SIMULATION: &str = "simulation_config.json";

/// Name of the population of edges.
pub const EDGES: &str = "cortex__cortex__chemical";

/// The circuit's configuration. Files: `nodes.h5`, `node_sets.json`, `morphologies/*.swc`, and with edges
/// `edges.h5`.
pub fn circuit_config(edges: bool) -> Value {
    let edges = match edges {
        true => json!([{
            "edges_file": "$BASE_DIR/edges.h5",
            "populations": {EDGES: {"type": "chemical"}},
        }]),
        false => json!([]),
    };
    json!({
        "version": 2,
        "manifest": {"$BASE_DIR": "."},
        "node_sets_file": "$BASE_DIR/node_sets.json",
        "networks": {
            "nodes": [{
                "nodes_file": "$BASE_DIR/nodes.h5",
                "populations": {
                    POPULATION: {
                        "type": "biophysical",
                        "morphologies_dir": "$BASE_DIR/morphologies",
                        "biophysical_neuron_models_dir": "$BASE_DIR/morphologies",
                    },
                },
            }],
            "edges": edges,
        },
    })
}

/// The simulation's configuration. Files: `reports/spikes.h5`, `reports/voltage.h5`.
pub fn simulation_config() -> Value {
    json!({
        "version": 1,
        "manifest": {"$BASE_DIR": "."},
        "network": format!("$BASE_DIR/{CIRCUIT}"),
        "node_sets_file": "$BASE_DIR/node_sets.json",
        "run": {"tstart": 0.0, "tstop": DURATION, "dt": 0.025, "random_seed": 1},
        "output": {
            "output_dir": "$BASE_DIR/reports",
            "spikes_file": "spikes.h5",
            "spikes_sort_order": "by_time",
        },
        "reports": {
            "voltage": {
                "cells": "Reported",
                "variable_name": "v",
                "sections": "all",
                "compartments": "all",
                "type": "compartment",
                "unit": "mV",
                "start_time": 0.0,
                "end_time": DURATION,
                "dt": STEP,
            },
        },
    })
}

/// Sets by layer, by kind of cell and by class of synapse; compound ones; the reported cells.
pub fn node_sets(population: &Population, reported: &[u64]) -> Value {
    let mut sets = Map::new();
    sets.insert("All".into(), json!({"population": POPULATION}));
    for attribute in ["layer", "mtype", "synapse_class"] {
        let Some(Attribute::Text { library, .. }) = population.attributes.get(attribute) else {
            continue;
        };
        for word in library {
            sets.insert(word.clone(), json!({ attribute: word }));
        }
    }
    sets.insert(
        "Granular and infragranular".into(),
        json!(["L4", "L5", "L6"]),
    );
    sets.insert(
        "Upper pyramidal".into(),
        json!({"mtype": "pyramidal", "layer": ["L2/3", "L4"]}),
    );
    sets.insert(
        "Reported".into(),
        json!({"population": POPULATION, "node_id": reported}),
    );
    Value::Object(sets)
}
