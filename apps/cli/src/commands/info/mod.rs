//! `neurotess info`: what is in a morphology; circuits go to `circuit::info`.

mod circuits;

use neurotess::formats::{self, Format, ReadOptions};
use neurotess::morphology::Measures;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use crate::cli::InfoArgs;
use crate::io::inputs::{Input, Inputs, morphology};
use crate::io::workers;
use crate::options::cells as circuit;
use crate::report::progress::Progress;
use crate::report::{Failure, Reporter, count, place};

/// Extensions of morphologies that are looked for in folders.
pub(crate) const MORPHOLOGIES: [&str; 7] = formats::EXTENSIONS;

/// One object of the JSON list.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    #[serde(flatten)]
    measures: Measures,
    warnings: Vec<ReaderWarning>,
}

/// Something odd that the reader took.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ReaderWarning {
    line: Option<u64>,
    code: &'static str,
    message: String,
    count: u64,
}

impl ReaderWarning {
    pub(crate) fn code(&self) -> &'static str {
        self.code
    }

    pub(crate) fn message(&self) -> &str {
        &self.message
    }
}

impl From<formats::Warning> for ReaderWarning {
    fn from(warning: formats::Warning) -> Self {
        let formats::Warning {
            line,
            code,
            message,
            count,
        } = warning;
        Self {
            line,
            code,
            message,
            count,
        }
    }
}

/// An input that failed, in the JSON list.
#[derive(Serialize)]
pub(crate) struct Failed {
    pub(crate) file: String,
    pub(crate) error: String,
}

/// What stands in the JSON list for an input.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum Entry<T> {
    /// It is done.
    Done(T),
    /// It failed.
    Failed(Failed),
}

/// Runs the command.
pub(crate) fn run(args: &InfoArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let (circuits, others) = circuit::partition(&args.inputs);
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

/// One list of two.
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

/// Does some work for all inputs in parallel, and tells of failures. Results are in order.
pub(crate) fn each<T: Send>(
    inputs: &Inputs,
    reporter: &Reporter,
    work: impl Fn(&Input) -> Result<T, Failure> + Sync,
) -> anyhow::Result<Vec<Entry<T>>> {
    inputs.tell(reporter);
    let progress = Progress::new(reporter, inputs.files.len(), "files");
    let order: Vec<usize> = (0..inputs.files.len()).collect();
    let results = workers::run(&inputs.files, &order, reporter.threads(), |input| {
        let result = work(input);
        progress.done();
        result
    })?;
    drop(progress);
    let named = inputs.files.iter().zip(results);
    let entries = named.map(|(input, result)| {
        let file = input.path.display().to_string();
        match result.unwrap_or_else(|panic| Err(bug(&file, &panic))) {
            Ok(done) => Entry::Done(done),
            Err(failure) => {
                reporter.failure(&failure);
                Entry::Failed(Failed {
                    file,
                    error: failure.0,
                })
            }
        }
    });
    Ok(entries.collect())
}

/// The failure that stands for a panic.
pub(crate) fn bug(file: &str, panic: &str) -> Failure {
    Failure(format!(
        "{file}: a bug of neurotess ({panic}): please report it with the file"
    ))
}

fn measure(input: &Input, format: Option<Format>, options: ReadOptions) -> Result<Info, Failure> {
    let read = morphology(&input.path, format, &options)?;
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
    for ReaderWarning {
        line,
        code,
        message,
        ..
    } in &info.warnings
    {
        let place = place(&info.file, *line);
        reporter.warning(&format!("{place} {message} ({code})"));
    }
}

/// One cell for people.
fn table(info: &Info) -> String {
    let m = &info.measures;
    let mut lines = vec![format!("{} ({})", info.file, info.format)];
    let mut line = |name: &str, value: String| lines.push(format!("  {name:<10} {value}"));
    line(
        "points",
        format!(
            "{} in {} of {}",
            m.n_points,
            count(m.n_sections, "section"),
            count(m.n_neurites, "neurite")
        ),
    );
    line(
        "forks",
        format!(
            "{} with 2 children, {} with more; {}; branch order up to {}",
            m.n_bifurcations,
            m.n_multifurcations,
            count(m.n_ends, "end"),
            m.max_branch_order
        ),
    );
    line("length", format!("{:.1} µm", m.length));
    let by_type = [
        ("axon", m.length_by_type.axon),
        ("basal", m.length_by_type.basal_dendrite),
        ("apical", m.length_by_type.apical_dendrite),
        ("other", m.length_by_type.other),
    ];
    for (kind, length) in by_type.into_iter().filter(|&(_, length)| length > 0.0) {
        line("", format!("{kind:<7} {length:.1} µm"));
    }
    line("area", format!("{:.1} µm²", m.area));
    line("volume", format!("{:.1} µm³", m.volume));
    line(
        "soma",
        match m.soma.kind {
            "none" => "none".into(),
            kind => format!(
                "{kind}, radius {:.2} µm, area {:.1} µm², volume {:.1} µm³",
                m.soma.radius, m.soma.area, m.soma.volume
            ),
        },
    );
    if let Some(bounds) = &m.bbox {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| bounds.max[axis] - bounds.min[axis]);
        line("extent", format!("{x:.1} × {y:.1} × {z:.1} µm"));
    }
    line("warnings", info.warnings.len().to_string());
    lines.join("\n")
}

fn header() -> String {
    format!(
        "{:>9} {:>8} {:>8} {:>6} {:>6} {:>11} {:>11}  {:<11} {:>8}  file",
        "points",
        "sections",
        "neurites",
        "forks",
        "ends",
        "length/µm",
        "volume/µm³",
        "soma",
        "warnings"
    )
}

/// One of many cells for people.
fn row(info: &Info) -> String {
    let m = &info.measures;
    format!(
        "{:>9} {:>8} {:>8} {:>6} {:>6} {:>11.1} {:>11.1}  {:<11} {:>8}  {}",
        m.n_points,
        m.n_sections,
        m.n_neurites,
        m.n_bifurcations + m.n_multifurcations,
        m.n_ends,
        m.length,
        m.volume,
        m.soma.kind,
        info.warnings.len(),
        info.file
    )
}
