//! The vertex source for `--lod`, and its statistics.

use std::collections::BTreeMap;
use std::sync::Arc;

use itertools::Itertools;
use neurotess::refine::{Lod, LodCriterion, RefineOptions};
use neurotess::render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Camera, Combined, DEFAULT_BUDGET, Exploration,
    ExplorationStats, Frame, Gpu, Instance, Markers, Meshes, PictureOptions, Placement, Prerefined,
    PrerefinedSurface, Proxy, Scene, Template, Templates, VertexSource,
};
use rayon::prelude::*;

use super::args::{LodMode, RenderArgs};
use super::bounds::covering;
use super::cells::MeshedCell;
use super::job::RenderJob;
use super::markers;
use super::meshes::SceneMeshes;
use crate::report::usage;

/// A vertex source for pictures, and markers and meshes beside it.
pub(crate) struct PictureSource {
    cells: CellSource,
    markers: Option<Markers>,
    meshes: Option<Meshes>,
}

/// A vertex source for cells.
enum CellSource {
    /// Refined beforehand, in memory.
    Prerefined(Box<Prerefined>),
    /// Refined as it is drawn.
    Adaptive(Box<Adaptive>),
    /// Within a budget.
    Budgeted(Box<Exploration>),
}

/// What a vertex source draws and holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct SourceStats {
    pub(crate) patches: u64,
    pub(crate) patches_drawn: u64,
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) levels: BTreeMap<u32, u64>,
    pub(crate) bytes: BTreeMap<&'static str, u64>,
    pub(crate) bytes_per_point: f64,
    pub(crate) exploration: Option<ExplorationStats>,
    /// Synapses and points that are drawn, those in view, and all.
    pub(crate) markers: Option<[usize; 3]>,
    /// Meshes that are no cells, and their triangles.
    pub(crate) meshes: Option<[u64; 2]>,
}

/// The mode that follows from the options.
///
/// # Errors
/// Wrong usage: a level where levels follow from the error.
pub(crate) fn mode(args: &RenderArgs) -> anyhow::Result<LodMode> {
    let exploring = args.lod == Some(LodMode::Exploration);
    if args.budget.is_some() && !exploring {
        return usage("--budget is for --lod exploration");
    }
    if exploring && args.pixels.is_some() {
        return usage("--lod exploration is within half a pixel: leave out --pixels");
    }
    match (args.lod, args.level) {
        (Some(LodMode::Adaptive), Some(_)) => usage(
            "--lod adaptive chooses levels by --pixels: leave out --level, or use --lod homogeneous",
        ),
        (Some(LodMode::Exploration | LodMode::Static), Some(_)) => {
            usage("this --lod has no levels: leave out --level, or use --lod homogeneous")
        }
        (Some(LodMode::Static), None) if args.pixels.is_some() => {
            usage("--lod static is within half a pixel: leave out --pixels, or use --lod adaptive")
        }
        (Some(mode), _) => Ok(mode),
        (None, Some(_)) => Ok(LodMode::Homogeneous),
        (None, None) => Ok(LodMode::Adaptive),
    }
}

impl PictureSource {
    /// Uploads cells, markers and meshes.
    pub(crate) fn new(
        gpu: &Gpu,
        options: &PictureOptions,
        job: &RenderJob<'_>,
        meshes: SceneMeshes,
    ) -> anyhow::Result<Self> {
        let cells = CellSource::new(gpu, options, job)?;
        let budget = match &cells {
            CellSource::Budgeted(_) => Some(job.args.budget.unwrap_or(DEFAULT_BUDGET)),
            _ => None,
        };
        let set = job.colored.markers.as_ref();
        let markers = set.map(|set| markers::upload(gpu, job.args, options, set, budget));
        Ok(Self {
            cells,
            markers: markers.transpose()?,
            meshes: meshes.upload(gpu, &job.colored.mesh_keys)?,
        })
    }

