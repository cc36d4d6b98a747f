//! Statistics of pictures: `--stats` and `--json`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use neurotess::cache::Summary;
use serde::Serialize;

use neurotess::coloring::ClosestColors;
use neurotess::drawing::{
    BudgetStats, Cost, Drawing, DrawingSeconds, FilmStats, MeshedCell, SourceStats, StreamStats,
    Unread,
};

use crate::report::Failed;

/// The documented JSON object; times are those of the last picture.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Stats {
    adapter: String,
    backend: String,
    software: bool,
    neurons: usize,
    patches: u64,
    patches_drawn: u64,
    vertices: u64,
    triangles: u64,
    gpu_bytes: BTreeMap<&'static str, u64>,
    bytes_per_point: f64,
    frame_ms: FrameTime,
    level_histogram: BTreeMap<u32, u64>,
    tiles: usize,
    pictures: usize,
    seconds: Stages,
    #[serde(skip_serializing_if = "Option::is_none")]
    exploration: Option<BudgetStats>,
    /// Synapses and points.
    #[serde(skip_serializing_if = "Option::is_none")]
    markers: Option<MarkerStats>,
    /// Meshes that are no cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    meshes: Option<MeshStats>,
    /// Of a film whose pictures are one picture, colored anew.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) film: Option<FilmStats>,
    /// Of a circuit's cache, if one was used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) cache: Option<CacheStats>,
    /// Most memory (bytes) that the program has held so far, where the system tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_bytes: Option<u64>,
    /// Of a legend of several colors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) colors: Option<ColorStats>,
}

/// Seconds since the command began, stage by stage.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Stages {
    /// Reading and meshing.
    read: f64,
    /// Cameras, colors, legend.
    frame: f64,
    /// Opening the adapter.
    adapter: f64,
    /// Making the vertex source and uploading it.
    upload: f64,
    /// Drawing all pictures, and counting triangles.
    draw: f64,
    #[serde(skip)]
    began: Option<Instant>,
}

/// A stage that has ended.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stage {
    Read,
    Draw,
}

impl Stages {
    /// Those of what was made to draw with.
    pub(crate) fn of_drawing(&mut self, seconds: DrawingSeconds) {
        self.frame = seconds.frame;
        self.adapter = seconds.adapter;
        self.upload = seconds.upload;
        self.began = Some(Instant::now());
    }

    /// Starts the clock.
    pub(crate) fn begin() -> Self {
        Self {
            began: Some(Instant::now()),
            ..Self::default()
        }
    }

    /// Adds the time since the last stage ended.
    pub(crate) fn end(&mut self, stage: Stage) {
        let now = Instant::now();
        let seconds = self.began.map_or(0.0, |at| (now - at).as_secs_f64());
        self.began = Some(now);
        *match stage {
            Stage::Read => &mut self.read,
            Stage::Draw => &mut self.draw,
        } += seconds;
    }
}

/// The two colors of the legend that are closest to one another.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ColorStats {
    closest: [String; 2],
    vision: &'static str,
    /// How far they are apart (OKLab).
    difference: f32,
    /// Pairs that look alike.
    alike: usize,
}

impl From<&ClosestColors> for ColorStats {
    fn from(colors: &ClosestColors) -> Self {
        Self {
            closest: colors.names.clone(),
            vision: colors.vision.name(),
            difference: colors.difference,
            alike: colors.alike,
        }
    }
}

/// Synapses and points of the scene, and how many of them the picture draws: they are left out where they lie
/// outside it, or are more than its pixels or the budget can show.
#[derive(Clone, Copy, Debug, Serialize)]
struct MarkerStats {
    drawn: usize,
    in_view: usize,
    all: usize,
}

/// Meshes of the scene that are no cells, and their triangles.
#[derive(Clone, Copy, Debug, Serialize)]
struct MeshStats {
    count: u64,
    triangles: u64,
}

/// Meshes of a circuit's tracings.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CacheStats {
    /// Those that the cache had.
    found: usize,
    /// Those that were generated.
    generated: usize,
    /// The file that was written.
    written: Option<PathBuf>,
}

impl From<Summary> for CacheStats {
    fn from(summary: Summary) -> Self {
        Self {
            found: summary.found,
            generated: summary.computed,
            written: summary.written,
        }
    }
}

/// Milliseconds.
#[derive(Clone, Debug, Default, Serialize)]
struct FrameTime {
    /// From the first command to the last byte.
    cpu: f64,
    /// By pass, if the GPU supports timestamps.
    gpu: Option<BTreeMap<&'static str, f64>>,
}

