//! Cells of circuits as inputs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use itertools::Itertools;
use neurotess_circuit::{Circuit, Instance, soma_center};

use crate::plan::Cell;
use crate::report::NodeName;
use crate::targets::Job;

/// A file for each cell: population and id; the row too where several rows share an id.
pub fn files(
    circuit: &Circuit,
    instances: &[Instance],
    folder: &Path,
    extension: &str,
) -> Vec<PathBuf> {
    let mut taken: BTreeSet<PathBuf> = BTreeSet::new();
    let file = |instance: &Instance| {
        // A population's name comes from the file and may contain any characters.
        let plain: String = population(circuit, instance)
            .chars()
            .map(|c| {
                if c.is_alphanumeric() || "-_.".contains(c) {
                    c
                } else {
                    '_'
                }
            })
            .collect();
        let plain = plain.trim_start_matches('.');
        let id = instance.id;
        let mut out = folder.join(format!("{plain}_{id}.{extension}"));
        if !taken.insert(out.clone()) {
            let row = instance.node.row;
            out = folder.join(format!("{plain}_{id}_row{row}.{extension}"));
            taken.insert(out.clone());
        }
        out
    };
    instances.iter().map(file).collect()
}

/// The cells, each with its file.
pub(crate) fn cells(
    circuit: &Circuit,
    instances: &[Instance],
    folder: &Path,
    extension: &str,
) -> Vec<Cell> {
    let outs = files(circuit, instances, folder, extension);
    let cell = |(&instance, out): (&Instance, PathBuf)| {
        let input = circuit.templates[instance.template.index()].path.clone();
        let mut job = Job::new(input, out);
        job.placement = placement(&instance);
        Cell {
            job,
            template: instance.template.index(),
            node: Some(NodeName {
                population: population(circuit, &instance).to_owned(),
                node_id: instance.id,
            }),
            place: Some(Box::new(move |morphology| {
                instance.world_from_cell(soma_center(morphology))
            })),
        }
    };
    instances.iter().zip_eq(outs).map(cell).collect()
}

fn population<'c>(circuit: &'c Circuit, instance: &Instance) -> &'c str {
    &circuit.populations[instance.node.population as usize].name
}

/// Where a cell is, as text that is the same for the same place only.
fn placement(instance: &Instance) -> String {
    let Instance {
        node: _,
        id: _,
        template: _,
        position,
        rotation,
        scale,
        recentered,
        group: _,
    } = *instance;
    let numbers = [
        position.to_array().as_slice(),
        &rotation.to_array(),
        &[scale],
    ]
    .concat();
    let bits: Vec<String> = numbers
        .iter()
        .map(|n| format!("{:x}", n.to_bits()))
        .collect();
    format!("{} {recentered}", bits.join(" "))
}
