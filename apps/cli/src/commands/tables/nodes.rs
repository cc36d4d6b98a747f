//! `neurotess nodes`: the nodes of a circuit as a table.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;
use neurotess::circuit::{Attribute, Circuit, NodeRef};
use serde::Serialize;

use crate::io::circuits;
use crate::io::output::{is_standard, reserve_standard};
use crate::io::table::{self, Rows, TableArgs, cell};
use crate::options::cells::CellArgs;
use crate::report::{Failure, Reporter, usage};

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
    cells: CellArgs,
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
    let nodes = args
        .cells
        .select(&circuit)
        .map_err(|Failure(why)| anyhow::anyhow!(why))?;
    let attributes = attributes(&circuit, args.columns.as_deref())?;
    let columns = table::write(&args.table, |rows| {
        fill(rows, &circuit, &nodes, &attributes)
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

fn fill(
    rows: &mut Rows,
    circuit: &Circuit,
    nodes: &[NodeRef],
    attributes: &[String],
) -> anyhow::Result<Vec<String>> {
    let columns: Vec<String> = PLACE
        .into_iter()
        .map(str::to_owned)
        .chain(attributes.iter().cloned())
        .collect();
    rows.write_record(&columns)?;
    let mut record = Vec::with_capacity(columns.len());
    for node in nodes {
        let population = &circuit.populations[node.population as usize];
        let row = node.row as usize;
        let template = population.templates.get(row).copied().flatten();
        let path = template.map(|id| circuit.templates[id.index()].path.as_path());
        let name = path
            .and_then(std::path::Path::file_stem)
            .unwrap_or_default();
        record.clear();
        record.push(population.name.clone());
        record.push(population.ids[row].to_string());
        record.push(name.to_string_lossy().into_owned());
        record.push(path.map_or(String::new(), |path| path.display().to_string()));
        let position = population.position(row);
        for axis in 0..3 {
            record.push(cell(position.map_or(f64::NAN, |p| p[axis])));
        }
        let turned = population.rotations.get(row).copied().unwrap_or_default();
        record.extend([turned.w, turned.x, turned.y, turned.z].map(cell));
        record.push(cell(population.scales.get(row).copied().unwrap_or(1.0)));
        let recentered = population.recentered.get(row).copied().unwrap_or(true);
        record.push(recentered.to_string());
        for name in attributes {
            record.push(match population.attributes.get(name) {
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
