//! `neurotess nodes`: the nodes of a circuit as a table.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Args;
use neurotess::circuit::{Attribute, Circuit, NodeRef};
use neurotess::formats;
use serde::Serialize;

use crate::io::circuits;
use crate::io::output::{is_standard, reserve_standard};
use crate::io::table::{self, Rows, TableArgs, cell, named_from};
use crate::report::{Failure, Reporter, usage};
use neurotess::options::groups::CellSelection;

/// `neurotess nodes`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess nodes circuit/ --csv nodes.csv
  neurotess nodes circuit/ --node-set L5 --columns layer,mtype --csv -")]
pub(crate) struct NodesArgs {
    /// A circuit: SONATA, a network of Snudda, a scene of nsol or one of your own
    #[arg(value_name = "CIRCUIT")]
    circuit: PathBuf,
    #[command(flatten)]
    table: TableArgs,
    /// Only these attributes [default: all]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    #[command(flatten)]
    cells: CellSelection,
}

/// The JSON document.
#[derive(Serialize)]
struct Written {
    file: String,
    out: String,
    nodes: usize,
    columns: Vec<String>,
}

/// Runs the command.
pub(crate) fn run(args: &NodesArgs, reporter: &Reporter) -> anyhow::Result<()> {
    reserve_standard(&args.table.csv, reporter)?;
    let circuit =
        circuits::open(&args.circuit, reporter).map_err(|Failure(why)| anyhow::anyhow!(why))?;
    let nodes = args.cells.select(&circuit)?;
    let attributes = attributes(&circuit, args.columns.as_deref())?;
    let columns = table::write(&args.table, |rows| {
        fill(rows, &args.table.csv, &circuit, &nodes, &attributes)
    })?;
    if !is_standard(&args.table.csv) {
        let out = args.table.csv.display();
        reporter.result(&format!("{out}: {} nodes", nodes.len()));
    }
    reporter.document(&Written {
        file: circuit.file.clone(),
        out: args.table.csv.display().to_string(),
        nodes: nodes.len(),
        columns,
    })
}

/// Attributes of all populations, or those that are asked for.
fn attributes(circuit: &Circuit, wanted: Option<&[String]>) -> anyhow::Result<Vec<String>> {
    let all: BTreeSet<&String> = circuit
        .populations
        .iter()
        .flat_map(|population| population.attributes.keys())
        .collect();
    let Some(wanted) = wanted else {
        return Ok(all.into_iter().cloned().collect());
    };
    if let Some(unknown) = wanted.iter().find(|name| !all.contains(name)) {
        let known: Vec<&str> = all.iter().map(|name| name.as_str()).collect();
        return usage(format!(
            "no node has an attribute '{unknown}'; there are: {}",
            known.join(", ")
        ));
    }
    Ok(wanted.to_vec())
}

/// Where a node is and how it is turned: columns before those of attributes.
const PLACE: [&str; 13] = [
    "population",
    "node_id",
    "morphology",
    "file",
    "x",
    "y",
    "z",
    "rotation_w",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "scale",
    "recenter",
];

/// Columns before those of attributes that say what the attribute of their name says.
const OF_ATTRIBUTES: [&str; 3] = ["population", "morphology", "recenter"];

/// The column of an attribute; none if one of [`PLACE`] has it. One that would be read as something else gets
/// another name.
fn column(attribute: &str) -> Option<String> {
    let is = |name: &str| name.eq_ignore_ascii_case(attribute);
    if OF_ATTRIBUTES.contains(&attribute) {
        return None;
    }
    let taken = PLACE.into_iter().any(is) || is("id");
    Some(match taken {
        true => format!("{attribute}_attribute"),
        false => attribute.to_owned(),
    })
}

/// `out`: where the table goes, from which the paths in it are named.
fn fill(
    rows: &mut Rows,
    out: &Path,
    circuit: &Circuit,
    nodes: &[NodeRef],
    attributes: &[String],
) -> anyhow::Result<Vec<String>> {
    let of_attributes: Vec<(&String, String)> = attributes
        .iter()
        .filter_map(|name| Some((name, column(name)?)))
        .collect();
    let names = of_attributes.iter().map(|(_, column)| column.clone());
    let columns: Vec<String> = PLACE.into_iter().map(str::to_owned).chain(names).collect();
    rows.write_record(&columns)?;
    let mut record = Vec::with_capacity(columns.len());
    for node in nodes {
        let population = &circuit.populations[node.population as usize];
        let row = node.row as usize;
        let template = population.templates.get(row).copied().flatten();
        let path = template.map(|id| circuit.templates[id.index()].path.as_path());
        let text = |name: &str| population.attributes.get(name)?.text(row);
        record.clear();
        let own = text("population").unwrap_or(&population.name);
        record.push(own.to_owned());
        record.push(population.ids[row].to_string());
        record.push(match (text("morphology"), path) {
            (Some(name), _) => name.to_owned(),
            (None, Some(path)) => name_of(path),
            (None, None) => String::new(),
        });
        record.push(path.map_or(String::new(), |path| named_from(out, path)));
        let position = population.position(row);
        for axis in 0..3 {
            record.push(cell(position.map_or(f64::NAN, |p| p[axis])));
        }
        let turned = population.rotations.get(row).copied().unwrap_or_default();
        record.extend([turned.w, turned.x, turned.y, turned.z].map(cell));
        record.push(cell(population.scales.get(row).copied().unwrap_or(1.0)));
        let recentered = population.recentered.get(row).copied().unwrap_or(true);
        record.push(recentered.to_string());
        for (name, _) in &of_attributes {
            record.push(match population.attributes.get(*name) {
                Some(attribute @ Attribute::Text { .. }) => {
                    attribute.text(row).unwrap_or_default().to_owned()
                }
                Some(attribute) => cell(attribute.number(row).unwrap_or(f64::NAN)),
                None => String::new(),
            });
        }
        rows.write_record(&record)?;
    }
    Ok(columns)
}

/// The name of a morphology: that of its file, or its own in a container.
fn name_of(path: &Path) -> String {
    let (file, member) = formats::member(path);
    match member {
        Some(member) => member.to_owned(),
        None => file
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_column_is_there_twice_or_read_as_another() {
        let named = |attribute| column(attribute).unwrap_or_default();
        assert_eq!(named("layer"), "layer");
        assert_eq!([named("morphology"), named("recenter")], ["", ""]);
        assert_eq!(
            [named("scale"), named("ID")],
            ["scale_attribute", "ID_attribute"]
        );
    }
}
