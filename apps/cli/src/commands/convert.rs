//! `neurotess convert`: morphologies in another format.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use neurotess::formats::{Format, ReadOptions};
use serde::Serialize;

use crate::io::batch::each;
use crate::io::inputs::{Input, Inputs};
use crate::io::morphologies::{
    MORPHOLOGIES, ReaderWarning, read_morphology, readable, write_morphology, written,
};
use crate::io::output::{self, OutputError};
use crate::io::targets;
use crate::options::out::OutArgs;
use crate::report::{Entry, Failure, Reporter, usage};

/// `neurotess convert`
#[derive(Args, Debug)]
pub(crate) struct ConvertArgs {
    /// Morphology files, folders (searched recursively) or globs; - for standard input
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) out: OutArgs,
    /// Format to write, where OUT's extension does not tell: swc, asc or h5
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
}

/// One object of the JSON list.
#[derive(Serialize)]
struct Converted {
    file: String,
    out: String,
    format: &'static str,
    warnings: Vec<ReaderWarning>,
    /// What the format cannot represent.
    lost: Vec<ReaderWarning>,
}

/// Runs the command.
pub(crate) fn run(args: &ConvertArgs, reporter: &Reporter) -> anyhow::Result<()> {
    output::reserve_standard(&args.out.out, reporter)?;
    let inputs = Inputs::find(&args.inputs, &MORPHOLOGIES);
    let format = format(args, &inputs)?;
    let named = args.out.out.extension().unwrap_or_default();
    let named = Format::of_extension(&named.to_string_lossy());
    reporter.warn_of_name(&args.out.out, format.name(), named.map(Format::name));
    let extension = format.extensions()[0];
    let jobs = targets::plan(&inputs, &args.out.out, extension)?;
    let outs: BTreeMap<&PathBuf, &Path> = jobs
        .iter()
        .map(|job| (&job.input, job.out.as_path()))
        .collect();
    let options = ReadOptions {
        strict: args.strict,
    };
    let converted = each(&inputs, reporter, |input: &Input| {
        let out = outs[&input.path];
        let file = input.path.display().to_string();
        let failed = |e: OutputError| Failure(format!("{file}: {e}"));
        readable(&input.path)?;
        output::check(out, args.out.force).map_err(failed)?;
        let read = read_morphology(&input.path, None, &options)?;
        let lost =
            write_morphology(&read.morphology, format, out, args.out.force).map_err(failed)?;
        Ok(Converted {
            out: out.display().to_string(),
            format: extension,
            lost: lost.into_iter().map(ReaderWarning::from).collect(),
            warnings: read.warnings.into_iter().map(ReaderWarning::from).collect(),
            file: file.clone(),
        })
    })?;
    for entry in &converted {
        if let Entry::Done(done) = entry {
            reporter.result(&format!("{} → {}", done.file, done.out));
            report_losses(done, reporter);
        }
    }
    reporter.document(&converted)
}

/// Reports what OUT lacks: everything with --verbose, else the codes.
fn report_losses(done: &Converted, reporter: &Reporter) {
    if done.lost.is_empty() {
        return;
    }
    if reporter.verbose() {
        for loss in &done.lost {
            reporter.warning(&format!("{}: {}", done.out, loss.message()));
        }
        return;
    }
    let codes: Vec<&str> = done.lost.iter().map(ReaderWarning::code).collect();
    reporter.warning(&format!(
        "{}: not all can be said in {}: {} (-v tells more)",
        done.out,
        done.format,
        codes.join(", ")
    ));
}

/// The format named by --format or by OUT's extension; SWC for a folder.
fn format(args: &ConvertArgs, inputs: &Inputs) -> anyhow::Result<Format> {
    let out = &args.out.out;
    let name = match &args.format {
        Some(format) => format.clone(),
        None if targets::is_folder(out, inputs) => return Ok(Format::Swc),
        None => out
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
    };
    let format = Format::of_extension(&name).filter(|f| Format::WRITTEN.contains(f));
    if let Some(format) = format {
        return Ok(format);
    }
    let name = if name.is_empty() {
        format!("{} has no extension", out.display())
    } else {
        format!("morphologies cannot be written as '{name}'")
    };
    usage(format!("{name}: use {}", written().join(", ")))
}
