//! A circuit from cold start to its first picture: without a cache, with one that is written, and with one that is
//! there. Each opening is a program of its own, `neurotess render --lod exploration`, so that nothing is left of the
//! one before but its files.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::args::OpeningArgs;
use crate::report::{Progress, Reporter};

/// The JSON document.
#[derive(Serialize)]
struct Document {
    neurons: u32,
    morphologies: u32,
    points: u32,
    cache_bytes: u64,
    rows: Vec<Row>,
}

/// An opening.
#[derive(Serialize)]
struct Row {
    cache: &'static str,
    /// From start to end of the program.
    all: f64,
    #[serde(flatten)]
    stats: RenderStats,
}

/// What `render --stats` says of it.
#[derive(Deserialize, Serialize)]
struct RenderStats {
    seconds: Seconds,
    /// Meshes that the cache had, and those that were generated.
    #[serde(alias = "cache")]
    meshes: Option<Meshes>,
    peak_bytes: Option<u64>,
}

#[derive(Deserialize, Serialize)]
struct Seconds {
    read: f64,
    frame: f64,
    adapter: f64,
    upload: f64,
    draw: f64,
}

#[derive(Deserialize, Serialize)]
struct Meshes {
    found: usize,
    generated: usize,
}

/// Runs the benchmark.
pub(super) fn run(args: &OpeningArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let folder = tempfile::tempdir().context("a folder for the circuit")?;
    let circuit = folder.path().join("circuit");
    let OpeningArgs {
        neurons,
        morphologies,
        points,
        ..
    } = *args;
    let made = format!(
        "synth circuit --seed 1 --reported 1 --neurons {neurons} --morphologies {morphologies} --points {points}"
    );
    start(
        made.split(' ')
            .map(OsStr::new)
            .chain([OsStr::new("-o"), circuit.as_os_str()]),
    )?;
    let progress = Progress::new(reporter, 3, "openings");
    reporter.result(&format!(
        "{neurons} neurons of {morphologies} tracings of {points} points\n{:<10} {:>6} {:>6} {:>8} {:>7} {:>6} \
         {:>6} {:>9} {:>17}",
        "cache", "read", "frame", "adapter", "upload", "draw", "all", "peak MiB", "found, generated"
    ));
    let mut rows = Vec::new();
    for cache in ["none", "written", "there"] {
        let row = open(&circuit, folder.path(), cache, args)?;
        reporter.result(&line(&row));
        rows.push(row);
        progress.done();
    }
    drop(progress);
    let file = circuit
        .join("circuit_config")
        .with_extension(neurotess::cache::EXTENSION);
    // Of small circuits none is written.
    let cache_bytes = std::fs::metadata(file).map_or(0, |data| data.len());
    reporter.result(&format!("cache: {:.0} MiB", mib(cache_bytes)));
    reporter.document(&Document {
        neurons,
        morphologies,
        points,
        cache_bytes,
        rows,
    })
}

/// Opens the circuit and draws it.
fn open(
    circuit: &Path,
    folder: &Path,
    cache: &'static str,
    args: &OpeningArgs,
) -> anyhow::Result<Row> {
    let (picture, stats) = (folder.join("picture.png"), folder.join("stats.json"));
    let [width, height] = args.size.0;
    let size = format!("{width}x{height}");
    let mut arguments = vec![OsStr::new("render"), circuit.as_os_str()];
    arguments.extend(
        [
            "--force",
            "--quiet",
            "--lod",
            "exploration",
            "--size",
            &size,
        ]
        .map(OsStr::new),
    );
    arguments.extend([OsStr::new("-o"), picture.as_os_str()]);
    arguments.extend([OsStr::new("--stats"), stats.as_os_str()]);
    if let Some(adapter) = &args.adapter {
        arguments.extend([OsStr::new("--adapter"), OsStr::new(adapter)]);
    }
    if cache == "none" {
        arguments.push(OsStr::new("--no-cache"));
    }
    let clock = Instant::now();
    start(arguments)?;
    let all = clock.elapsed().as_secs_f64();
    let text = std::fs::read(&stats).context("statistics of an opening")?;
    Ok(Row {
        cache,
        all,
        stats: serde_json::from_slice(&text).context("statistics of an opening")?,
    })
}

/// Runs this program with other arguments.
fn start<'a>(arguments: impl IntoIterator<Item = &'a OsStr>) -> anyhow::Result<()> {
    let program = std::env::current_exe().context("this program")?;
    let mut command = Command::new(program);
    // In the Python package the program is Python: its script, or `-m neurotess`, comes before the command's name.
    let before = std::env::args_os()
        .skip(1)
        .take_while(|word| word != "bench");
    command.args(before).args(arguments).stdout(Stdio::null());
    let status = command.status().context("this program")?;
    anyhow::ensure!(status.success(), "an opening failed: see above");
    Ok(())
}

fn line(row: &Row) -> String {
    let RenderStats {
        seconds,
        meshes,
        peak_bytes,
    } = &row.stats;
    let peak = peak_bytes.map_or("-".into(), |bytes| format!("{:.0}", mib(bytes)));
    let meshes = meshes.as_ref().map_or("-".into(), |meshes| {
        format!("{}, {}", meshes.found, meshes.generated)
    });
    format!(
        "{:<10} {:>6.2} {:>6.2} {:>8.2} {:>7.2} {:>6.2} {:>6.2} {peak:>9} {meshes:>17}",
        row.cache,
        seconds.read,
        seconds.frame,
        seconds.adapter,
        seconds.upload,
        seconds.draw,
        row.all
    )
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}