impl Stats {
    /// Statistics before the first picture.
    pub(crate) fn new(drawing: &Drawing) -> Self {
        let ([adapter, backend], software) = drawing.painter();
        Self {
            adapter: adapter.to_owned(),
            backend: backend.to_owned(),
            software,
            neurons: drawing.neurons(),
            ..Self::default()
        }
    }

    /// Adds a picture, and what it draws, if that is not what the one before draws.
    pub(crate) fn add(&mut self, cost: &Cost, made: Option<SourceStats>) {
        self.pictures += 1;
        self.tiles = cost.tiles;
        if let Some(made) = made {
            self.add_source(made);
        }
        self.gpu_bytes.insert("targets", cost.target_bytes);
        self.frame_ms = FrameTime {
            cpu: cost.cpu_ms,
            gpu: cost.gpu_ms.as_ref().map(|ms| ms.iter().copied().collect()),
        };
    }

    fn add_source(&mut self, made: SourceStats) {
        self.patches = made.patches;
        self.patches_drawn = made.patches_drawn;
        self.vertices = made.vertices;
        self.triangles = made.triangles;
        self.level_histogram = made.levels;
        self.bytes_per_point = made.bytes_per_point;
        self.gpu_bytes = made.bytes;
        self.exploration = made.exploration;
        self.markers = made.markers.map(|[drawn, in_view, all]| MarkerStats {
            drawn,
            in_view,
            all,
        });
        self.meshes = made
            .meshes
            .map(|[count, triangles]| MeshStats { count, triangles });
    }

    /// A message about what was left out or drawn with reduced quality.
    pub(crate) fn lowered(&self) -> Option<String> {
        let BudgetStats {
            budget,
            wanted,
            left_out,
            at_least,
            ..
        } = self.exploration.filter(|explored| explored.left_out > 0)?;
        let least = if at_least { "at least " } else { "" };
        Some(format!(
            "the budget of {budget} triangles: {least}{left_out} of {wanted} are left out, those that \
             show least; --budget allows more"
        ))
    }

    /// A message about tracings that would show more finely with more memory.
    pub(crate) fn coarsened(&self) -> Option<String> {
        let streamed = self.exploration?.streamed?;
        let StreamStats {
            tracings, coarser, ..
        } = (streamed.coarser > 0).then_some(streamed)?;
        Some(format!(
            "{coarser} of {tracings} tracings may be drawn more coarsely than they show: there is no more room for them \
             in the adapter's memory; a larger --gpu-memory allows more, as far as the adapter does"
        ))
    }

    /// A message about synapses and points that are in view and left out.
    pub(crate) fn thinned(&self) -> Option<String> {
        let MarkerStats { drawn, in_view, .. } = self.markers.filter(|m| m.drawn < m.in_view)?;
        Some(format!(
            "{drawn} of {in_view} synapses and points are drawn, evenly chosen: more would lie on one another, or \
             exceed their share of the budget"
        ))
    }

    /// Sets the times of the stages.
    pub(crate) fn took(&mut self, stages: Stages) {
        self.seconds = stages;
        self.peak_bytes = peak_bytes();
    }

    /// The statistics as a line of text.
    pub(crate) fn line(&self) -> String {
        format!(
            "{} triangles of {} neurons in {:.2} s",
            self.triangles,
            self.neurons,
            self.frame_ms.cpu / 1e3
        )
    }
}

/// Most memory (bytes) that the program has held so far: Linux tells.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib = peak.trim().strip_suffix(" kB")?;
    Some(kib.parse::<u64>().ok()? * 1024)
}

/// What `--json` prints.
#[derive(Serialize)]
pub(crate) struct Document<'a> {
    files: Vec<String>,
    inputs: Vec<InputEntry>,
    #[serde(flatten)]
    stats: Option<&'a Stats>,
}

/// An input: its file, and why it failed, if it did.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum InputEntry {
    Done { file: String },
    Failed(Failed),
}

impl From<&Result<MeshedCell, Unread>> for InputEntry {
    fn from(entry: &Result<MeshedCell, Unread>) -> Self {
        match entry {
            Ok(cell) => Self::Done {
                file: cell.file.clone(),
            },
            Err(unread) => Self::Failed(Failed {
                file: unread.file.clone(),
                error: unread.error.clone(),
            }),
        }
    }
}

impl<'a> Document<'a> {
    pub(crate) fn new(
        inputs: Vec<InputEntry>,
        files: &[PathBuf],
        stats: Option<&'a Stats>,
    ) -> Self {
        Self {
            files: files.iter().map(|f| f.display().to_string()).collect(),
            inputs,
            stats,
        }
    }
}
