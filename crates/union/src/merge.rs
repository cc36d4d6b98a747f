//! The recipe: find, cut, mend, check, and once more.

use std::collections::HashMap;

use neurotess_mesh::{
    Stage, Steps, SurfaceMesh, Topology, Watch, measure, search_self_intersections_watched,
};

use crate::handles::fill::fill;
use crate::handles::rejoin::rejoin;
use crate::mend::parts::{drop_hidden, still_cut_off};
use crate::mend::places::places;
use crate::mend::press::press_in;
use crate::mend::smooth::{renew_normals, smooth};
use crate::options::{UnionError, UnionOptions};
use crate::report::{Place, UnionReport};
use crate::rounds::{MAX_GROWTH, merge};
use crate::solver::improve::improve;
use crate::surface::work::Work;

/// A surface without crossings.
#[derive(Clone, Debug, PartialEq)]
pub struct Union {
    /// Triangles only. Vertices that no crossing touched are those of the input, in their order.
    pub mesh: SurfaceMesh,
    /// What is closed, and how many components and handles there are.
    pub topology: Topology,
    /// What was done.
    pub report: UnionReport,
}

/// The union of a closed surface with itself.
///
/// Quads are split along the diagonal from their first corner. The result is closed; crossings that are left
/// after the last round are counted in the report.
///
/// # Errors
/// If the surface is not closed and oriented, is not finite, or crosses itself more often than a search
/// counts; and if the arrangement fails.
pub fn union(mesh: &SurfaceMesh, options: &UnionOptions) -> Result<Union, UnionError> {
    union_watched(mesh, options, &Watch::default())
}

/// [`union`], which ends soon after it is stopped: while it searches, and between its other steps.
///
/// # Errors
/// As [`union`], and [`UnionError::Stopped`].
pub fn union_watched(
    mesh: &SurfaceMesh,
    options: &UnionOptions,
    watch: &Watch<'_>,
) -> Result<Union, UnionError> {
    watch.check()?;
    let mut steps = Steps::begin(watch, Stage::Merge, 5);
    let mut work = Work::new(mesh)?;
    watch.check()?;
    let mut report = before(&work)?;
    let mut pairs = crossings(&work, watch)?;
    steps.next();
    let crossed = corners_of(&work, &pairs);
    report.pairs_before = pairs.len();
    report.places = places(&work, &pairs);
    report.dropped = drop_hidden(&mut work, &pairs);
    if !report.dropped.is_empty() {
        pairs = crossings(&work, watch)?;
    }
    if options.press > 0.0 && !pairs.is_empty() {
        watch.check()?;
        let crossed = places(&work, &pairs);
        let pressed = press_in(&mut work, &pairs, options.press);
        report.pressed = pressed.moved;
        pairs = pressed.left;
        report.places = places(&work, &pairs);
        let is_left = |place: &Place| report.places.iter().any(|left| left.points == place.points);
        let pressed = crossed.into_iter().filter(|place| !is_left(place));
        report.pressed_places = pressed.collect();
    }

    let most = MAX_GROWTH * pairs.len() + work.triangles.len();
    pairs = merge(&mut work, pairs, most, true, options, &mut report, watch)?;
    steps.next();
    if options.rejoin && !report.cut_off.is_empty() && pairs.is_empty() {
        let (joined, hidden) = rejoin(&mut work, mesh, options, watch)?;
        report.joined = joined;
        report.dropped.extend(hidden);
        report.cut_off = still_cut_off(&work);
    }
    if options.fill > 0.0 && pairs.is_empty() {
        report.filled = fill(&mut work, options, report.handles_before, watch)?;
    }
    steps.next();
    if report.rounds > 0 && pairs.is_empty() {
        report.smoothed = smooth(&mut work, options.smoothing);
    }
    watch.check()?;
    let mut searched = false;
    if options.least_angle > 0.0 && pairs.is_empty() {
        let improved = improve(&mut work, options.least_angle);
        (report.improved, searched) = (improved.total(), improved.crosses_nothing);
    }
    renew_normals(&mut work);
    watch.check()?;
    steps.next();
    let of_changed = match searched {
        true => 0,
        false => work.crossings_of_changed().len(),
    };
    report.pairs = of_changed + crossings_that_stayed(&work, &crossed);
    report.faces_changed = changed(mesh, &work);
    let mesh = work.finish();
    let topology = mesh.topology();
    after(&mesh, &topology, &mut report);
    steps.next();
    Ok(Union {
        mesh,
        topology,
        report,
    })
}

/// Where a surface crosses itself, as [`union`] reports it, without merging anything.
///
/// # Errors
/// If it crosses itself in too many places, is no mesh, or it is stopped.
pub fn crossing_places(mesh: &SurfaceMesh, watch: &Watch<'_>) -> Result<Vec<Place>, UnionError> {
    let work = Work::new(mesh)?;
    Ok(places(&work, &crossings(&work, watch)?))
}

fn crossings(work: &Work, watch: &Watch<'_>) -> Result<Vec<[u32; 2]>, UnionError> {
    let search = search_self_intersections_watched(&work.positions(), &work.faces(), watch);
    if search.complete {
        Ok(search.pairs)
    } else {
        watch.check()?;
        Err(UnionError::TooMany(search.pairs.len()))
    }
}

/// Corners of the faces of pairs. Faces of the input keep them, whatever becomes of their numbers.
fn corners_of(work: &Work, pairs: &[[u32; 2]]) -> Vec<[[u32; 3]; 2]> {
    let corners = |face: u32| work.triangles[face as usize];
    pairs.iter().map(|pair| pair.map(corners)).collect()
}

/// How many of the pairs of the input that crossed are both still there. Together with those of changed faces
/// they are all that cross: two faces of the input that did not cross do not begin to.
fn crossings_that_stayed(work: &Work, crossed: &[[[u32; 3]; 2]]) -> usize {
    let mut stays: HashMap<[u32; 3], bool> = crossed
        .iter()
        .flatten()
        .map(|&face| (face, false))
        .collect();
    for (face, &changed) in work.triangles.iter().zip(&work.changed) {
        if !changed
            && !work.is_fresh(face)
            && let Some(stays) = stays.get_mut(face)
        {
            *stays = true;
        }
    }
    let both = |pair: &&[[u32; 3]; 2]| pair.iter().all(|face| stays[face]);
    crossed.iter().filter(both).count()
}

fn before(work: &Work) -> Result<UnionReport, UnionError> {
    let shape = work.shape();
    if !shape.closed || !shape.oriented {
        return Err(UnionError::NotClosed);
    }
    Ok(UnionReport {
        volume_before: measure(&work.positions(), &work.faces()).volume,
        components_before: shape.components,
        handles_before: shape.genus.unwrap_or_default(),
        ..UnionReport::default()
    })
}

fn after(mesh: &SurfaceMesh, topology: &Topology, report: &mut UnionReport) {
    report.volume = measure(&mesh.positions(), &mesh.faces).volume;
    report.components = topology.components;
    report.handles = topology.genus;
}

/// How many faces of the input are no longer there.
fn changed(mesh: &SurfaceMesh, work: &Work) -> usize {
    let before = mesh.faces.triangles.len() + 2 * mesh.faces.quads.len();
    let kept = work.triangles.len() - work.changed_faces().len();
    before.saturating_sub(kept)
}