    /// The source as the renderer takes it.
    pub(crate) fn as_vertex_source(&mut self) -> Combined<'_> {
        Combined::new(self.cells.as_vertex_source())
            .with_markers(self.markers.as_mut())
            .with_meshes(self.meshes.as_mut())
    }

    /// What it draws in a whole picture.
    pub(crate) fn stats(
        &mut self,
        gpu: &Gpu,
        camera: &Camera,
        near: f64,
        options: &PictureOptions,
    ) -> anyhow::Result<SourceStats> {
        let mut stats = self.cells.stats(gpu, camera, near, options)?;
        if let Some(markers) = &mut self.markers {
            let frame = whole(gpu, camera, near, options);
            let [drawn, in_view] = markers.shown(&frame);
            stats.markers = Some([drawn, in_view, markers.len()]);
            stats.bytes.insert("markers", markers.bytes());
        }
        if let Some(meshes) = &self.meshes {
            stats.meshes = Some([meshes.len() as u64, meshes.triangles()]);
            stats.bytes.insert("meshes", meshes.bytes());
        }
        Ok(stats)
    }
}

impl CellSource {
    fn new(gpu: &Gpu, options: &PictureOptions, job: &RenderJob<'_>) -> anyhow::Result<Self> {
        let RenderJob {
            args,
            cells,
            placements,
            colored,
            ..
        } = *job;
        let lod = match mode(args)? {
            LodMode::Prerefined => return prerefined(gpu, job),
            LodMode::Homogeneous => LodCriterion::Homogeneous(args.level.unwrap_or(DEFAULT_LEVEL)),
            LodMode::Adaptive => LodCriterion::PixelError(args.error() as f32),
            LodMode::Static => LodCriterion::PixelError(0.5),
            LodMode::Exploration => return budgeted(gpu, options, job),
        };
        let list: Vec<Template<'_>> = cells
            .iter()
            .zip_eq(&colored.coloring.color_keys)
            .map(|(cell, color_keys)| Template {
                mesh: &cell.mesh,
                color_keys,
                values: &[],
            })
            .collect();
        let mut templates = Templates::new();
        let ids = templates.add(gpu, &list)?;
        let instances = placements.iter().map(|&(cell, placement)| Instance {
            placement,
            ..Instance::new(ids[cell])
        });
        let scene = Scene::new(templates, instances.collect())?;
        let settings = AdaptiveSettings {
            lod,
            wireframe: args.wireframe,
            ..AdaptiveSettings::default()
        };
        let mut source = Adaptive::new(gpu, scene, settings, gpu.sub_pixels(options))?;
        source.set_bounds(covering(cells, placements));
        Ok(Self::Adaptive(Box::new(source)))
    }

    fn as_vertex_source(&mut self) -> &mut dyn VertexSource {
        match self {
            Self::Prerefined(source) => source.as_mut(),
            Self::Adaptive(source) => source.as_mut(),
            Self::Budgeted(source) => source.as_mut(),
        }
    }

    fn stats(
        &mut self,
        gpu: &Gpu,
        camera: &Camera,
        near: f64,
        options: &PictureOptions,
    ) -> anyhow::Result<SourceStats> {
        match self {
            Self::Prerefined(source) => Ok(resident(source)),
            Self::Adaptive(source) => {
                source.prepare(gpu, &whole(gpu, camera, near, options))?;
                let stats = source.stats(gpu)?;
                let levels = (0..).zip(&stats.level_histogram);
                let levels = levels.filter(|&(_, &sides)| sides > 0);
                Ok(SourceStats {
                    patches: stats.patches,
                    patches_drawn: stats.patches_drawn,
                    vertices: stats.vertices,
                    triangles: stats.triangles,
                    levels: levels.map(|(level, &sides)| (level, sides)).collect(),
                    bytes: source.bytes().into_iter().collect(),
                    bytes_per_point: source.bytes_per_point(),
                    ..SourceStats::default()
                })
            }
            Self::Budgeted(source) => {
                source.prepare(gpu, &whole(gpu, camera, near, options))?;
                let stats = source.stats(gpu)?;
                Ok(SourceStats {
                    patches_drawn: stats.visible_chunks,
                    vertices: 2 * stats.triangles,
                    triangles: stats.triangles,
                    bytes: source.bytes().into_iter().collect(),
                    bytes_per_point: source.bytes_per_point(),
                    exploration: Some(stats),
                    ..SourceStats::default()
                })
            }
        }
    }
}

