//! Pictures by the processor.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::time::Instant;

use neurotess_mesh::CoarseMesh;
use neurotess_picture::color::ColorTable;
use neurotess_picture::{AdaptiveSettings, Frame, PictureOptions, TemplateId, Viewpoint, Watch};
use neurotess_raster::{
    self as raster, PictureError, Scene, SceneMarkers, SceneMesh, draw_static as draw_keyed,
};

use super::{Cost, Recolored, SourceStats, Take};
use crate::error::DrawError;
use crate::scene::markers;
use crate::scene::meshes::SceneMeshes;
use crate::shown::Shown;

/// Draws by the processor.
pub(super) struct Processor {
    settings: AdaptiveSettings,
    markers: Option<SceneMarkers>,
    meshes: Vec<SceneMesh>,
    pub(super) watch: Watch,
    /// Patches of all cells.
    patches: u64,
    /// Bytes of the cells' meshes by what they hold, and per tracing point.
    bytes: BTreeMap<&'static str, u64>,
    bytes_per_point: f64,
    /// What the last picture took.
    last: raster::Cost,
}

impl Processor {
    pub(super) fn new(
        options: &PictureOptions,
        shown: &Shown<'_>,
        meshes: SceneMeshes,
    ) -> Result<Self, DrawError> {
        let colored = shown.colored;
        let settings = |sub_pixels| markers::settings(&shown.asked.picture, sub_pixels, None);
        let markers = colored.markers.as_ref().map(|set| {
            let in_each = options.samples_in_sub_pixel();
            SceneMarkers::new(&set.markers, settings(options.sub_pixels(in_each)))
        });
        let meshes_of_cells = || shown.cells.iter().map(|cell| &cell.mesh);
        let points: usize = meshes_of_cells().map(|mesh| mesh.tracing.len()).sum();
        let sum = |of: fn(&CoarseMesh) -> usize| meshes_of_cells().map(of).sum::<usize>() as u64;
        let bytes = BTreeMap::from([
            ("tracing", sum(|mesh| size_of_val(&mesh.tracing[..]))),
            ("vertices", sum(|mesh| size_of_val(&mesh.vertices[..]))),
            ("patches", sum(|mesh| size_of_val(&mesh.patches[..]))),
        ]);
        Ok(Self {
            settings: shown.settings()?,
            markers,
            meshes: meshes.for_processor(&colored.mesh_keys),
            watch: Watch::default(),
            patches: shown.patches(),
            bytes_per_point: bytes.values().sum::<u64>() as f64 / points.max(1) as f64,
            bytes,
            last: raster::Cost::default(),
        })
    }

    fn scene<'a>(&'a self, shown: &Shown<'a>) -> Result<Scene<'a>, DrawError> {
        let instances = shown.instances(|cell| TemplateId(cell as u32));
        let scene = Scene::new(shown.templates(), instances, self.settings)?;
        let scene = scene.with_markers(self.markers.as_ref());
        Ok(scene.with_meshes(&self.meshes))
    }

    pub(super) fn draw(
        &mut self,
        shown: &Shown<'_>,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<Cost, DrawError> {
        let clock = Instant::now();
        let scene = self.scene(shown)?;
        let drawn = raster::draw(&scene, view, table, options, &self.watch, take);
        let cost = drawn.map_err(|e| match e {
            PictureError::Sink(e) => e,
            PictureError::Stopped => DrawError::Stopped,
        })?;
        drop(scene);
        self.last = cost.clone();
        Ok(Cost {
            cpu_ms: clock.elapsed().as_secs_f64() * 1e3,
            gpu_ms: None,
            tiles: cost.bands,
            target_bytes: cost.sample_bytes,
        })
    }

    pub(super) fn draw_static(
        &mut self,
        shown: &Shown<'_>,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<Option<(Recolored, usize)>, DrawError> {
        if options.look.wire > 0.0 {
            return Ok(None);
        }
        let scene = self.scene(shown)?;
        let drawn = draw_keyed(&scene, view, table, options, &self.watch);
        let (picture, cost) = drawn.map_err(|e: PictureError<Infallible>| match e {
            PictureError::Sink(never) => match never {},
            PictureError::Stopped => DrawError::Stopped,
        })?;
        drop(scene);
        let bands = cost.bands;
        self.last = cost;
        Ok(Some((Recolored::Processor(picture), bands)))
    }

    pub(super) fn stats(&self, view: &Viewpoint, options: &PictureOptions) -> SourceStats {
        let sub_pixels = options.sub_pixels(options.samples_in_sub_pixel());
        let markers = self.markers.as_ref().map(|markers| {
            let size = options.size.map(|n| n * sub_pixels);
            let [drawn, in_view] = markers.shown(&Frame::whole(view.camera, view.near, size));
            [drawn, in_view, markers.len()]
        });
        let triangles = self.meshes.iter().map(|mesh| mesh.triangles() as u64);
        let count = self.meshes.len() as u64;
        SourceStats {
            patches: self.patches,
            patches_drawn: self.last.patches,
            vertices: self.last.vertices,
            triangles: self.last.triangles,
            levels: self.last.levels.clone(),
            bytes: self.bytes.clone(),
            bytes_per_point: self.bytes_per_point,
            markers,
            meshes: (count > 0).then(|| [count, triangles.sum()]),
            ..SourceStats::default()
        }
    }
}
