//! Pictures by the processor.

use itertools::Itertools;
use neurotess::mesh::SurfaceMesh;
use neurotess::picture::color::ColorTable;
use neurotess::picture::{
    AdaptiveSettings, Image, MarkerSettings, PictureOptions, Viewpoint, Watch,
};
use neurotess::raster::{self, PictureError};

use super::{Take, Unmade};
use crate::scene::content;
use crate::scene::meshes::SceneMesh;
use crate::scene::still_scene::StillScene;
use neurotess::drawing::Recolored;

/// Markers and meshes beside the cells, which the processor's scene borrows.
#[derive(Default)]
pub(in crate::scene) struct Beside {
    markers: Option<raster::SceneMarkers>,
    meshes: Vec<raster::SceneMesh>,
}

impl Beside {
    /// Those of a scene that the processor draws; of one that an adapter draws nothing.
    pub(in crate::scene) fn new(scene: &StillScene, options: &PictureOptions) -> Self {
        if scene.gpu.is_some() {
            return Self::default();
        }
        let sub_pixels = options.sub_pixels(options.samples_in_sub_pixel());
        Self::with_markers(scene, scene.marker_settings(sub_pixels))
    }

    fn with_markers(scene: &StillScene, settings: MarkerSettings) -> Self {
        let markers = scene.markers.as_ref();
        let markers = markers.filter(|markers| !markers.markers.is_empty());
        let mesh = |mesh: &SceneMesh| {
            raster::SceneMesh::new(SurfaceMesh::clone(&mesh.surface), &[], mesh.look)
        };
        Self {
            markers: markers.map(|markers| raster::SceneMarkers::new(&markers.markers, settings)),
            meshes: scene.meshes.iter().map(mesh).collect(),
        }
    }
}

/// Draws by the processor.
pub(in crate::scene) struct Processor<'a> {
    scene: raster::Scene<'a>,
    watch: Watch,
}

impl<'a> Processor<'a> {
    pub(super) fn new(
        scene: &'a StillScene,
        beside: &'a Beside,
        refined: AdaptiveSettings,
        watch: Watch,
    ) -> Result<Self, String> {
        let content = &scene.content;
        let templates = content::template_list(&content.sources, &content.coloring, None);
        let mut instances = content::device_instances(&content.instances);
        for (instance, &state) in instances.iter_mut().zip_eq(&scene.states) {
            instance.state = state;
        }
        let made = raster::Scene::new(templates, instances, refined);
        let made = made.map_err(|e| e.to_string())?;
        let made = made.with_markers(beside.markers.as_ref());
        Ok(Self {
            scene: made.with_meshes(&beside.meshes),
            watch,
        })
    }

    pub(super) fn draw(
        &self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<(), Unmade> {
        let drawn = raster::draw(&self.scene, view, table, options, &self.watch, take);
        drawn.map(drop).map_err(unmade)
    }

    pub(super) fn draw_static(
        &self,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<Option<Recolored>, Unmade> {
        if options.look.wire > 0.0 {
            return Ok(None);
        }
        let drawn = raster::draw_static(&self.scene, view, table, options, &self.watch);
        let (picture, _) = drawn.map_err(unmade)?;
        Ok(Some(Recolored::Processor(picture)))
    }
}

/// The picture of a view in the window. `refined`, `markers`: how these are drawn.
///
/// # Errors
/// A message: it was stopped, or the scene is not valid.
pub(in crate::scene) fn of_view(
    scene: &StillScene,
    view: &Viewpoint,
    options: &PictureOptions,
    (refined, markers): (AdaptiveSettings, MarkerSettings),
    watch: Watch,
) -> Result<Image, String> {
    let beside = Beside::with_markers(scene, markers);
    let processor = Processor::new(scene, &beside, refined, watch)?;
    let [width, height] = options.size;
    let mut image = Image {
        width,
        height,
        pixels: Vec::with_capacity(4 * width as usize * height as usize),
    };
    let mut take = |_: u32, band: Image| {
        image.pixels.extend(band.pixels);
        Ok(())
    };
    let drawn = processor.draw(view, &scene.content.table, options, &mut take);
    match drawn {
        Ok(()) => Ok(image),
        Err(Unmade::Stopped) => Err("stopped".to_owned()),
        Err(Unmade::Failed(why)) => Err(why),
    }
}

fn unmade<E: std::fmt::Display>(why: PictureError<E>) -> Unmade {
    match why {
        PictureError::Sink(e) => Unmade::Failed(e.to_string()),
        PictureError::Stopped => Unmade::Stopped,
    }
}
