//! Pictures by a graphics adapter.

use std::sync::Arc;

use neurotess::picture::color::ColorTable;
use neurotess::picture::{PictureOptions, Viewpoint, Watch};
use neurotess::render::{
    Adaptive, Combined, Gpu, Markers, Meshes, PictureError, StaticError, StillRenderer, tiles,
};

use super::{Take, Unmade, refined};
use crate::scene::content;
use crate::scene::meshes;
use crate::scene::still_scene::StillScene;
use neurotess::drawing::Recolored;

/// Draws by an adapter.
pub(in crate::scene) struct Adapter {
    gpu: Arc<Gpu>,
    adaptive: Adaptive,
    markers: Option<Markers>,
    meshes: Option<Meshes>,
    renderer: StillRenderer,
}

impl Adapter {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        scene: &StillScene,
        options: &PictureOptions,
        watch: Watch,
    ) -> Result<Self, String> {
        let sub_pixels = gpu.sub_pixels(options);
        let adaptive = content::adaptive(gpu, &scene.content, sub_pixels);
        let mut adaptive = adaptive.map_err(|e| e.to_string())?;
        adaptive.set_settings(refined(options));
        let markers = scene.markers.as_ref().map(|markers| markers.upload(gpu));
        let mut markers = markers.transpose().map_err(|e| e.to_string())?.flatten();
        if let Some(markers) = &mut markers {
            markers.set_settings(scene.marker_settings(sub_pixels));
        }
        let meshes = meshes::upload(gpu, &scene.meshes).map_err(|e| e.to_string())?;
        let mut renderer = StillRenderer::new();
        renderer.set_states(&scene.states);
        renderer.set_watch(watch);
        Ok(Self {
            gpu: Arc::clone(gpu),
            adaptive,
            markers,
            meshes,
            renderer,
        })
    }

    /// What is drawn, what draws it, and the device.
    fn parts(&mut self) -> (Combined<'_>, &mut StillRenderer, &Arc<Gpu>) {
        let source = Combined::new(&mut self.adaptive)
            .with_markers(self.markers.as_mut())
            .with_meshes(self.meshes.as_mut());
        (source, &mut self.renderer, &self.gpu)
    }

    pub(super) fn tiles(&mut self, view: &Viewpoint, options: &PictureOptions) -> usize {
        let (source, _, gpu) = self.parts();
        tiles(gpu, &source, view, options)
    }

    pub(super) fn draw(
        &mut self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<(), Unmade> {
        let (mut source, renderer, gpu) = self.parts();
        let drawn = renderer.render(gpu, &mut source, view, table, options, take);
        drawn.map(drop).map_err(|e| match e {
            PictureError::Stopped => Unmade::Stopped,
            other => Unmade::Failed(other.to_string()),
        })
    }

    pub(super) fn draw_static(
        &mut self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<Option<Recolored>, Unmade> {
        let (mut source, renderer, gpu) = self.parts();
        match renderer.render_static(gpu, &mut source, view, table, options) {
            Ok(picture) => Ok(Some(Recolored::Adapter(Arc::clone(gpu), picture))),
            Err(StaticError::Wireframe | StaticError::Source) => Ok(None),
            Err(StaticError::Stopped) => Err(Unmade::Stopped),
            Err(StaticError::Device(e)) => Err(Unmade::Failed(e.to_string())),
        }
    }
}
