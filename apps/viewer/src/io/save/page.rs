//! What the window shows as one HTML page, to send.

use std::io::Write;
use std::path::Path;

use neurotess::coloring::{Cell, ColorScheme};
use neurotess::output::{Existing, write_whole};
use neurotess::web::{MAX_PAGE_BYTES, PageCell, PageMarkers, PageOptions, shared_page};

use super::{MeshPlan, Written};
use crate::model::document::{Look, PAPER};

/// Writes a page of neurons in the window's colors; readers turn them and color them otherwise.
///
/// # Errors
/// There is nothing to show, or too much; the file cannot be written.
pub(crate) fn page(
    path: &Path,
    title: &str,
    plans: &[MeshPlan],
    look: &Look,
    scheme: &ColorScheme,
) -> Result<Written, String> {
    let cells: Vec<PageCell<'_>> = plans
        .iter()
        .map(|plan| PageCell {
            cell: Cell {
                name: &plan.name,
                morphology: &plan.morphology,
                mesh: &plan.generated.mesh,
                radius_factor: look.radius_factor(),
            },
            placement: plan.placement,
        })
        .collect();
    let options = PageOptions {
        title: title.into(),
        // As the reader's system is set, unless another was chosen.
        background: (look.background != PAPER).then_some(look.background),
        palette: look.palette,
        own_colors: look.own_colors.clone(),
        color_map: look.color_map,
        scheme: None,
        least_width: look.least_width_of(cells.len()),
    };
    let made = shared_page(
        &cells,
        scheme,
        look.color_by.in_library(),
        None,
        &PageMarkers::default(),
        &options,
    );
    let made = made.map_err(|e| e.to_string())?;
    let bytes = made.html.len();
    if bytes > MAX_PAGE_BYTES {
        let size = bytes as f64 / 1e6;
        return Err(format!(
            "the page would have {size:.1} MB, which mail does not take: hide some neurons, or use neurotess html --force"
        ));
    }
    write_whole(path, Existing::Replace, |to| {
        to.write_all(made.html.as_bytes())
    })
    .map_err(|e| e.to_string())?;
    let size = bytes.div_ceil(1000);
    Ok(format!("Saved {}: {size} kB", path.display()).into())
}
