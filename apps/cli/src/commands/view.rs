//! `neurotess view`: the window.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use neurotess::batch::{Inputs, MORPHOLOGIES};
use neurotess::options::groups::{DeviceOptions, MarkerOptions as AskedMarkers, Rings};
use neurotess::options::words::MeshBeside;
use neurotess::options::{MeshesBeside, OptionError};
use neurotess_viewer::CommandListener;
use neurotess_viewer::document::{MarkerOptions, MeshEntry, SomaEdit};

use crate::options::cache::CacheArgs;
use crate::report::{Reporter, usage};

/// `neurotess view`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess view
  neurotess view cell.swc
  neurotess view cells/ other.asc
  neurotess view circuit/circuit_config.json
  neurotess view circuit/ --report circuit/reports/voltage.h5
  neurotess view circuit/ --synapses --marker-color-by conductance
  neurotess view circuit/ --mesh region.obj,opacity=0.2
  neurotess view yesterday.neurotess")]
pub(crate) struct ViewArgs {
    /// Morphology files, folders (searched recursively), globs, circuits, or a session that the
    /// window saved; nothing: a window to open files in
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) rings: Rings,
    /// Values of a simulation of the circuit: a SONATA report, or a file of spikes
    #[arg(long, value_name = "FILE", requires = "inputs")]
    pub(crate) report: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) markers: AskedMarkers,
    #[command(flatten)]
    pub(crate) meshes: MeshesBeside,
    #[command(flatten)]
    pub(crate) cache: CacheArgs,
    #[command(flatten)]
    pub(crate) device: DeviceOptions,
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
        for not_found in &found.not_found {
            reporter.error(&not_found.to_string());
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
        markers: markers(&args.markers).or_else(|e| usage(e.to_string()))?,
        meshes: args.meshes.mesh.iter().enumerate().map(mesh).collect(),
        without_caches: args.cache.no_cache,
        adapter: args.device.adapter.clone(),
        gpu_memory: args.device.gpu_memory.map(|bytes| bytes.0),
    };
    let listener = reporter
        .verbose()
        .then(|| Box::new(tell) as CommandListener);
    let ended = neurotess_viewer::run(options, listener);
    // Threads that still read or save end with the program: what they have begun must not stay.
    let _ended = neurotess::output::remove_unfinished();
    Ok(ended?)
}

/// What the window shows of synapses and points.
fn markers(asked: &AskedMarkers) -> Result<MarkerOptions, OptionError> {
    asked.check()?;
    let usual = MarkerOptions::default();
    let by = asked.marker_color_by.clone();
    Ok(MarkerOptions {
        synapses: asked.synapses.is_some(),
        edges: asked.populations(),
        side: asked.synapse_side.into(),
        property: by.clone().filter(|_| asked.synapses.is_some()),
        column: by.filter(|_| asked.points.is_some()),
        points: asked.points.clone(),
        shape: asked.shape(),
        size: asked.marker_size.map_or(usual.size, |size| size.0 as f32),
        ..usual
    })
}

/// A mesh of the window. There the camera fits what one cannot see through.
fn mesh((index, arg): (usize, &MeshBeside)) -> MeshEntry {
    let usual = MeshEntry::new(arg.file.clone(), index);
    MeshEntry {
        color: arg.color.map_or(usual.color, |color| color.0),
        opacity: arg.opacity as f32,
        edges: arg.edges,
        scale: arg.scale as f32,
        ..usual
    }
}

/// `--verbose`: every command that runs, on standard error.
fn tell(command: &neurotess_viewer::Command) {
    drop(writeln!(io::stderr(), "command: {command:?}"));
}