/// The whole picture as one frame.
fn whole(gpu: &Gpu, camera: &Camera, near: f64, options: &PictureOptions) -> Frame {
    let size = options.size.map(|n| n * gpu.sub_pixels(options));
    Frame::whole(*camera, near, size)
}

fn budgeted(
    gpu: &Gpu,
    options: &PictureOptions,
    job: &RenderJob<'_>,
) -> anyhow::Result<CellSource> {
    let RenderJob {
        args,
        cells,
        placements,
        colored,
        ..
    } = *job;
    let proxies: Vec<Arc<Proxy>> = cells
        .par_iter()
        .zip_eq(&colored.coloring.color_keys)
        .map(|(cell, color_keys)| match &cell.proxy {
            Some(proxy) => Arc::new(proxy.with_color_keys(color_keys)),
            None => Arc::new(Proxy::new(&cell.mesh, color_keys)),
        })
        .collect();
    let mut source = Exploration::new(gpu, gpu.sub_pixels(options))?;
    source.set_budget(args.budget.unwrap_or(DEFAULT_BUDGET));
    let ids = source.add_streamed(gpu, &proxies, args.gpu.gpu_memory)?;
    let instances = placements.iter().map(|&(cell, placement)| Instance {
        placement,
        ..Instance::new(ids[cell])
    });
    source.set_instances(gpu, instances.collect())?;
    Ok(CellSource::Budgeted(Box::new(source)))
}

/// Level if none is given.
const DEFAULT_LEVEL: u32 = 4;

fn prerefined(gpu: &Gpu, job: &RenderJob<'_>) -> anyhow::Result<CellSource> {
    let RenderJob {
        args,
        cells,
        placements,
        colored,
        cameras,
        spheres,
        ..
    } = *job;
    if placements.iter().any(|(_, at)| *at != Placement::default()) {
        return usage(
            "--lod prerefined draws tracings where they are: circuits need another --lod",
        );
    }
    let surfaces: Vec<PrerefinedSurface<'_>> = cells
        .iter()
        .zip_eq(&colored.coloring.color_keys)
        .map(|(cell, color_keys)| PrerefinedSurface {
            mesh: &cell.mesh,
            color_keys,
        })
        .collect();
    let levels = |cell: usize| levels(args, cells[cell], cameras, spheres);
    let options = RefineOptions::default();
    let source = Prerefined::new(gpu, &surfaces, levels, &options, args.wireframe)?;
    Ok(CellSource::Prerefined(Box::new(source)))
}

/// Levels of a cell: that of --level, or by the error in pixels; if there are several cameras, by
/// the least distance of anything in view.
fn levels(
    args: &RenderArgs,
    cell: &MeshedCell,
    cameras: &[Camera],
    spheres: &[BoundingSphere],
) -> Lod<'static> {
    let [width, height] = args.size.0.map(f64::from);
    let nearest = |camera: &Camera| camera.nearest_seen(width / height, spheres);
    match (args.level, cameras) {
        (Some(level), _) => LodCriterion::Homogeneous(level).into(),
        (None, [camera]) => Lod::seen_from(
            LodCriterion::PixelError(args.error() as f32),
            camera.refine_view(cell.mesh.origin, height, nearest(camera)),
        ),
        (None, _) => {
            let error =
                |camera: &Camera| camera.pixel_size(height).at(nearest(camera)) * args.error();
            let least = cameras.iter().map(error).fold(f64::MAX, f64::min);
            LodCriterion::MaxError(least as f32).into()
        }
    }
}

fn resident(source: &Prerefined) -> SourceStats {
    let resident = source.resident();
    let bytes = [
        ("vertices", resident.vertex_bytes),
        ("corners", resident.corner_bytes),
    ];
    let sum: u64 = bytes.iter().map(|(_, bytes)| bytes).sum();
    SourceStats {
        patches: resident.patches as u64,
        patches_drawn: source.patches_drawn() as u64,
        vertices: resident.vertices as u64,
        triangles: resident.triangles as u64,
        levels: resident
            .levels
            .iter()
            .map(|(&l, &n)| (l, n as u64))
            .collect(),
        bytes: bytes.into_iter().collect(),
        bytes_per_point: sum as f64 / resident.points.max(1) as f64,
        ..SourceStats::default()
    }
}
