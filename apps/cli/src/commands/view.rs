//! `neurotess view`: the window.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use neurotess::batch::{Inputs, MORPHOLOGIES};
use neurotess::drawing::picture_of_png;
use neurotess::options::groups::DeviceOptions;
use neurotess::options::words::{Color, Fit};
use neurotess::options::{GivenPicture, Picture};
use neurotess_viewer::CommandListener;
use neurotess_viewer::picture::NOT_TAKEN;
use neurotess_viewer::session::is_session;

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
  neurotess view cell.swc --color-by depth --background black --view top
  neurotess view other.swc --like cell.png
  neurotess view yesterday.neurotess")]
pub(crate) struct ViewArgs {
    /// Morphology files, folders (searched recursively), globs, circuits, or a session that the
    /// window saved; nothing: a window to open files in
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Show cells as this picture does, a PNG file of render, of Python or of the window: camera, colors, look. Options
    /// that are given go before its own
    #[arg(long, value_name = "PICTURE.png")]
    pub(crate) like: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) cache: CacheArgs,
    #[command(flatten)]
    pub(crate) device: DeviceOptions,
    #[command(flatten)]
    pub(crate) given: GivenPicture,
}

/// Runs the command.
pub(crate) fn run(args: &ViewArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let (picture, given) = picture(args, reporter)?;
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
        picture,
        given,
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

/// What is asked for of the picture, and the names of its options.
fn picture(args: &ViewArgs, reporter: &Reporter) -> anyhow::Result<(Picture, Vec<String>)> {
    let GivenPicture { picture, given } = &args.given;
    for (name, why) in NOT_TAKEN {
        if given.iter().any(|given| given == name) {
            return usage(format!("leave out --{}: {why}", name.replace('_', "-")));
        }
    }
    let length = |fit: Option<Fit>| matches!(fit, Some(Fit::Length(length)) if length > 0.0);
    for (name, fit) in [
        ("scale-bar", picture.look.scale_bar),
        ("ao", picture.look.ao),
    ] {
        if length(fit) {
            return usage(format!(
                "--{name} fits by itself in the window: give no length"
            ));
        }
    }
    let asked = args.like.is_some() || !given.is_empty();
    if asked && args.inputs.iter().any(|input| is_session(input)) {
        return usage("a session has its own look: leave out all options of pictures");
    }
    if picture.colors.report.is_some() && args.inputs.is_empty() {
        return usage("--report is of cells: give these, too");
    }
    let (picture, given) = match &args.like {
        Some(like) => {
            let recipe = picture_of_png(like)?;
            if let Some(warning) = recipe.warning(like) {
                reporter.warning(&warning);
            }
            let all = Picture::keywords().into_iter().map(|(name, _)| name);
            let taken = all.filter(|name| NOT_TAKEN.iter().all(|(not, _)| not != name));
            let mut like = recipe.picture.with(picture, given);
            like.colors.background = like.background().map(Color);
            (like, taken.collect())
        }
        None => (picture.clone(), given.clone()),
    };
    picture.check().or_else(|e| usage(e.to_string()))?;
    if given
        .iter()
        .any(|name| name == "report" || name == "range" || name == "time")
    {
        picture.check_values().or_else(|e| usage(e.to_string()))?;
    }
    Ok((picture, given))
}

/// `--verbose`: every command that runs, on standard error.
fn tell(command: &neurotess_viewer::Command) {
    drop(writeln!(io::stderr(), "command: {command:?}"));
}
