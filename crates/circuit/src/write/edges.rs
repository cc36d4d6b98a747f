//! Writing SONATA files of edges.

use std::io::{self, Write};

use hdf5_pure::FileBuilder;

use super::{header, text};
use crate::Synapses;

/// Writes a population of edges: both ends, places on the targets' membranes, and properties, each a number
/// for every edge.
///
/// # Errors
/// Those of the writer.
pub fn edges(
    name: &str,
    [source, target]: [&str; 2],
    synapses: &Synapses,
    properties: &[(&str, Vec<f64>)],
    writer: impl Write,
) -> io::Result<()> {
    let mut file = FileBuilder::new();
    header(&mut file);
    let mut edges = file.create_group("edges");
    let mut population = edges.create_group(name);
    let types = vec![-1_i64; synapses.targets.len()];
    population
        .create_dataset("edge_type_id")
        .with_i64_data(&types);
    for (end, ids, of) in [
        ("source_node_id", &synapses.sources, source),
        ("target_node_id", &synapses.targets, target),
    ] {
        population
            .create_dataset(end)
            .with_u64_data(ids)
            .set_attr("node_population", text(of));
    }
    let mut group = population.create_group("0");
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let column = synapses.positions.iter().map(|p| p[axis] as f32);
        let column: Vec<f32> = column.collect();
        group
            .create_dataset(&format!("afferent_surface_{name}"))
            .with_f32_data(&column);
    }
    for (name, values) in properties {
        group.create_dataset(name).with_f64_data(values);
    }
    population.add_group(group.finish());
    edges.add_group(population.finish());
    file.add_group(edges.finish());
    file.finish_to(writer).map_err(io::Error::other)
}
