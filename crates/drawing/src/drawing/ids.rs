//! What is at each pixel of a picture: a static picture whose colors are the tracing points.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::DVec3;
use neurotess_morphology::SectionId;
use neurotess_picture::color::{CATEGORY_BIT, ColorTable, category};
use neurotess_picture::{
    Camera, Occlusion, PictureOptions, Template, TemplateId, Viewpoint, VisibleKey, Watch,
};
use neurotess_raster::{PictureError, Scene, StaticPicture, draw_static};
use rayon::prelude::*;

use super::{Drawing, shown};
use crate::error::DrawError;
use crate::meshed::MeshedCell;

/// What is at each pixel, row by row from the top left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IdImage {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Index of the cell among those that are drawn; −1 where nothing is.
    pub cell: Vec<i32>,
    /// Section as meshes number them: 0 on the soma, else one more than the section's index; −1 where nothing is.
    pub section: Vec<i32>,
    /// The file's own number of the nearest sample; −1 on the soma and where nothing is.
    pub sample: Vec<i64>,
}

/// What is at a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// Index of the cell among those that are drawn.
    pub cell: usize,
    /// Its name: that of the cell, or population and id of a node.
    pub name: String,
    /// The id of the node, if it is of a circuit.
    pub node: Option<u64>,
    /// The section; none on the soma.
    pub section: Option<SectionId>,
    /// The file's own number of the nearest sample; none on the soma.
    pub sample: Option<i64>,
    /// Where that was traced (µm).
    pub position: DVec3,
}

/// A picture of tracing points that is kept for the next question.
pub(super) struct KeptIds {
    camera: Camera,
    size: [u32; 2],
    picture: StaticPicture,
}

impl Drawing {
    /// What shows at each pixel of one of the pictures: at its middle, so that there are no mixtures at borders. Markers and
    /// meshes beside the cells hide nothing, and legends are left out.
    ///
    /// # Errors
    /// There is no such picture, or it was stopped.
    pub fn ids(&mut self, picture: usize, stopped: &Arc<AtomicBool>) -> Result<IdImage, DrawError> {
        let Some(camera) = self.camera(picture) else {
            return Err(DrawError::Failed("there is no such picture".into()));
        };
        if self.placements.is_empty() {
            let why = "no cell is drawn, and ids are those of cells: draw the cell of the mesh";
            return Err(DrawError::Failed(why.into()));
        }
        let size = self.options().picture.look.size.0;
        let drawn = self.points(&camera, size, stopped)?;
        let labels: Vec<Vec<(i32, i64)>> = self.cells.par_iter().map(labels).collect();
        let [width, height] = size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let mut image = IdImage {
            size,
            ..IdImage::default()
        };
        for at in pixels {
            let shown = drawn.key_at(at).map(|key| {
                let (cell, _) = self.placements[key.instance as usize];
                let (section, sample) = labels[cell][point(&key)];
                (key.instance as i32, section, sample)
            });
            let (cell, section, sample) = shown.unwrap_or((-1, -1, -1));
            image.cell.push(cell);
            image.section.push(section);
            image.sample.push(sample);
        }
        Ok(image)
    }

    /// What is at a pixel, or nearest to it within `reach` pixels, in a picture from anywhere.
    ///
    /// # Errors
    /// It was stopped.
    pub fn pick(
        &mut self,
        camera: &Camera,
        size: [u32; 2],
        [x, y]: [f64; 2],
        reach: f64,
        stopped: &Arc<AtomicBool>,
    ) -> Result<Option<Picked>, DrawError> {
        let kept = self.kept_ids.take();
        let kept = match kept.filter(|kept| (kept.camera, kept.size) == (*camera, size)) {
            Some(kept) => kept,
            None => KeptIds {
                camera: *camera,
                size,
                picture: self.points(camera, size, stopped)?,
            },
        };
        let reach = reach.ceil() as i64;
        let around = || -reach..=reach;
        let mut steps: Vec<[i64; 2]> = around()
            .flat_map(|down| around().map(move |right| [right, down]))
            .collect();
        steps.sort_by_key(|[right, down]| right * right + down * down);
        let key = steps.iter().find_map(|[right, down]| {
            let at = [x as i64 + right, y as i64 + down];
            let at = at.map(|n| u32::try_from(n).unwrap_or(u32::MAX));
            kept.picture.key_at(at)
        });
        self.kept_ids = Some(kept);
        Ok(key.map(|key| self.picked(&key)))
    }

    fn picked(&self, key: &VisibleKey) -> Picked {
        let instance = key.instance as usize;
        let (cell, placement) = self.placements[instance];
        let shown = &self.cells[cell];
        let (name, node) = match &self.instances {
            Some(circuit) => (
                circuit.names().swap_remove(instance),
                Some(circuit.instances[instance].id),
            ),
            None => (shown.file.clone(), None),
        };
        let traced = &shown.mesh.tracing[point(key)];
        let center = shown.mesh.origin + traced.center.as_dvec3();
        let section = u32::try_from(traced.section.0 - 1).ok().map(SectionId);
        let labels = shown.morphology.sample_labels();
        Picked {
            cell: instance,
            name,
            node,
            section,
            sample: section.map(|_| labels.own_number(i64::from(traced.sample.0))),
            position: placement.world_from_cell(center),
        }
    }

    /// A picture whose color keys are tracing points.
    fn points(
        &self,
        camera: &Camera,
        size: [u32; 2],
        stopped: &Arc<AtomicBool>,
    ) -> Result<StaticPicture, DrawError> {
        let cells: Vec<&MeshedCell> = self.cells.iter().collect();
        let shown = shown(&self.asked, &cells, &self.placements, &self.colored);
        let points =
            |cell: &&MeshedCell| (0..cell.mesh.tracing.len() as u32).map(category).collect();
        let keys: Vec<Vec<u32>> = cells.iter().map(points).collect();
        let templates = cells.iter().zip(&keys).map(|(cell, keys)| Template {
            mesh: &cell.mesh,
            color_keys: keys,
            values: &[],
        });
        let instances = shown.instances(|cell| TemplateId(cell as u32));
        let scene = Scene::new(templates.collect(), instances, shown.settings()?)?;
        let drawn = self.asked.picture.drawn(self.colored.least_width());
        let mut options = PictureOptions {
            size,
            samples: 1,
            occlusion: Occlusion::Off,
            ..drawn
        };
        options.look.wire = 0.0;
        let near = camera.near(&self.around);
        let view = Viewpoint {
            camera: *camera,
            near,
        };
        let watch = Watch {
            stopped: Arc::clone(stopped),
            ..Watch::default()
        };
        let drawn = draw_static(&scene, &view, &ColorTable::default(), &options, &watch);
        let (picture, _) = drawn.map_err(|e| match e {
            PictureError::Sink(never) => match never {},
            PictureError::Stopped => DrawError::Stopped,
        })?;
        Ok(picture)
    }
}

/// The tracing point of a color key.
fn point(key: &VisibleKey) -> usize {
    (key.color_key & !CATEGORY_BIT) as usize
}

/// Section and sample of each tracing point, as [`IdImage`] tells them.
fn labels(cell: &MeshedCell) -> Vec<(i32, i64)> {
    let labels = cell.morphology.sample_labels();
    let tracing = cell.mesh.tracing.iter();
    let label = |section: i32, sample: i32| match section {
        ..=0 => (0, -1),
        _ => (section, labels.own_number(i64::from(sample))),
    };
    tracing
        .map(|traced| label(traced.section.0, traced.sample.0))
        .collect()
}
