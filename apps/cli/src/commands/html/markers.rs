//! Synapses and points of a page.

use neurotess::circuit::{Circuit, NodeRef};
use neurotess::coloring::{ColorScheme, MarkerSet};
use neurotess::render::color::{CATEGORY_BIT, Rgb};
use neurotess::render::{Marker, MarkerSettings};
use neurotess::web::PageMarkers;

use crate::commands::render::markers;
use crate::options::markers::MarkerArgs;
use crate::report::Reporter;

/// Reads what the options ask for; `of`: the nodes of a circuit that are shown.
///
/// # Errors
/// Wrong usage; files that are invalid, or do not have what is asked for.
pub(super) fn read(
    asked: &MarkerArgs,
    of: Option<(&Circuit, &[NodeRef])>,
    scheme: &ColorScheme,
    reporter: &Reporter,
) -> anyhow::Result<PageMarkers> {
    let Some(set) = markers::read(asked, of, scheme, reporter)? else {
        return Ok(PageMarkers::default());
    };
    let marker = |marker: &Marker| {
        let color = (marker.color_key & !CATEGORY_BIT) as usize;
        (marker.position.to_array(), color)
    };
    let size = asked.marker_size;
    Ok(PageMarkers {
        markers: set.markers.iter().map(marker).collect(),
        radius: size.map_or(MarkerSettings::default().radius, |size| 0.5 * size),
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
