//! What a picture cost: `--stats` and `--json`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use neurotess::render::{Cost, Gpu, Prerefined};
use serde::Serialize;

use super::cells::Cell;
use crate::info::{Entry, Failed};

/// The contract's object; times are of the last picture.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Stats {
    adapter: String,
    backend: String,
    software: bool,
    neurons: usize,
    patches: usize,
    patches_drawn: usize,
    vertices: usize,
    triangles: usize,
    triangles_drawn: usize,
    gpu_bytes: BTreeMap<&'static str, u64>,
    bytes_per_point: f64,
    frame_ms: FrameTime,
    level_histogram: BTreeMap<u32, usize>,
    tiles: usize,
    pictures: usize,
}

/// Milliseconds.
#[derive(Clone, Debug, Default, Serialize)]
struct FrameTime {
    /// From the first command to the last byte.
    cpu: f64,
    /// By pass, where the GPU can tell.
    gpu: Option<BTreeMap<&'static str, f64>>,
}

impl Stats {
    /// Of what is resident.
    pub(crate) fn new(gpu: &Gpu, cells: &[&Cell], maker: &Prerefined) -> Self {
        let resident = maker.resident();
        let bytes = [
            ("vertices", resident.vertex_bytes),
            ("corners", resident.corner_bytes),
        ];
        let sum: u64 = bytes.iter().map(|(_, bytes)| bytes).sum();
        Self {
            adapter: gpu.adapter.name.clone(),
            backend: gpu.adapter.backend.clone(),
            software: gpu.adapter.software,
            neurons: cells.len(),
            patches: resident.patches,
            patches_drawn: resident.patches,
            vertices: resident.vertices,
            triangles: resident.triangles,
            triangles_drawn: 0,
            gpu_bytes: bytes.into_iter().collect(),
            bytes_per_point: sum as f64 / resident.points.max(1) as f64,
            frame_ms: FrameTime::default(),
            level_histogram: resident.levels.clone(),
            tiles: 0,
            pictures: 0,
        }
    }

    /// One more picture.
    pub(crate) fn add(&mut self, cost: &Cost, maker: &Prerefined) {
        self.pictures += 1;
        self.tiles = cost.tiles;
        self.triangles_drawn = maker.drawn();
        self.patches_drawn = maker.patches_drawn();
        self.gpu_bytes.insert("targets", cost.target_bytes);
        self.frame_ms = FrameTime {
            cpu: cost.cpu_ms,
            gpu: cost.gpu_ms.as_ref().map(|ms| ms.iter().copied().collect()),
        };
    }

    /// For people.
    pub(crate) fn line(&self) -> String {
        format!(
            "{} triangles of {} neurons in {:.2} s",
            self.triangles,
            self.neurons,
            self.frame_ms.cpu / 1e3
        )
    }
}

/// What `--json` prints.
#[derive(Serialize)]
pub(crate) struct Document<'a> {
    files: Vec<String>,
    inputs: Vec<Input<'a>>,
    #[serde(flatten)]
    stats: Option<&'a Stats>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Input<'a> {
    Done { file: &'a str },
    Failed(&'a Failed),
}

impl<'a> Document<'a> {
    pub(crate) fn new(
        entries: &'a [Entry<Cell>],
        files: &[PathBuf],
        stats: Option<&'a Stats>,
    ) -> Self {
        let input = |entry: &'a Entry<Cell>| match entry {
            Entry::Done(cell) => Input::Done { file: &cell.file },
            Entry::Failed(failed) => Input::Failed(failed),
        };
        Self {
            files: files.iter().map(|f| f.display().to_string()).collect(),
            inputs: entries.iter().map(input).collect(),
            stats,
        }
    }
}
