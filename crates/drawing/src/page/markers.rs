//! Synapses and points of a page.

use neurotess_circuit::{Circuit, NodeRef};
use neurotess_color::{ColorScheme, MarkerSet};
use neurotess_picture::color::{CATEGORY_BIT, Rgb};
use neurotess_picture::{Marker, MarkerSettings};
use neurotess_web::PageMarkers;

use neurotess_options::groups::MarkerOptions;

use crate::error::DrawError;
use crate::host::Host;
use crate::scene::markers::read_markers;

/// Reads what the options ask for; `of`: the nodes of a circuit that are shown.
///
/// # Errors
/// Wrong usage; files that are invalid, or do not have what is asked for.
pub(super) fn read(
    asked: &MarkerOptions,
    of: Option<(&Circuit, &[NodeRef])>,
    scheme: &ColorScheme,
    host: &dyn Host,
) -> Result<PageMarkers, DrawError> {
    let Some(set) = read_markers(asked, of, scheme, host)? else {
        return Ok(PageMarkers::default());
    };
    let marker = |marker: &Marker| {
        let color = (marker.color_key & !CATEGORY_BIT) as usize;
        (marker.position.to_array(), color)
    };
    let size = asked.marker_size;
    Ok(PageMarkers {
        markers: set.markers.iter().map(marker).collect(),
        radius: size.map_or(MarkerSettings::default().radius, |size| 0.5 * size.0),
        legend: legend(&set),
        colors: set.colors,
    })
}

/// What the legend lists of markers: their categories, or the ends of their scale.
fn legend(set: &MarkerSet) -> Vec<(Rgb, String)> {
    let ends = [set.colors.first(), set.colors.last()];
    match (set.legend.range(), ends) {
        (Some((range, _)), [Some(&low), Some(&high)]) => [(low, range[0]), (high, range[1])]
            .map(|(color, end)| (color, format!("{} {end}", set.legend.title())))
            .into(),
        _ => set.legend.entries().to_vec(),
    }
}
