//! What is said of a merged surface, and what a mesh for simulators must be.

use neurotess::generate::Generated;
use neurotess::mesh::{Quality, Walled};
use neurotess::union::{Kin, Part, UnionReport};

use super::pieces;
use super::surface::{CellSurface, Merged};
use super::warning::CellWarning;
use crate::report::Failure;

/// Solvers lose accuracy, and mesh generators time, where one in a hundred triangles has a smaller angle
/// (degrees).
const THIN_TRIANGLES: f64 = 10.0;

/// Fails unless solvers can take the mesh. `Merged::new` has seen to crossings.
pub(super) fn check(surface: &CellSurface<'_>, generated: &Generated) -> Result<(), Failure> {
    let topology = &surface.topology;
    if !topology.closed || !topology.oriented || !topology.vertex_manifold {
        return Err(Failure(
            "the merged surface is not a closed manifold: use --crossings merge and look at it with \
             neurotess check"
                .to_owned(),
        ));
    }
    if let Some(part) = surface
        .merged()
        .and_then(|merged| merged.report.cut_off.first())
    {
        return Err(Failure(format!(
            "a piece of the tracing near sample {} was cut off: mend the tracing there, or use \
             --crossings merge",
            part.point
        )));
    }
    let components = generated.mesh.topology().components;
    if topology.components > components {
        return Err(Failure(format!(
            "the surface fell into {} pieces, of {components} in the tracing: use --crossings merge and \
             look at it with neurotess check",
            topology.components
        )));
    }
    Ok(())
}

/// What merging changed, and what is said of the triangles of a mesh for simulators.
pub(super) fn warnings(merged: &Merged) -> Vec<CellWarning> {
    let mut warnings = of_crossings(&merged.report);
    warnings.extend(merged.quality.as_ref().and_then(of_triangles));
    // Of a mesh for simulators alone: others may show several cells.
    let simulated = merged.quality.is_some();
    warnings.extend(simulated.then(|| pieces::warning(&merged.mesh)).flatten());
    warnings
}

fn of_crossings(report: &UnionReport) -> Vec<CellWarning> {
    let warning = |code, sample: i32, count: usize, message: String| CellWarning {
        line: None,
        sample: Some(i64::from(sample)),
        code,
        message,
        count: count as u64,
    };
    let mut warnings = Vec::new();
    let apart = report.places.iter().filter(|place| place.kin == Kin::Apart);
    let deepest = apart.clone().max_by(|a, b| a.depth.total_cmp(&b.depth));
    if let Some(deepest) = deepest {
        let [a, b] = deepest.points;
        let places = apart.count();
        warnings.push(warning(
            "branches_merged",
            a,
            places,
            format!(
                "branches that cross grew together in {places} places, deepest at samples {a} and {b} \
                 ({:.2} µm): a short circuit for voltage and diffusion",
                deepest.depth
            ),
        ));
    }
    if let Some(first) = report.pressed_places.first() {
        let ([a, b], places) = (first.points, report.pressed_places.len());
        warnings.push(warning(
            "branches_pressed",
            a,
            places,
            format!(
                "branches that cross were pressed in, thinner there than traced, in {places} places, first at \
                 samples {a} and {b}"
            ),
        ));
    }
    if let Some(first) = report.filled.first() {
        let volume: f64 = report.filled.iter().map(|hole| hole.volume).sum();
        let (places, at) = (report.filled.len(), first.point);
        warnings.push(warning(
            "holes_filled",
            at,
            places,
            format!(
                "holes that merging left, smaller than a branch, were filled in {places} places, first at \
                 sample {at} ({volume:+.2e} µm³ in all)"
            ),
        ));
    }
    if let Some(first) = report.joined.first() {
        let volume: f64 = report.joined.iter().map(|piece| piece.volume).sum();
        let (places, at) = (report.joined.len(), first.point);
        warnings.push(warning(
            "joined",
            at,
            places,
            format!(
                "the tube is inside out in {places} places, first at sample {at}, where a neurite turns back within \
                 its own radius: filled there, so that nothing is cut off ({volume:+.2e} µm³ in all)"
            ),
        ));
    }
    let handles = report.handles_made().unwrap_or(0);
    if handles > 0 {
        let first = report.places.first().map_or(-1, |place| place.points[0]);
        let count = usize::try_from(handles).unwrap_or(0);
        let message = format!("merging closed {handles} loops (handles)");
        warnings.push(warning("handles", first, count, message));
    }
    for (code, parts, what) in [
        (
            "parts_dropped",
            &report.dropped,
            "inside others, or splinters: left out",
        ),
        (
            "parts_cut_off",
            &report.cut_off,
            "no longer hang together with the rest",
        ),
    ] {
        if let Some(Part { point, .. }) = parts.first() {
            let message = format!("{} pieces of the surface {what}", parts.len());
            warnings.push(warning(code, *point, parts.len(), message));
        }
    }
    warnings
}

fn of_triangles(quality: &Quality) -> Option<CellWarning> {
    (quality.min_angle_p1 < THIN_TRIANGLES).then(|| CellWarning {
        line: None,
        sample: None,
        code: "thin_triangles",
        message: format!(
            "one in a hundred triangles has an angle below {:.1}°: try another --isotropic, or a smaller \
             --max-aspect",
            quality.min_angle_p1
        ),
        count: 1,
    })
}

/// What is said of tubes that became thinner, told by their samples.
pub(super) fn of_thinning(samples: &[i64]) -> Option<CellWarning> {
    let &sample = samples.first()?;
    Some(CellWarning {
        line: None,
        sample: Some(sample),
        code: "thinned",
        message: format!(
            "neurites would have grown together into loops: thinner there than traced, at \
             {} samples, first at sample {sample}",
            samples.len()
        ),
        count: samples.len() as u64,
    })
}

/// What is said of walls that are not there.
pub(super) fn of_walls(walled: &Walled) -> Option<CellWarning> {
    let warning = |sample: Option<i32>, count: usize, message: &str| CellWarning {
        line: None,
        sample: sample.map(i64::from),
        code: "no_wall",
        message: message.to_owned(),
        count: count as u64,
    };
    let first = walled.left_out.first();
    match first {
        Some(_) => Some(warning(
            first.copied(),
            walled.left_out.len(),
            "the border between soma and neurite is no simple ring, or a wall would cross the membrane: no wall there",
        )),
        None if walled.regions.is_empty() => Some(warning(
            None,
            1,
            "no neurite leaves a soma: there are no walls",
        )),
        None => None,
    }
}
