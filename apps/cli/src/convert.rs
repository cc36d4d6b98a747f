//! `neurotess convert`: morphologies in another format.

use std::collections::BTreeMap;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use neurotess::formats::{self, ReadOptions, swc};
use neurotess::morphology::Morphology;
use serde::Serialize;

use crate::args::ConvertArgs;
use crate::info::{Entry, MORPHOLOGIES, ReaderWarning, each};
use crate::inputs::{Input, Inputs};
use crate::output::{Output, OutputError, broken, refuse_existing};
use crate::report::{Failure, Reporter, usage};
use crate::targets;

/// One object of the JSON list.
#[derive(Serialize)]
struct Converted {
    file: String,
    out: String,
    format: &'static str,
    warnings: Vec<ReaderWarning>,
}

/// Runs the command.
pub(crate) fn run(args: &ConvertArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let inputs = Inputs::find(&args.inputs, &MORPHOLOGIES);
    writable(args, &inputs)?;
    let jobs = targets::plan(&inputs, &args.out.out, "swc")?;
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
        refuse_existing(out, args.out.force).map_err(failed)?;
        let read = formats::read(&input.path, &options).map_err(|e| Failure(e.to_string()))?;
        write_swc(&read.morphology, out, args.out.force).map_err(failed)?;
        Ok(Converted {
            out: out.display().to_string(),
            format: "swc",
            warnings: read.warnings.into_iter().map(ReaderWarning::from).collect(),
            file: file.clone(),
        })
    })?;
    for entry in &converted {
        if let Entry::Done(done) = entry {
            reporter.result(&format!("{} → {}", done.file, done.out));
        }
    }
    reporter.document(&converted)
}

/// Writes a morphology to an SWC file, whole or not at all.
pub(crate) fn write_swc(
    morphology: &Morphology,
    out: &Path,
    force: bool,
) -> Result<(), OutputError> {
    let mut output = Output::create(out, force)?;
    swc::write(morphology, BufWriter::new(output.file())).map_err(|e| broken(out, &e))?;
    output.finish()
}

/// An error if the format asked for cannot be written.
fn writable(args: &ConvertArgs, inputs: &Inputs) -> anyhow::Result<()> {
    let out = &args.out.out;
    let format = match &args.format {
        Some(format) => format.clone(),
        None if targets::is_folder(out, inputs) => "swc".into(),
        None => out
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
    };
    if format.eq_ignore_ascii_case("swc") {
        return Ok(());
    }
    let asked = if format.is_empty() {
        format!("{} has no extension", out.display())
    } else {
        format!("morphologies cannot be written as '{format}'")
    };
    usage(format!("{asked}: this version writes swc"))
}
