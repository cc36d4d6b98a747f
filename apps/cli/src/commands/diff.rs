//! `neurotess diff`: what differs between two tracings.

use std::path::{Path, PathBuf};

use clap::Args;
use neurotess::batch;
use neurotess::formats::ReadOptions;
use neurotess::morphology::edit::BeforeAfter;
use neurotess::morphology::{Difference, Differing, MatchedBy};
use serde::Serialize;

use crate::io::output::is_standard;
use crate::report::{Reporter, count, usage};

/// `neurotess diff`
#[derive(Args, Debug)]
#[command(
    after_help = "Samples are matched by their order where both tracings have the same tree, else by their \
    number or by their place, whichever finds more that are the same.
Exit code: 0 if the tracings are the same, 1 if they differ (and, with a line `error: …`, if one cannot be read)."
)]
pub(crate) struct DiffArgs {
    /// A morphology file; FILE.h5#PATH for one cell of a container; - for standard input
    #[arg(value_name = "A")]
    pub(crate) first: PathBuf,
    /// The one to compare it with
    #[arg(value_name = "B")]
    pub(crate) second: PathBuf,
    /// Distances and differences of radii up to this one (µm) are none
    #[arg(long, value_name = "UM", default_value_t = 0.001, value_parser = tolerance,
          allow_negative_numbers = true)]
    pub(crate) tolerance: f64,
}

/// The JSON document.
#[derive(Serialize)]
struct Compared {
    files: [String; 2],
    #[serde(flatten)]
    difference: Difference,
}

/// Runs the command.
pub(crate) fn run(args: &DiffArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let paths = [&args.first, &args.second];
    if paths.iter().all(|path| is_standard(path)) {
        return usage("standard input is one tracing: give a file for the other");
    }
    let read = |path: &Path| match batch::read(path, None, &ReadOptions::default()) {
        Ok(read) => Some(read.morphology),
        Err(error) => {
            reporter.error(&error.to_string());
            None
        }
    };
    let [Some(first), Some(second)] = paths.map(|path| read(path)) else {
        return Ok(());
    };
    let compared = Compared {
        files: paths.map(|path| path.display().to_string()),
        difference: Difference::of(&first, &second, args.tolerance),
    };
    reporter.answer(&text(&compared));
    if !compared.difference.same {
        reporter.differs();
    }
    reporter.document(&compared)
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(tolerance) if tolerance >= 0.0 && f64::is_finite(tolerance) => Ok(tolerance),
        _ => Err("a number from 0 on is needed".into()),
    }
}

/// The differences for people: a line for each kind.
fn text(compared: &Compared) -> String {
    let d = &compared.difference;
    let [a, b] = &compared.files;
    if d.same {
        return format!("{a} and {b} are the same within {} µm", d.tolerance);
    }
    let matched = match d.matched_by {
        MatchedBy::Order => "their order",
        MatchedBy::Number => "their number",
        MatchedBy::Place => "their place",
        _ => "a rule of their own",
    };
    let mut lines = vec![format!(
        "{a} and {b} differ; samples are matched by {matched}"
    )];
    let mut line = |name: &str, value: String| lines.push(format!("  {name:<10} {value}"));
    for (name, numbers) in [
        ("samples", d.samples),
        ("sections", d.sections),
        ("neurites", d.neurites),
        ("forks", d.forks),
        ("ends", d.ends),
    ] {
        if numbers.before != numbers.after {
            line(name, format!("{} → {}", numbers.before, numbers.after));
        }
    }
    for (name, lengths) in lengths(d) {
        if (lengths.before - lengths.after).abs() > d.tolerance {
            line(
                name,
                format!("{:.3} → {:.3} µm", lengths.before, lengths.after),
            );
        }
    }
    for (name, samples) in [
        ("only in A", &d.only_in_first),
        ("only in B", &d.only_in_second),
        ("moved", &d.moved),
        ("radius", &d.radii),
        ("type", &d.types),
        ("parent", &d.parents),
    ] {
        if samples.count > 0 {
            line(name, differing(samples));
        }
    }
    for types in &d.retyped {
        let (from, to) = (types.from.name(), types.to.name());
        line(
            "",
            format!("{from} → {to}: {}", count(types.count, "sample")),
        );
    }
    if let Some(soma) = &d.soma {
        let (kind, radius) = (soma.kind, soma.radius);
        line(
            "soma",
            format!(
                "{} → {}, radius {:.3} → {:.3} µm, moved by {:.3} µm",
                kind.before, kind.after, radius.before, radius.after, soma.moved
            ),
        );
        if soma.count.before != soma.count.after {
            line(
                "somata",
                format!("{} → {}", soma.count.before, soma.count.after),
            );
        }
    }
    lines.join("\n")
}

/// The length of all neurites, and of each type.
fn lengths(d: &Difference) -> [(&'static str, BeforeAfter<f64>); 5] {
    let (before, after) = (d.length_by_type.before, d.length_by_type.after);
    let pair = |before, after| BeforeAfter { before, after };
    [
        ("length", d.length),
        ("  axon", pair(before.axon, after.axon)),
        ("  basal", pair(before.basal_dendrite, after.basal_dendrite)),
        (
            "  apical",
            pair(before.apical_dendrite, after.apical_dendrite),
        ),
        ("  other", pair(before.other, after.other)),
    ]
}

/// How many samples, by how much at most, and which.
fn differing(samples: &Differing) -> String {
    let numbers: Vec<String> = samples.samples.iter().map(i64::to_string).collect();
    let more = if samples.count > numbers.len() {
        ", …"
    } else {
        ""
    };
    let largest = samples
        .largest
        .map_or(String::new(), |l| format!(" by up to {l:.4} µm"));
    format!(
        "{}{largest}: {}{more}",
        count(samples.count, "sample"),
        numbers.join(", ")
    )
}
