//! Synapses and points of a picture.

use neurotess::circuit::{Circuit, NodeRef, PointTable};
use neurotess::coloring::{self, ColorScheme, MarkerSet, SynapseOptions};
use neurotess::picture::{MarkerSettings, MarkerShape};

use super::args::RenderArgs;
use crate::options::markers::MarkerArgs;
use crate::report::{Reporter, count, usage};

/// Least diameter (pixels) of a marker.
const LEAST: f64 = 3.0;
/// Share of exploration's budget that markers may take beside it.
const SHARE_OF_BUDGET: f64 = 0.2;

/// Reads what the options ask for; `drawn`: the nodes of a circuit that are drawn.
///
/// # Errors
/// Wrong usage; files that are invalid, or do not have what is asked for.
pub(crate) fn read(
    asked: &MarkerArgs,
    drawn: Option<(&Circuit, &[NodeRef])>,
    scheme: &ColorScheme,
    reporter: &Reporter,
) -> anyhow::Result<Option<MarkerSet>> {
    asked.check()?;
    if !asked.any() {
        return Ok(None);
    }
    // The message only: with its source, it would be printed twice.
    let whole = |e: &dyn std::fmt::Display| anyhow::anyhow!("{e}");
    let property = asked.marker_color_by.as_deref();
    if let Some(file) = &asked.points {
        let table = PointTable::read(file).map_err(|e| whole(&e))?;
        let name = file.display().to_string();
        let set = coloring::points(&name, &table, property, scheme).map_err(|e| whole(&e))?;
        reporter.note(&count(set.markers.len(), "point"));
        return Ok(Some(set));
    }
    let Some((circuit, nodes)) = drawn else {
        return usage("--synapses needs a circuit, whose edges say where they are");
    };
    let options = SynapseOptions {
        populations: asked.populations(),
        side: asked.synapse_side.into(),
        property: property.map(str::to_owned),
        contacts: asked.shape() == MarkerShape::Contact,
    };
    let set = coloring::synapses(circuit, nodes, &options, scheme);
    let set = set.map_err(|e| whole(&e))?;
    let shown = set.markers.len();
    reporter.note(&format!(
        "{} of the cells that are drawn, {} of others",
        count(shown, "synapse"),
        set.left_out
    ));
    if set.placeless > 0 {
        reporter.warning(&format!(
            "{} left out: they name sections that the tracings of their cells do not have",
            count(set.placeless, "synapse")
        ));
    }
    if shown == 0 {
        reporter.warning("no synapse belongs to a cell that is drawn");
    }
    Ok(Some(set))
}

/// How they are drawn. `sub_pixels`: along a pixel's side; `budget`: of exploration (triangles).
pub(super) fn settings(args: &RenderArgs, sub_pixels: u32, budget: Option<u32>) -> MarkerSettings {
    let usual = MarkerSettings::default();
    MarkerSettings {
        shape: args.markers.shape(),
        radius: 0.5 * args.markers.marker_size.unwrap_or(2.0 * usual.radius),
        least: 0.5 * LEAST * f64::from(sub_pixels),
        most_triangles: budget.map_or(usual.most_triangles, |budget| {
            (SHARE_OF_BUDGET * f64::from(budget)) as usize
        }),
    }
}
