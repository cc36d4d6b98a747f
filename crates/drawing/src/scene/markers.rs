//! Synapses and points of a picture.

use neurotess_circuit::{Circuit, NodeRef, PointTable};
use neurotess_color::{self as coloring, ColorScheme, MarkerSet, SynapseOptions};
use neurotess_picture::{MarkerSettings, MarkerShape};

use neurotess_options::Picture;
use neurotess_options::groups::MarkerOptions;

use crate::error::{DrawError, together};
use crate::host::Host;
use crate::text::count;

/// Least diameter (pixels) of a marker.
const LEAST: f64 = 3.0;
/// Share of exploration's budget that markers may take beside it.
const SHARE_OF_BUDGET: f64 = 0.2;

/// Reads what the options ask for; `drawn`: the nodes of a circuit that are drawn.
///
/// # Errors
/// Wrong usage; files that are invalid, or do not have what is asked for.
pub fn read_markers(
    asked: &MarkerOptions,
    drawn: Option<(&Circuit, &[NodeRef])>,
    scheme: &ColorScheme,
    host: &dyn Host,
) -> Result<Option<MarkerSet>, DrawError> {
    asked.check()?;
    if !asked.any() {
        return Ok(None);
    }
    let property = asked.marker_color_by.as_deref();
    if let Some(file) = &asked.points {
        let table = PointTable::read(file).map_err(DrawError::failed)?;
        let name = file.display().to_string();
        let set = coloring::points(&name, &table, property, scheme).map_err(DrawError::failed)?;
        host.note(&count(set.markers.len(), "point"));
        return Ok(Some(set));
    }
    let Some((circuit, nodes)) = drawn else {
        return together("--synapses needs a circuit, whose edges say where they are");
    };
    let options = SynapseOptions {
        populations: asked.populations(),
        side: asked.synapse_side.into(),
        property: property.map(str::to_owned),
        contacts: asked.shape() == MarkerShape::Contact,
    };
    let set = coloring::synapses(circuit, nodes, &options, scheme);
    let set = set.map_err(DrawError::failed)?;
    let shown = set.markers.len();
    host.note(&format!(
        "{} of the cells that are drawn, {} of others",
        count(shown, "synapse"),
        set.left_out
    ));
    if set.placeless > 0 {
        host.warning(&format!(
            "{} left out: they name sections that the tracings of their cells do not have",
            count(set.placeless, "synapse")
        ));
    }
    if shown == 0 {
        host.warning("no synapse belongs to a cell that is drawn");
    }
    Ok(Some(set))
}

/// How they are drawn. `sub_pixels`: along a pixel's side; `budget`: of exploration (triangles).
pub(crate) fn settings(picture: &Picture, sub_pixels: u32, budget: Option<u32>) -> MarkerSettings {
    let usual = MarkerSettings::default();
    MarkerSettings {
        shape: picture.markers.shape(),
        radius: picture
            .markers
            .marker_size
            .map_or(usual.radius, |size| 0.5 * size.0),
        least: 0.5 * LEAST * f64::from(sub_pixels),
        most_triangles: budget.map_or(usual.most_triangles, |budget| {
            (SHARE_OF_BUDGET * f64::from(budget)) as usize
        }),
    }
}
