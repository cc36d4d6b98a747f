//! `neurotess view`: the window.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use neurotess_viewer::CommandListener;
use neurotess_viewer::document::SomaEdit;

use crate::io::inputs::Inputs;
use crate::io::morphologies::MORPHOLOGIES;
use crate::options::rings::RingArgs;
use crate::report::Reporter;

/// `neurotess view`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess view
  neurotess view cell.swc
  neurotess view cells/ other.asc
  neurotess view circuit/circuit_config.json
  neurotess view circuit/ --report circuit/reports/voltage.h5
  neurotess view yesterday.neurotess")]
pub(crate) struct ViewArgs {
    /// Morphology files, folders (searched recursively), globs, circuits, or a session that the
    /// window saved; nothing: a window to open files in
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) rings: RingArgs,
    /// Values of a simulation of the circuit: a SONATA report, or a file of spikes
    #[arg(long, value_name = "FILE", requires = "inputs")]
    pub(crate) report: Option<PathBuf>,
    /// Adapter to draw with: a part of its name [default: NEUROTESS_ADAPTER, or the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

/// Runs the command.
pub(crate) fn run(args: &ViewArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let mut inputs = Vec::new();
    for input in &args.inputs {
        // Folders and circuits are searched by the window's threads; only globs are expanded here.
        if input.exists() {
            inputs.push(input.clone());
            continue;
        }
        let found = Inputs::find(std::slice::from_ref(input), &MORPHOLOGIES);
        for failure in &found.failures {
            reporter.failure(failure);
        }
        inputs.extend(found.files.into_iter().map(|file| file.path));
    }
    let options = neurotess_viewer::Options {
        inputs,
        soma: SomaEdit {
            rings: args.rings.positions(),
            ..SomaEdit::default()
        },
        report: args.report.clone(),
        adapter: args.adapter.clone(),
    };
    let listener = reporter
        .verbose()
        .then(|| Box::new(tell) as CommandListener);
    neurotess_viewer::run(options, listener)?;
    Ok(())
}

/// `--verbose`: every command that runs, on standard error.
fn tell(command: &neurotess_viewer::Command) {
    drop(writeln!(io::stderr(), "command: {command:?}"));
}
