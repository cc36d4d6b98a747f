//! Area of each section's surface beside that of its traced frusta.

use neurotess::mesh::{SurfaceMesh, WriteError, section_areas};
use neurotess::morphology::{Morphology, shape};

/// By how much the area of sections is off, as a share of their frusta: the median, and the 95th percentile. What a
/// neurite has before its first traced point is no part of its section.
///
/// # Errors
/// The surface is not finite.
pub(crate) fn area_off(
    surface: &SurfaceMesh,
    morphology: &Morphology,
) -> Result<[f64; 2], WriteError> {
    let meshed = section_areas(surface)?;
    let traced = shape::section_areas(morphology);
    let sections = (1..).zip(traced).filter(|(_, traced)| *traced > 0.0);
    let mut off: Vec<f64> = sections
        .map(|(number, traced)| {
            let meshed = meshed.get(&number).copied().unwrap_or(0.0);
            (meshed / traced - 1.0).abs()
        })
        .collect();
    off.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let place = share * off.len().saturating_sub(1) as f64;
        off.get(place.round() as usize).copied().unwrap_or(0.0)
    };
    Ok([quantile(0.5), quantile(0.95)])
}
