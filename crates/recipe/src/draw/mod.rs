//! Pictures of cells, as `neurotess render` draws them.

mod options;
mod picture;

use itertools::Itertools;
use neurotess_color::{Cell, Coloring, coloring};
use neurotess_picture::overlay::{MARGIN, Overlay, OverlayOptions};
use neurotess_picture::{
    AdaptiveSettings, BoundingSphere, Camera, CameraError, DEFAULT_FOV, Image, Instance, Lens,
    SceneError, Template, TemplateId, Viewpoint, Watch, bounds,
};
use neurotess_raster::{PictureError, Scene};
use neurotess_refine::LodCriterion;

use crate::CellMesh;
pub use options::DrawOptions;
pub use picture::{Picture, PictureSaveError};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// The camera is not valid.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The cells cannot be shown.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is nothing to draw.
    #[error("there is no cell to draw")]
    Empty,
}

/// Draws cells where they were traced, by the processor: no graphics driver is needed. `neurotess render` without options
/// draws the same.
///
/// The coarse mesh is refined as it is drawn, so that it is smooth whatever the levels of the surface; where a surface was
/// merged with itself, the tubes show as they were.
///
/// # Errors
/// There is no cell, or the camera is not valid.
pub fn draw(cells: &[&CellMesh], options: &DrawOptions) -> Result<Picture, DrawError> {
    if cells.is_empty() {
        return Err(DrawError::Empty);
    }
    let coloring = colored(cells, options);
    let spheres: Vec<BoundingSphere> = cells
        .iter()
        .flat_map(|cell| bounds::traced(&cell.generated.mesh))
        .collect();
    let (overlay, camera) = framed(&coloring, options, cells.len(), &spheres)?;
    let scene = scene(cells, &coloring, options)?;
    let view = Viewpoint {
        camera,
        near: camera.near(&spheres),
    };
    let [width, height] = options.size;
    let mut image = Image {
        width,
        height,
        pixels: Vec::with_capacity(4 * width as usize * height as usize),
    };
    let take = |top: u32, mut band: Image| {
        overlay.lay_on(top, &mut band);
        image.pixels.extend_from_slice(&band.pixels);
        Ok::<(), std::convert::Infallible>(())
    };
    let picture = options.picture(cells.len());
    let table = &coloring.table;
    match neurotess_raster::draw(&scene, &view, table, &picture, &Watch::default(), take) {
        // Nothing takes the bands but memory, and nobody stops it.
        Ok(_) | Err(PictureError::Sink(_) | PictureError::Stopped) => {}
    }
    let alpha = options.background.is_none();
    Ok(Picture { image, alpha })
}

fn colored(cells: &[&CellMesh], options: &DrawOptions) -> Coloring {
    let cells: Vec<Cell<'_>> = cells
        .iter()
        .map(|cell| Cell {
            name: &cell.morphology.name,
            morphology: &cell.morphology,
            mesh: &cell.generated.mesh,
            radius_factor: cell.options().generate.radius_factor,
        })
        .collect();
    coloring(&cells, options.color_by, &options.scheme())
}

/// Legend and scale bar, and the camera that leaves room for them.
fn framed(
    coloring: &Coloring,
    options: &DrawOptions,
    cells: usize,
    spheres: &[BoundingSphere],
) -> Result<(Overlay, Camera), CameraError> {
    let lens = match options.orthographic {
        true => Lens::orthographic(DEFAULT_FOV),
        false => DEFAULT_FOV.into(),
    };
    let [width, height] = options.size.map(f64::from);
    let fit = |margins| Camera::fit_within(options.side, lens, width / height, margins, spheres);
    let first = fit([MARGIN; 4])?;
    let legend = coloring.legend.clone();
    let legend = legend.with_widths(options.width(cells), 1.0);
    let overlay = OverlayOptions {
        legend: options.legend.then_some(legend),
        scale_bar: options.scale_bar,
        axes: options.axes,
        background: options.background,
    };
    let fitted = |margins| fit(margins).ok();
    let (overlay, cameras) =
        Overlay::with_room(&overlay, options.size, vec![first], spheres, fitted);
    Ok((overlay, cameras.first().copied().unwrap_or(first)))
}

fn scene<'a>(
    cells: &[&'a CellMesh],
    coloring: &'a Coloring,
    options: &DrawOptions,
) -> Result<Scene<'a>, SceneError> {
    let colored = cells.iter().zip_eq(&coloring.color_keys);
    let templates: Vec<Template<'a>> = colored
        .map(|(cell, color_keys)| Template {
            mesh: &cell.generated.mesh,
            color_keys,
            values: &[],
        })
        .collect();
    let ids = (0..templates.len()).map(|id| TemplateId(id as u32));
    let instances = ids.map(Instance::new).collect();
    let settings = AdaptiveSettings {
        lod: LodCriterion::PixelError(options.pixels),
        ..AdaptiveSettings::default()
    };
    Scene::new(templates, instances, settings)
}
