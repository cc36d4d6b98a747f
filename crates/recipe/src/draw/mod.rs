//! Pictures of cells, as `neurotess render` draws them.

mod options;
mod picture;

use itertools::Itertools;
use neurotess_color::{Cell, Coloring, coloring};
use neurotess_refine::LodCriterion;
use neurotess_render::overlay::{MARGIN, Overlay, OverlayOptions};
use neurotess_render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Camera, CameraError, DEFAULT_FOV, DeviceError, Gpu,
    Image, Instance, Lens, PictureError, Scene, SceneError, Template, Templates, Viewpoint, bounds,
    render_still,
};

use crate::CellMesh;
pub use options::DrawOptions;
pub use picture::{Picture, PictureSaveError};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// There is no graphics adapter, or it fails.
    #[error(transparent)]
    Device(#[from] DeviceError),
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

/// Draws cells where they were traced, with a device of its own. `neurotess render` without options draws the same.
///
/// The coarse mesh is refined as it is drawn, so that it is smooth whatever the levels of the surface; where a surface was
/// merged with itself, the tubes show as they were.
///
/// # Errors
/// There is no cell, no adapter, or the device fails.
pub fn draw(cells: &[&CellMesh], options: &DrawOptions) -> Result<Picture, DrawError> {
    let gpu = Gpu::open(options.adapter.as_deref())?;
    draw_on(&gpu, cells, options)
}

/// [`draw`] on a device that is open: further pictures take a tenth of the time of the first.
///
/// # Errors
/// There is no cell, or the device fails.
pub fn draw_on(
    gpu: &Gpu,
    cells: &[&CellMesh],
    options: &DrawOptions,
) -> Result<Picture, DrawError> {
    if cells.is_empty() {
        return Err(DrawError::Empty);
    }
    let coloring = colored(cells, options);
    let spheres: Vec<BoundingSphere> = cells
        .iter()
        .flat_map(|cell| bounds::traced(&cell.generated.mesh))
        .collect();
    let (overlay, camera) = framed(&coloring, options, cells.len(), &spheres)?;
    let mut source = source(gpu, cells, &coloring, options)?;
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
    match render_still(gpu, &mut source, &view, table, &picture, take) {
        // Nothing takes the bands but memory, and nobody stops it.
        Ok(_) | Err(PictureError::Sink(_) | PictureError::Stopped) => {}
        Err(PictureError::Device(e)) => return Err(e.into()),
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

fn source(
    gpu: &Gpu,
    cells: &[&CellMesh],
    coloring: &Coloring,
    options: &DrawOptions,
) -> Result<Adaptive, DrawError> {
    let colored = cells.iter().zip_eq(&coloring.color_keys);
    let list: Vec<Template<'_>> = colored
        .map(|(cell, color_keys)| Template {
            mesh: &cell.generated.mesh,
            color_keys,
            values: &[],
        })
        .collect();
    let mut templates = Templates::new();
    let ids = templates.add(gpu, &list)?;
    let instances = ids.into_iter().map(Instance::new).collect();
    let scene = Scene::new(templates, instances)?;
    let settings = AdaptiveSettings {
        lod: LodCriterion::PixelError(options.pixels),
        ..AdaptiveSettings::default()
    };
    let sub_pixels = gpu.sub_pixels(&options.picture(cells.len()));
    let mut source = Adaptive::new(gpu, scene, settings, sub_pixels)?;
    let all = cells
        .iter()
        .map(|cell| bounds::bounds(&cell.generated.mesh));
    source.set_bounds(all.flatten().collect());
    Ok(source)
}
