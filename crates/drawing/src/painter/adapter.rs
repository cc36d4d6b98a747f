//! Pictures by a graphics adapter.

use std::sync::Arc;

use neurotess_picture::color::ColorTable;
use neurotess_picture::{PictureOptions, Viewpoint};
use neurotess_render::{Gpu, PictureError, StaticError, StillRenderer, tiles};

use super::vertex_source::PictureSource;
use super::{Cost, Recolored, SourceStats, Take};
use crate::error::DrawError;
use crate::job::Job;
use crate::scene::meshes::SceneMeshes;

/// Draws by an adapter.
pub(super) struct Adapter {
    gpu: Arc<Gpu>,
    source: PictureSource,
    pub(super) renderer: StillRenderer,
}

impl Adapter {
    pub(super) fn new(
        gpu: Arc<Gpu>,
        options: &PictureOptions,
        job: &Job<'_>,
        meshes: SceneMeshes,
    ) -> Result<Self, DrawError> {
        Ok(Self {
            source: PictureSource::new(&gpu, options, job, meshes)?,
            gpu,
            renderer: StillRenderer::new(),
        })
    }

    pub(super) fn draw(
        &mut self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<Cost, DrawError> {
        let mut source = self.source.as_vertex_source();
        let drawn = self
            .renderer
            .render(&self.gpu, &mut source, view, table, options, take);
        let cost = drawn.map_err(|e| match e {
            PictureError::Sink(e) => e,
            other => DrawError::failed(other),
        })?;
        Ok(Cost {
            cpu_ms: cost.cpu_ms,
            gpu_ms: cost.gpu_ms,
            tiles: cost.tiles,
            target_bytes: cost.target_bytes,
        })
    }

    pub(super) fn draw_static(
        &mut self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<Option<(Recolored, usize)>, DrawError> {
        let gpu = &self.gpu;
        let mut source = self.source.as_vertex_source();
        let tiles = tiles(gpu, &source, view, options);
        let made = self
            .renderer
            .render_static(gpu, &mut source, view, table, options);
        match made {
            Ok(picture) => Ok(Some((Recolored::Adapter(Arc::clone(gpu), picture), tiles))),
            Err(StaticError::Wireframe | StaticError::Source) => Ok(None),
            Err(e) => Err(DrawError::failed(e)),
        }
    }

    pub(super) fn stats(
        &mut self,
        view: &Viewpoint,
        options: &PictureOptions,
    ) -> Result<SourceStats, DrawError> {
        self.source
            .stats(&self.gpu, &view.camera, view.near, options)
    }
}
