//! Pictures of cells that were meshed, in one call.

use std::sync::Arc;

use neurotess_options::Picture;
use neurotess_options::words::RadiusFactor;
use neurotess_picture::Placement;
use neurotess_recipe::CellMesh;

use crate::drawing::Drawing;
use crate::error::DrawError;
use crate::host::Quiet;
use crate::meshed::MeshedCell;
use crate::options::OwnData;
use crate::painter::open;
use crate::png::DrawnImage;
use crate::scene::Scene;

/// Draws cells where they were traced, with the options of `neurotess render`. By the processor, unless a large scene is
/// worth a graphics adapter: no driver is needed.
///
/// The coarse mesh is refined as it is drawn, so that it is smooth whatever the levels of the surface; where a surface was
/// merged with itself, the tubes show as they were. Which cells there are and how they are meshed is not looked at: they
/// are.
///
/// # Errors
/// There is no cell, or options that do not go together.
pub fn draw(cells: &[&CellMesh], picture: &Picture) -> Result<DrawnImage, DrawError> {
    let mut picture = picture.clone();
    let factor = cells
        .first()
        .map(|cell| cell.options().generate.radius_factor);
    picture.shape.radius_factor = factor.filter(|&factor| factor != 1.0).map(RadiusFactor);
    let meshed = cells.iter().map(|cell| {
        let morphology = (*cell.morphology).clone();
        let name = morphology.name.clone();
        Ok(MeshedCell::of_mesh(
            name,
            morphology,
            (*cell.generated).clone(),
        ))
    });
    let scene = Scene {
        entries: meshed.collect(),
        placements: (0..cells.len())
            .map(|cell| (cell, Placement::default()))
            .collect(),
        instances: None,
        cache: None,
    };
    let host = Quiet::default();
    let own = OwnData::default();
    let mut drawing = Drawing::of_scene(scene, picture.clone().into(), own, &open, &host)?;
    let image = drawing.draw(0, &Arc::default())?;
    Ok(DrawnImage {
        image,
        recipe: drawing.recipe(0),
        picture,
    })
}
