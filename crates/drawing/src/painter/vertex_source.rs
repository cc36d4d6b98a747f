//! The vertex source for `--lod`, and its statistics.

use std::sync::Arc;

use itertools::Itertools;
use neurotess_color::MarkerSet;
use neurotess_refine::{Lod, LodCriterion, RefineOptions};
use neurotess_render::{
    Adaptive, BoundingSphere, Camera, Combined, DEFAULT_BUDGET, Exploration, ExplorationStats,
    Frame, Gpu, Instance, Markers, MeshGeometry, Meshes, PictureOptions, Placement, Prerefined,
    PrerefinedSurface, Proxy, Scene, Templates, VertexSource,
};
use rayon::prelude::*;

use super::{BudgetStats, SourceStats, StreamStats};
use crate::error::{DrawError, together};
use crate::job::Job;
use crate::meshed::MeshedCell;
use crate::options::DrawOptions;
use crate::scene::bounds::covering;
use crate::scene::markers;
use crate::scene::meshes::{MeshKeys, SceneMeshes};
use neurotess_options::Picture;
use neurotess_options::words::Lod as LodMode;

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

impl PictureSource {
    /// Uploads cells, markers and meshes.
    pub(crate) fn new(
        gpu: &Gpu,
        options: &PictureOptions,
        job: &Job<'_>,
        meshes: SceneMeshes,
    ) -> Result<Self, DrawError> {
        let cells = CellSource::new(gpu, options, job)?;
        let budget = match &cells {
            CellSource::Budgeted(_) => Some(budget(job.asked)),
            _ => None,
        };
        let set = job.colored.markers.as_ref();
        let markers = set.map(|set| upload_markers(gpu, job.asked, options, set, budget));
        Ok(Self {
            cells,
            markers: markers.transpose()?,
            meshes: upload_meshes(gpu, meshes, &job.colored.mesh_keys)?,
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
    ) -> Result<SourceStats, DrawError> {
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
    fn new(gpu: &Gpu, options: &PictureOptions, job: &Job<'_>) -> Result<Self, DrawError> {
        let Job {
            asked,
            cells,
            placements,
            ..
        } = *job;
        match asked.picture.refinement.mode()? {
            LodMode::Prerefined => return prerefined(gpu, job),
            LodMode::Exploration => return budgeted(gpu, options, job),
            LodMode::Homogeneous | LodMode::Adaptive | LodMode::Static => {}
        }
        let shown = job.shown();
        let mut templates = Templates::new();
        let ids = templates.add(gpu, &shown.templates())?;
        let scene = Scene::new(templates, shown.instances(|cell| ids[cell]))?;
        let settings = shown.settings()?;
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
    ) -> Result<SourceStats, DrawError> {
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
                    exploration: Some(budget_stats(&stats)),
                    ..SourceStats::default()
                })
            }
        }
    }
}

/// Most triangles of exploration.
fn budget(asked: &DrawOptions) -> u32 {
    let budget = asked.picture.refinement.budget;
    budget.map_or(DEFAULT_BUDGET, |budget| budget.0)
}

/// The whole picture as one frame.
fn whole(gpu: &Gpu, camera: &Camera, near: f64, options: &PictureOptions) -> Frame {
    let size = options.size.map(|n| n * gpu.sub_pixels(options));
    Frame::whole(*camera, near, size)
}

fn budgeted(gpu: &Gpu, options: &PictureOptions, job: &Job<'_>) -> Result<CellSource, DrawError> {
    let Job {
        asked,
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
    let most = budget(asked);
    let mut source = Exploration::new(gpu, gpu.sub_pixels(options))?;
    source.set_budget(most);
    let memory = asked.device.gpu_memory.map(|bytes| bytes.0);
    let ids = source.add_streamed(gpu, &proxies, memory)?;
    let instances = placements.iter().map(|&(cell, placement)| Instance {
        placement,
        ..Instance::new(ids[cell])
    });
    source.set_instances(gpu, instances.collect())?;
    Ok(CellSource::Budgeted(Box::new(source)))
}

fn prerefined(gpu: &Gpu, job: &Job<'_>) -> Result<CellSource, DrawError> {
    let Job {
        asked,
        cells,
        placements,
        colored,
        cameras,
        spheres,
        ..
    } = *job;
    if placements.iter().any(|(_, at)| *at != Placement::default()) {
        return together(
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
    let levels = |cell: usize| levels(&asked.picture, cells[cell], cameras, spheres);
    let options = RefineOptions::default();
    let source = Prerefined::new(
        gpu,
        &surfaces,
        levels,
        &options,
        asked.picture.look.wireframe,
    )?;
    Ok(CellSource::Prerefined(Box::new(source)))
}

/// Levels of a cell: that of --level, or by the error in pixels; if there are several cameras, by
/// the least distance of anything in view.
fn levels(
    picture: &Picture,
    cell: &MeshedCell,
    cameras: &[Camera],
    spheres: &[BoundingSphere],
) -> Lod<'static> {
    let [width, height] = picture.look.size.0.map(f64::from);
    let nearest = |camera: &Camera| camera.nearest_seen(width / height, spheres);
    match (picture.refinement.level, cameras) {
        (Some(level), _) => LodCriterion::Homogeneous(level.0).into(),
        (None, [camera]) => Lod::seen_from(
            LodCriterion::PixelError(picture.error() as f32),
            camera.refine_view(cell.mesh.origin, height, nearest(camera)),
        ),
        (None, _) => {
            let error =
                |camera: &Camera| camera.pixel_size(height).at(nearest(camera)) * picture.error();
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

fn budget_stats(stats: &ExplorationStats) -> BudgetStats {
    BudgetStats {
        budget: stats.budget,
        wanted: stats.requested,
        left_out: stats.requested - stats.triangles.min(stats.requested),
        at_least: stats.at_least,
        neurons_in_picture: stats.instances,
        streamed: stats.streamed.map(|there| StreamStats {
            tracings: there.templates,
            finer: there.finer,
            whole: there.whole,
            coarser: there.coarser,
            uploaded_bytes: there.uploaded,
        }),
    }
}

/// Uploads markers.
///
/// # Errors
/// They do not fit the device.
fn upload_markers(
    gpu: &Gpu,
    asked: &DrawOptions,
    options: &PictureOptions,
    set: &MarkerSet,
    budget: Option<u32>,
) -> Result<Markers, DrawError> {
    let settings = markers::settings(&asked.picture, gpu.sub_pixels(options), budget);
    Ok(Markers::new(gpu, &set.markers, settings)?)
}

/// Uploads meshes with these color keys; gives none if there are no meshes.
///
/// # Errors
/// They do not fit the device.
fn upload_meshes(
    gpu: &Gpu,
    meshes: SceneMeshes,
    keys: &[MeshKeys],
) -> Result<Option<Meshes>, DrawError> {
    let mut all = Vec::new();
    for (surface, keys, look) in meshes.with_looks(keys) {
        let geometry = MeshGeometry::with_keys(gpu, surface, keys)?;
        all.push((Arc::new(geometry), look));
    }
    Ok((!all.is_empty()).then(|| Meshes::new(gpu, all)))
}
