//! The methods that are compared, and how a frame of each is timed.

use std::time::{Duration, Instant};

use glam::DVec3;
use neurotess::mesh::{CoarseMesh, Surface};
use neurotess::refine::{Lod, LodCriterion, RefineOptions, Refinement};
use neurotess::render::color::ColorTable;
use neurotess::render::{
    Adaptive, AdaptiveSettings, Frame, FrameTime, Gpu, Instance, Meter, Place, Placement,
    Prerefined, PrerefinedSurface, Scene, Template, TemplateId, Templates, VertexSource,
};
use serde::Serialize;

use super::args::RefinementArgs;
use super::scenes::{BenchScene, Neuron};

/// Bytes of a stored triangle: its corners, and half a vertex.
const BYTES_OF_TRIANGLE: u64 = 12 + 12;
/// How long hardware draws before it is timed. NVIDIA's clocks take tenths of a second to climb.
const WARM_UP: Duration = Duration::from_millis(250);

/// Methods that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Method {
    /// Refined beforehand, in memory.
    Prerefined,
    /// On the fly, one level everywhere.
    Homogeneous,
    /// On the fly, with a level that falls with the distance.
    Adaptive,
    /// On the fly, by the error in pixels.
    PixelError,
    /// Refined beforehand, with the same levels as by the error in pixels.
    PrerefinedPixelError,
}

/// A frame's figures.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) neurons: u32,
    pub(crate) method: Method,
    /// Level, for the three methods that have one.
    pub(crate) level: Option<u32>,
    /// Median time (ms) of a frame: the GPU's if it is known, else the time waited.
    pub(crate) ms: f64,
    /// Median time waited (ms), including the CPU's work.
    pub(crate) waited_ms: f64,
    /// Median time (ms) of the selection of levels, if the GPU supports timestamps.
    pub(crate) choose_ms: Option<f64>,
    pub(crate) triangles: u64,
    /// Bytes on the device, without those of the picture.
    pub(crate) bytes: u64,
}

/// Draws scenes by each method, and times it.
pub(crate) struct MethodTimer<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) args: &'a RefinementArgs,
    pub(crate) neurons: &'a [Neuron],
    pub(crate) colors: ColorTable,
}

impl MethodTimer<'_> {
    /// Stored surfaces of a level; none if they need more memory than is allowed.
    pub(crate) fn prerefined(&self, scene: &BenchScene, level: u32) -> anyhow::Result<Option<Row>> {
        let used = self.neurons.len().min(scene.placements.len());
        let patches: usize = self.neurons[..used]
            .iter()
            .map(|n| n.mesh.patches.len())
            .sum();
        let triangles = patches as u64 * 2 * u64::from(level).pow(2);
        if triangles * BYTES_OF_TRIANGLE > self.args.memory << 20 {
            return Ok(None);
        }
        let surfaces: Vec<PrerefinedSurface<'_>> =
            self.neurons[..used].iter().map(Neuron::surface).collect();
        let places: Vec<Place> = scene
            .placements
            .iter()
            .map(|&(mesh, translation)| Place { mesh, translation })
            .collect();
        let levels = |_| LodCriterion::Homogeneous(level).into();
        let options = RefineOptions::default();
        let mut source = Prerefined::placed(self.gpu, &surfaces, &places, levels, &options, false)?;
        let times = self.times(&mut source, scene)?;
        let resident = source.resident();
        let bytes = resident.vertex_bytes + resident.corner_bytes;
        let triangles = source.shown() as u64;
        Ok(Some(row(
            scene,
            Method::Prerefined,
            Some(level),
            &times,
            triangles,
            bytes,
        )))
    }

    /// Stored surfaces with levels by the error in pixels, refined for each neuron's own placement.
    pub(crate) fn prerefined_by_error(&self, scene: &BenchScene) -> anyhow::Result<Row> {
        let moved: Vec<CoarseMesh> = scene
            .placements
            .iter()
            .map(|&(neuron, translation)| {
                let mut mesh = self.neurons[neuron].mesh.clone();
                mesh.origin += translation;
                mesh
            })
            .collect();
        let surfaces: Vec<PrerefinedSurface<'_>> = scene
            .placements
            .iter()
            .zip(&moved)
            .map(|(&(neuron, _), mesh)| PrerefinedSurface {
                mesh,
                color_keys: &self.neurons[neuron].color_keys,
            })
            .collect();
        let frame = &scene.frame;
        let height = f64::from(frame.size[1]);
        let levels = |mesh: usize| {
            Lod::seen_from(
                LodCriterion::PixelError(self.args.pixels as f32),
                frame
                    .camera
                    .refine_view(moved[mesh].origin, height, frame.near),
            )
        };
        let options = RefineOptions::default();
        let mut source = Prerefined::new(self.gpu, &surfaces, levels, &options, false)?;
        let times = self.times(&mut source, scene)?;
        let resident = source.resident();
        let bytes = resident.vertex_bytes + resident.corner_bytes;
        let triangles = source.shown() as u64;
        Ok(row(
            scene,
            Method::PrerefinedPixelError,
            None,
            &times,
            triangles,
            bytes,
        ))
    }

    /// The source that refines a scene as it is drawn.
    pub(crate) fn on_the_fly(&self, scene: &BenchScene) -> anyhow::Result<Adaptive> {
        adaptive(self.gpu, self.neurons, scene, AdaptiveSettings::default())
    }

    /// Times a scene that is refined as it is drawn. `count`: whether triangles are counted, for
    /// which lists are read back.
    pub(crate) fn refined(
        &self,
        source: &mut Adaptive,
        scene: &BenchScene,
        (method, level): (Method, Option<u32>),
        count: bool,
    ) -> anyhow::Result<Row> {
        let level_of = level.unwrap_or(1);
        let lod = match method {
            Method::Homogeneous => LodCriterion::Homogeneous(level_of),
            Method::Adaptive => LodCriterion::Distance {
                level: level_of,
                far: scene.far as f32,
            },
            _ => LodCriterion::PixelError(self.args.pixels as f32),
        };
        source.set_settings(AdaptiveSettings {
            lod,
            ..AdaptiveSettings::default()
        });
        let times = self.times(source, scene)?;
        let triangles = if count {
            source.stats(self.gpu)?.triangles
        } else {
            0
        };
        let bytes = source.bytes().iter().map(|(_, bytes)| bytes).sum();
        Ok(row(scene, method, level, &times, triangles, bytes))
    }

    /// Times some frames, after one that is not counted; only one if it takes long.
    fn times(
        &self,
        source: &mut dyn VertexSource,
        scene: &BenchScene,
    ) -> anyhow::Result<Vec<FrameTime>> {
        let mut meter = Meter::new(self.gpu, source, &self.colors)?;
        let first = meter.time(source, &scene.frame)?;
        if first.waited_ms > 1e3 * self.args.patience {
            return Ok(vec![first]);
        }
        warm_up(self.gpu, &mut meter, source, &scene.frame)?;
        (0..self.args.frames)
            .map(|_| Ok(meter.time(source, &scene.frame)?))
            .collect()
    }
}

