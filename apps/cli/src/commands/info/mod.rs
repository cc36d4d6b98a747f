//! `neurotess info`: describes morphologies; circuits.rs describes circuits.

mod between;
mod circuits;
mod rows;
mod table;
mod text;

use std::path::PathBuf;

use clap::Args;
use neurotess::batch::{self, Input, Inputs, MORPHOLOGIES};
use neurotess::formats::{Format, ReadOptions};
use neurotess::morphology::Measures;
use neurotess::morphology::sholl::{self, TooManySpheres};
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use crate::io::batch::each;
use crate::io::circuits::partition;
use crate::io::morphologies::ReaderWarning;
use crate::io::output;
use crate::options::numbers::positive;
use crate::report::{Entry, Failure, Reporter, count, usage};
use between::{Between, End};
use rows::{Per, Row};
use table::Target;

/// `neurotess info`
#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// Morphology files, folders (searched recursively) or globs, - for standard input; circuits (a
    /// SONATA configuration or the folder of one, a network of Snudda, a scene)
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Format of standard input (-), where its content does not tell: swc, asc, h5, nml, traces, xml or json
    #[arg(long, value_name = "FORMAT", value_parser = morphology_format)]
    pub(crate) format: Option<Format>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    /// Write the numbers of all tracings as a table: FILE.csv, FILE.tsv, or - for standard output (tsv there
    /// with tabs)
    #[arg(long, value_name = "FILE")]
    pub(crate) table: Option<Target>,
    /// What a row of the table, and of `rows` of --json, is of [default: cell]
    #[arg(long, visible_alias = "by", value_name = "WHAT", value_enum)]
    pub(crate) per: Option<Per>,
    /// Sholl analysis: crossings of spheres STEP (µm) apart around the soma
    #[arg(long, value_name = "STEP", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) sholl: Option<f64>,
    /// Distance, path, forks and diameters between two samples, by their numbers in the file, or from or to the
    /// soma; may be given several times
    #[arg(long, num_args = 2, value_names = ["A", "B"], allow_negative_numbers = true,
          conflicts_with = "table")]
    pub(crate) between: Vec<End>,
    /// Replace a table that exists
    #[arg(long)]
    pub(crate) force: bool,
}

/// One object of the JSON list.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    #[serde(flatten)]
    measures: Measures,
    warnings: Vec<ReaderWarning>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sholl: Option<Sholl>,
    /// As in the table, if that or --per is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    rows: Option<Vec<Row>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    between: Vec<Between>,
}

/// Crossings of spheres around the soma.
#[derive(Serialize)]
struct Sholl {
    /// Radius of the first sphere, and distance of the others (µm).
    step: f64,
    crossings: Vec<u64>,
}

/// Runs the command.
pub(crate) fn run(args: &InfoArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let (circuits, others) = partition(&args.inputs);
    if !args.between.is_empty() && !circuits.is_empty() {
        return usage("--between is of tracings, not of circuits: give morphology files");
    }
    if let Some(table) = &args.table {
        if !circuits.is_empty() {
            return usage("--table is of tracings, not of circuits: give morphology files");
        }
        output::reserve_standard(&table.path, reporter)?;
        output::check(&table.path, args.force)?;
    } else if args.per.is_some() && !reporter.json() {
        return usage("--per is of --table and of --json: say --table - for standard output");
    }
    let mut inputs = Inputs::default();
    if !others.is_empty() {
        inputs = Inputs::find(&others, &MORPHOLOGIES);
    }
    let options = ReadOptions {
        strict: args.strict,
        for_neuron: true,
        ..ReadOptions::default()
    };
    let results = each(&inputs, reporter, |input| measure(input, args, options))?;
    let several = results.len() > 1;
    match &args.table {
        Some(table) => write_table(table, args, &results, reporter)?,
        None if several => reporter.answer(&text::header()),
        None => {}
    }
    for entry in &results {
        if let Entry::Done(info) = entry {
            if args.table.is_none() {
                let line = if several { text::row } else { text::table };
                reporter.answer(&line(info));
            }
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
        .ok_or_else(|| "use swc, asc, h5, nml, traces, xml or json".into())
}

fn measure(input: &Input, args: &InfoArgs, options: ReadOptions) -> Result<Info, Failure> {
    let read = batch::read(&input.path, args.format, &options)?;
    let file = input.path.display().to_string();
    let failed = |e: TooManySpheres| Failure(format!("{file}: {e}"));
    let sholl = |step| {
        let sections = 0..read.morphology.sections.len() as u32;
        let crossings = sholl::crossings(&read.morphology, step, sections);
        crossings.map(|crossings| Sholl { step, crossings })
    };
    let sholl = args.sholl.map(sholl).transpose().map_err(failed)?;
    let wants_rows = args.table.is_some() || args.per.is_some();
    let rows = wants_rows.then(|| rows::rows(&read.morphology, args.rows_per(), args.sholl));
    let rows = rows.transpose().map_err(failed)?;
    let between = between::between(&file, &read.morphology, &args.between)?;
    Ok(Info {
        between,
        format: read.format,
        measures: Measures::of(&read.morphology),
        warnings: read.warnings.into_iter().map(ReaderWarning::from).collect(),
        sholl,
        rows,
        file,
    })
}

impl InfoArgs {
    fn rows_per(&self) -> Per {
        self.per.unwrap_or(Per::Cell)
    }
}

/// Writes the rows of what could be read; nothing if that is none.
fn write_table(
    table: &Target,
    args: &InfoArgs,
    results: &[Entry<Info>],
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let done = results.iter().filter_map(|entry| match entry {
        Entry::Done(info) => Some((&*info.file, info.rows.as_deref().unwrap_or_default())),
        Entry::Failed(_) => None,
    });
    let files: Vec<(&str, &[Row])> = done.collect();
    if files.is_empty() {
        return Ok(());
    }
    table.write(&files, args.rows_per(), args.sholl, args.force)?;
    if !output::is_standard(&table.path) {
        let rows = files.iter().map(|(_, rows)| rows.len()).sum();
        let (rows, cells) = (count(rows, "row"), count(files.len(), "tracing"));
        reporter.result(&format!("{}: {rows} of {cells}", table.path.display()));
    }
    Ok(())
}

fn warn(info: &Info, several: bool, reporter: &Reporter) {
    if several && !reporter.verbose() {
        return;
    }
    for warning in &info.warnings {
        reporter.warning(&warning.in_file(&info.file));
    }
}
