//! `neurotess mesh`: from tracings to closed surface meshes.
//!
//! ```text
//! arguments ─▶ Inputs ─▶ Batch ─▶ Plan ─▶ Events ─▶ messages, log, JSON
//!                  └────▶ MeshOptions ─▲
//! ```

mod args;
mod circuit;
mod circuit_glb;
mod messages;
mod options;
mod run;

use std::time::Instant;

use neurotess::Batch;
use neurotess::batch::{Inputs, MORPHOLOGIES};
use neurotess::mesh::Format;

use crate::io::circuits::partition;
use crate::io::{inputs, output};
use crate::report::{Reporter, usage};
pub(crate) use args::MeshArgs;
use options::MeshOptions;
use run::{follow, plan_of};

/// Runs the command.
pub(crate) fn run(args: &MeshArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let (circuits, others) = partition(&args.inputs);
    if let [path] = &circuits[..]
        && others.is_empty()
    {
        let of_a_cell = args.tables().next().map(|(flag, _)| flag);
        if let Some(flag) = of_a_cell.or(args.soma_mesh.is_some().then_some("--soma-mesh")) {
            return usage(format!(
                "{flag} is of one cell, not of a circuit: leave it out"
            ));
        }
        return circuit::run(args, path, reporter);
    }
    if !circuits.is_empty() {
        return usage("a circuit is meshed alone: leave out the other inputs");
    }
    if args.cells.any() {
        return usage("no input is a circuit: leave out what chooses cells of one");
    }
    let out = &args.out.out;
    output::reserve_standard(out, reporter)?;
    let found = Inputs::find(&args.inputs, &MORPHOLOGIES);
    if args.soma_mesh.is_some() && !found.one_file {
        return usage("--soma-mesh is of one cell: give one input file");
    }
    let mut files = vec![("-o", out)];
    for (flag, table) in args.tables() {
        if !found.one_file {
            return usage(format!("{flag} is of one cell: give one input file"));
        }
        if let Some((other, _)) = files.iter().find(|(_, file)| *file == table) {
            return usage(format!("{flag} and {other} name the same file: give two"));
        }
        files.push((flag, table));
        output::reserve_standard(table, reporter)?;
    }
    let options = MeshOptions::new(args, &found)?;
    let named = Format::from_extension(out).ok().map(Format::extension);
    reporter.warn_of_name(out, options.files.format.extension(), named);
    let batch = Batch::of(found.clone()).into_file_or_folder(out);
    let plan = plan_of(options.of(batch, args, reporter))?;
    inputs::tell(&found, reporter);
    follow(plan, args, true, clock, reporter)
}
