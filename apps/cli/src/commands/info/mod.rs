//! `neurotess info`: describes morphologies; circuits.rs describes circuits.

mod circuits;
mod text;

use std::path::PathBuf;

use clap::Args;
use neurotess::formats::{Format, ReadOptions};
use neurotess::morphology::Measures;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use crate::io::batch::each;
use crate::io::circuits::partition;
use crate::io::inputs::{Input, Inputs};
use crate::io::morphologies::{MORPHOLOGIES, ReaderWarning, read_morphology};
use crate::report::{Entry, Failure, Reporter};
use text::{header, row, table};

/// `neurotess info`
#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// Morphology files, folders (searched recursively) or globs, - for standard input; circuits (a
    /// SONATA configuration or the folder of one, a scene)
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Format of standard input (-), where its content does not tell: swc, asc, h5 or nml
    #[arg(long, value_name = "FORMAT", value_parser = morphology_format)]
    pub(crate) format: Option<Format>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
}

/// One object of the JSON list.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    #[serde(flatten)]
    measures: Measures,
    warnings: Vec<ReaderWarning>,
}

/// Runs the command.
pub(crate) fn run(args: &InfoArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let (circuits, others) = partition(&args.inputs);
    let mut inputs = Inputs::default();
    if !others.is_empty() {
        inputs = Inputs::find(&others, &MORPHOLOGIES);
    }
    let options = ReadOptions {
        strict: args.strict,
    };
    let results = each(&inputs, reporter, |input| {
        measure(input, args.format, options)
    })?;
    let several = results.len() > 1;
    if several {
        reporter.answer(&header());
    }
    for entry in &results {
        if let Entry::Done(info) = entry {
            reporter.answer(&if several { row(info) } else { table(info) });
            warn(info, several, reporter);
        }
    }
    let described = circuits::describe_all(&circuits, reporter)?;
    reporter.document(&(Chained(results, described)))
}

/// Two lists that are written as one.
struct Chained<A, B>(Vec<A>, Vec<B>);

impl<A: Serialize, B: Serialize> Serialize for Chained<A, B> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(self.0.len() + self.1.len()))?;
        self.0
            .iter()
            .try_for_each(|item| list.serialize_element(item))?;
        self.1
            .iter()
            .try_for_each(|item| list.serialize_element(item))?;
        list.end()
    }
}

/// A format of morphologies, by its name or an extension.
fn morphology_format(name: &str) -> Result<Format, String> {
    let named = Format::ALL.into_iter().find(|f| f.name() == name);
    named
        .or_else(|| Format::of_extension(name))
        .ok_or_else(|| "use swc, asc, h5 or nml".into())
}

fn measure(input: &Input, format: Option<Format>, options: ReadOptions) -> Result<Info, Failure> {
    let read = read_morphology(&input.path, format, &options)?;
    Ok(Info {
        file: input.path.display().to_string(),
        format: read.format,
        measures: Measures::of(&read.morphology),
        warnings: read.warnings.into_iter().map(ReaderWarning::from).collect(),
    })
}

fn warn(info: &Info, several: bool, reporter: &Reporter) {
    if several && !reporter.verbose() {
        return;
    }
    for warning in &info.warnings {
        reporter.warning(&warning.in_file(&info.file));
    }
}
