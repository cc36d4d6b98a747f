//! The scene as pictures in files show it: its colors, legend and scale bar.

use std::sync::Arc;

use neurotess::render::color::ColorTable;
use neurotess::render::overlay::{Annotations, Legend, Overlay, OverlayOptions};
use neurotess::render::{BoundingSphere, Camera, Gpu, Look, MarkerSettings, MarkerShape};

use crate::model::document;
use crate::model::film::FilmFrame;
use crate::model::measuring::Figure;
use crate::model::picture::ToldPicture;
use crate::model::playback::said;
use crate::model::save::PictureFile;
use crate::scene::colors::color_scheme;
use crate::scene::content::SceneContent;
use crate::scene::dimensions::annotations;
use crate::scene::markers::{SceneMarkers, settings};
use crate::scene::meshes::SceneMesh;

/// All that pictures are drawn from, for another thread.
pub(crate) struct StillScene {
    /// The adapter that draws; none: the processor does.
    pub(crate) gpu: Option<Arc<Gpu>>,
    pub(crate) content: SceneContent,
    pub(crate) look: document::Look,
    pub(crate) states: Vec<u32>,
    pub(crate) spheres: Arc<Vec<BoundingSphere>>,
    /// What holds meshes that one can see through, for near planes.
    pub(crate) around: Vec<BoundingSphere>,
    /// Meshes that are no cells; the content has their colors and legend, too.
    pub(crate) meshes: Vec<SceneMesh>,
    /// Synapses and points; the content has their colors and legend, too.
    pub(crate) markers: Option<Arc<SceneMarkers>>,
    /// Their shape and radius (µm).
    pub(crate) form: (MarkerShape, f64),
    /// Dimensions that show.
    pub(crate) figures: Vec<Figure>,
    /// The same in the words of options, which files tell.
    pub(crate) told: ToldPicture,
}

impl StillScene {
    /// What is counted while its pictures are drawn.
    pub(crate) fn steps(&self) -> &'static str {
        match self.gpu {
            Some(_) => "tiles",
            None => "bands",
        }
    }

    /// Color table of a picture, at its time of the recording if there is one.
    pub(super) fn table(&self, time: Option<f64>) -> Result<ColorTable, String> {
        let table = &self.content.table;
        let (Some((recording, _)), Some(time)) = (&self.content.recording, time) else {
            return Ok(table.clone());
        };
        let instances = &self.content.instances;
        let shows = |place: usize| instances.get(place).is_none_or(|s| !s.hidden);
        let frame = recording.at(recording.time.nearest(time), self.look.decay, &shows);
        let frame = frame.map_err(|e| e.to_string())?;
        Ok(ColorTable {
            scale: table.scale.clone(),
            categories: table.categories.clone(),
            values: frame.values(self.range()),
        })
    }

    /// Legend of a picture of this size, with the time of the recording if there is one.
    pub(super) fn legend(&self, time: Option<f64>, size: [u32; 2]) -> Legend {
        let legend = self.content.legend.clone();
        let legend = legend.with_widths(self.least_width(size), self.look.radius_factor());
        match (&self.content.recording, time) {
            (Some((recording, _)), Some(time)) => {
                let time = recording.time.nearest(time);
                legend.noted(&said(&recording.time, time))
            }
            _ => legend,
        }
    }

    /// Least width (pixels) of neurites in a picture of this size.
    pub(super) fn least_width(&self, size: [u32; 2]) -> f32 {
        let instances = self.content.instances.iter();
        let shown = instances.filter(|instance| !instance.hidden).count();
        Look::width_at(self.look.least_width_of(shown), size)
    }

    /// How markers are drawn, as `neurotess render` does. `sub_pixels`: along a pixel's side.
    pub(super) fn marker_settings(&self, sub_pixels: u32) -> MarkerSettings {
        let most = MarkerSettings::default().most_triangles;
        settings(self.form, f64::from(sub_pixels), None, most)
    }

    /// Ends of the scale of the recording.
    pub(super) fn range(&self) -> [f32; 2] {
        let all = self.content.recording.as_ref().map(|(_, all)| *all);
        let chosen = color_scheme(&self.look).range;
        chosen.or(all).unwrap_or([0.0, 1.0])
    }

    /// Dimensions, as the camera of a picture sees them.
    pub(super) fn annotations(&self, camera: &Camera, options: &PictureFile) -> Annotations {
        let line = f64::from(Annotations::line_height(options.size));
        let size = options.size.map(f64::from);
        let annotations = annotations(&self.figures, camera, size, line);
        let background = (!options.transparent).then_some(self.look.background);
        let annotations = annotations.into_iter().flatten().collect();
        Annotations::new(annotations, options.size, background)
    }

    /// Legend, scale bar and axes, in the same corners for all pictures.
    pub(super) fn overlay(&self, film_frames: &[FilmFrame], options: &PictureFile) -> Overlay {
        let cameras: Vec<Camera> = film_frames
            .iter()
            .map(|film_frame| film_frame.view.camera())
            .collect();
        let time = film_frames.first().and_then(|film_frame| film_frame.time);
        let legend = self.legend(time, options.size);
        let overlay = OverlayOptions {
            legend: self.look.legend.then_some(legend),
            scale_bar: self.look.scale_bar.then_some(0.0),
            axes: self.look.axes,
            background: (!options.transparent).then_some(self.look.background),
        };
        Overlay::new(&overlay, options.size, &cameras, &self.spheres)
    }
}
