//! `neurotess mesh CIRCUIT`: each cell in the circuit's coordinates, in a file of its own, or all
//! in one GLB (circuit_glb.rs).

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use neurotess::Batch;
use neurotess::batch::{Entry, Inputs};

use super::args::MeshArgs;
use super::circuit_glb;
use super::options::MeshOptions;
use super::run::{follow, plan_of};
use crate::io::circuits;
use crate::report::{Reporter, usage};

/// Runs the command for one circuit.
pub(super) fn run(args: &MeshArgs, path: &Path, reporter: &Reporter) -> anyhow::Result<()> {
    let clock = Instant::now();
    let folder = &args.out.out;
    let in_one_file = circuit_glb::is_one_file(args);
    if folder.is_file() && !in_one_file {
        return usage(format!(
            "{} is a file, but the cells of a circuit need a folder, or one .glb: give another OUT",
            folder.display()
        ));
    }
    let opened = circuits::open(path, reporter).and_then(|circuit| {
        let nodes = args.cells.select(&circuit)?;
        Ok((circuit, nodes))
    });
    let (circuit, nodes) = match opened {
        Ok(opened) => opened,
        Err(failure) => {
            reporter.failure(&failure);
            let failed = Entry::failed(path, failure.0);
            return reporter.document(&[failed]);
        }
    };
    let instances = circuits::instances(&circuit, &nodes, reporter);
    if in_one_file {
        return circuit_glb::run(args, &circuit, &instances, reporter);
    }
    // No single input file, so that OUT is a folder.
    let options = MeshOptions::new(args, &Inputs::default())?;
    let batch = Batch::of_circuit(Arc::new(circuit), instances).into(folder);
    let plan = plan_of(options.of(batch, args, reporter))?;
    follow(plan, args, false, clock, reporter)
}