/// Draws a frame over and over, uncounted: the clock of graphics hardware climbs under load only. An H200's first
/// frames took up to six times as long as those of larger scenes after them.
pub(crate) fn warm_up(
    gpu: &Gpu,
    meter: &mut Meter,
    source: &mut dyn VertexSource,
    frame: &Frame,
) -> anyhow::Result<()> {
    let clock = Instant::now();
    while !gpu.adapter.software && clock.elapsed() < WARM_UP {
        meter.time(source, frame)?;
    }
    Ok(())
}

/// A scene that is refined as it is drawn.
pub(crate) fn adaptive(
    gpu: &Gpu,
    neurons: &[Neuron],
    scene: &BenchScene,
    settings: AdaptiveSettings,
) -> anyhow::Result<Adaptive> {
    let used = neurons.len().min(scene.placements.len());
    let list: Vec<Template<'_>> = neurons[..used].iter().map(Neuron::template).collect();
    let mut templates = Templates::new();
    let ids = templates.add(gpu, &list)?;
    let scene = Scene::new(templates, instances(scene, &ids))?;
    Ok(Adaptive::new(gpu, scene, settings, 1)?)
}

/// The instances of a scene.
pub(crate) fn instances(scene: &BenchScene, ids: &[TemplateId]) -> Vec<Instance> {
    let instance = |&(neuron, translation): &(usize, DVec3)| {
        // Placements start from the template's coordinates, as translations do.
        let placement = Placement {
            translation,
            ..Placement::default()
        };
        Instance {
            placement,
            ..Instance::new(ids[neuron])
        }
    };
    scene.placements.iter().map(instance).collect()
}

impl Neuron {
    fn surface(&self) -> PrerefinedSurface<'_> {
        PrerefinedSurface {
            mesh: &self.mesh,
            color_keys: &self.color_keys,
        }
    }

    fn template(&self) -> Template<'_> {
        Template {
            mesh: &self.mesh,
            color_keys: &self.color_keys,
            values: &[],
        }
    }

    /// Number of triangles at a level.
    pub(crate) fn triangles(&self, level: u32) -> usize {
        let lod = LodCriterion::Homogeneous(level);
        Refinement::new(&self.mesh, lod, &RefineOptions::default()).triangle_count()
    }
}

fn row(
    scene: &BenchScene,
    method: Method,
    level: Option<u32>,
    times: &[FrameTime],
    triangles: u64,
    bytes: u64,
) -> Row {
    let selection = times
        .iter()
        .filter_map(|time| Some(time.gpu_ms?[0]))
        .collect();
    Row {
        neurons: scene.placements.len() as u32,
        method,
        level,
        ms: median(times.iter().map(FrameTime::best_ms).collect()).unwrap_or(0.0),
        waited_ms: median(times.iter().map(|t| t.waited_ms).collect()).unwrap_or(0.0),
        choose_ms: median(selection),
        triangles,
        bytes,
    }
}

/// The median; none of no values.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
