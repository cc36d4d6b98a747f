//! Writing SONATA files: nodes, spikes and reports, each whole in memory before it is written.

mod edges;
mod report;

use std::io::{self, Write};

use hdf5_pure::{AttrValue, FileBuilder, FinishedGroup, GroupBuilder};

use crate::{Attribute, Population, SpikePopulation};
pub use edges::edges;
pub use report::{ReportLayout, report};

/// Writes a file of nodes: ids 0, 1, …; one group; texts as numbers with their library. Rotations are
/// quaternions of `f32`. Morphologies are the texts of the attribute `morphology`.
///
/// # Errors
/// Those of the writer.
pub fn nodes(populations: &[Population], writer: impl Write) -> io::Result<()> {
    let mut file = FileBuilder::new();
    header(&mut file);
    let mut nodes = file.create_group("nodes");
    for population in populations {
        let written = one(population, nodes.create_group(&population.name));
        nodes.add_group(written);
    }
    file.add_group(nodes.finish());
    file.finish_to(writer).map_err(io::Error::other)
}

fn one(population: &Population, mut out: GroupBuilder) -> FinishedGroup {
    let types = vec![-1i64; population.len()];
    out.create_dataset("node_type_id").with_i64_data(&types);
    let mut group = out.create_group("0");
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let column: Vec<f64> = population.positions.iter().map(|p| p[axis]).collect();
        group.create_dataset(name).with_f64_data(&column);
    }
    // Components of a DQuat lie in the order x, y, z, w.
    for (place, name) in ["x", "y", "z", "w"].into_iter().enumerate() {
        let rotations = population.rotations.iter();
        let column: Vec<f32> = rotations.map(|q| q.to_array()[place] as f32).collect();
        group
            .create_dataset(&format!("orientation_{name}"))
            .with_f32_data(&column);
    }
    let mut library = group.create_group("@library");
    for (name, attribute) in &population.attributes {
        match attribute {
            Attribute::Numbers(values) => {
                group.create_dataset(name).with_f64_data(values);
            }
            Attribute::Text {
                library: texts,
                indices,
            } => {
                let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
                library.create_dataset(name).with_vlen_strings(&texts);
                group.create_dataset(name).with_u32_data(indices);
            }
        }
    }
    group.add_group(library.finish());
    out.add_group(group.finish());
    out.finish()
}

/// Writes a file of spikes.
///
/// # Errors
/// Those of the writer.
pub fn spikes(populations: &[SpikePopulation], writer: impl Write) -> io::Result<()> {
    let mut file = FileBuilder::new();
    header(&mut file);
    let mut spikes = file.create_group("spikes");
    for population in populations {
        let mut group = spikes.create_group(&population.name);
        group
            .create_dataset("timestamps")
            .with_f64_data(&population.times)
            .set_attr("units", text("ms"));
        group
            .create_dataset("node_ids")
            .with_u64_data(&population.nodes);
        spikes.add_group(group.finish());
    }
    file.add_group(spikes.finish());
    file.finish_to(writer).map_err(io::Error::other)
}

/// What the SONATA guide has at the root of every file.
fn header(file: &mut FileBuilder) {
    file.set_attr("magic", AttrValue::U32(0x0a7a));
    file.set_attr("version", AttrValue::U32Array(vec![0, 1]));
}

fn text(text: &str) -> AttrValue {
    AttrValue::VarLenString(text.into())
}
