//! The recipe: find, cut, mend, check, and once more.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};

use neurotess_mesh::{
    SurfaceMesh, Topology, measure, search_self_intersections_stoppable, self_intersections_of,
    topology,
};

use crate::improve::improve;
use crate::options::{UnionError, UnionOptions};
use crate::parts::{drop_hidden, drop_splinters, least_volume};
use crate::places::places;
use crate::press::press_in;
use crate::region::around;
use crate::report::{Place, UnionReport};
use crate::smooth::{renew_normals, smooth};
use crate::splice::{Fault, splice};
use crate::tidy::tidy;
use crate::touch;
use crate::work::Work;

/// A surface without crossings.
#[derive(Clone, Debug, PartialEq)]
pub struct Union {
    /// Triangles only. Vertices that no crossing touched are those of the input, in their order.
    pub mesh: SurfaceMesh,
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
    union_stoppable(mesh, options, &AtomicBool::new(false))
}

/// [`union`], which ends soon after another thread sets `stopped`: while it searches, and between its other steps.
///
/// # Errors
/// As [`union`], and [`UnionError::Stopped`].
pub fn union_stoppable(
    mesh: &SurfaceMesh,
    options: &UnionOptions,
    stopped: &AtomicBool,
) -> Result<Union, UnionError> {
    let check = || match stopped.load(Ordering::Relaxed) {
        true => Err(UnionError::Stopped),
        false => Ok(()),
    };
    check()?;
    let mut work = Work::new(mesh)?;
    check()?;
    let mut report = before(&work)?;
    let mut pairs = crossings(&work, stopped)?;
    let crossed = corners_of(&work, &pairs);
    report.pairs_before = pairs.len();
    report.places = places(&work, &pairs);
    report.dropped = drop_hidden(&mut work, &pairs);
    if !report.dropped.is_empty() {
        pairs = crossings(&work, stopped)?;
    }
    if options.press > 0.0 && !pairs.is_empty() {
        check()?;
        let crossed = places(&work, &pairs);
        report.pressed = press_in(&mut work, &pairs, options.press);
        pairs.retain(|pair| !pair.iter().any(|&face| work.is_changed(face)));
        pairs.extend(crossings_of_changed(&work));
        report.places = places(&work, &pairs);
        let is_left = |place: &Place| report.places.iter().any(|left| left.points == place.points);
        let pressed = crossed.into_iter().filter(|place| !is_left(place));
        report.pressed_places = pressed.collect();
    }

    let mut needles = options.needles;
    while !pairs.is_empty() && report.rounds < options.rounds {
        report.rounds += 1;
        check()?;
        if report.rounds > EXACT_ROUNDS {
            let times = f64::from(report.rounds - EXACT_ROUNDS);
            report.parted += touch::press_all(&mut work, &pairs, times);
            pairs = crossings_of_changed(&work);
            if pairs.is_empty() {
                break;
            }
        }
        let faces = touch::faces(&work, &pairs);
        cut(&mut work, &pairs)?;
        check()?;
        let last = report.rounds == options.rounds;
        mend(&mut work, if last { 0.0 } else { needles }, &mut report);
        // What is finer stays: collapsing may be what made the new crossings.
        needles *= 0.6;
        pairs = crossings_of_changed(&work);
        let pressed = touch::press(&mut work, &pairs, &faces);
        if pressed > 0 {
            report.parted += pressed;
            pairs = crossings_of_changed(&work);
        }
    }
    if report.rounds > 0 && pairs.is_empty() {
        report.smoothed = smooth(&mut work, options.smoothing);
    }
    check()?;
    if options.least_angle > 0.0 && pairs.is_empty() {
        report.improved = improve(&mut work, options.least_angle).total();
    }
    renew_normals(&mut work);
    check()?;
    report.pairs = crossings_of_changed(&work).len() + crossings_that_stayed(&work, &crossed);
    after(&work, &mut report);
    report.faces_changed = changed(mesh, &work);
    Ok(Union {
        mesh: work.finish(),
        report,
    })
}

/// Where a surface crosses itself, as [`union`] reports it, without merging anything.
///
/// # Errors
/// If it crosses itself in too many places, is no mesh, or another thread has set `stopped`.
pub fn crossing_places(mesh: &SurfaceMesh, stopped: &AtomicBool) -> Result<Vec<Place>, UnionError> {
    let work = Work::new(mesh)?;
    Ok(places(&work, &crossings(&work, stopped)?))
}

fn crossings(work: &Work, stopped: &AtomicBool) -> Result<Vec<[u32; 2]>, UnionError> {
    let search = search_self_intersections_stoppable(&work.positions(), &work.faces(), stopped);
    if search.complete {
        Ok(search.pairs)
    } else if stopped.load(Ordering::Relaxed) {
        Err(UnionError::Stopped)
    } else {
        Err(UnionError::TooMany(search.pairs.len()))
    }
}

/// Crossings of faces that are not of the input: the others' were all cut.
fn crossings_of_changed(work: &Work) -> Vec<[u32; 2]> {
    match work.changed_faces() {
        none if none.is_empty() => Vec::new(),
        changed => self_intersections_of(&work.positions(), &work.faces(), &changed),
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

/// Rounds after which crossings are no longer cut only, but pressed apart too. Real cells need two at most.
const EXACT_ROUNDS: u32 = 2;

/// Most rings of neighbors that an arrangement is tried with.
const MOST_RINGS: u32 = 4;

/// Replaces the faces around crossings by their union.
fn cut(work: &mut Work, pairs: &[[u32; 2]]) -> Result<(), UnionError> {
    let mut fault = None;
    for rings in 1..=MOST_RINGS {
        match splice(work, &around(work, pairs, rings)) {
            Ok(()) => return Ok(()),
            Err(new) => fault = Some(new),
        }
    }
    Err(UnionError::Failed(match fault {
        Some(Fault::Engine(text)) => text,
        Some(Fault::Open) => "what is kept does not close".into(),
        Some(Fault::Inconsistent) | None => "winding numbers contradict one another".into(),
    }))
}

/// Makes a fair surface of what the cut has left.
fn mend(work: &mut Work, needles: f64, report: &mut UnionReport) {
    let volume = measure(&work.positions(), &work.faces()).volume;
    let splinters = drop_splinters(work, least_volume(work, volume));
    report.dropped.extend(splinters.dropped);
    report.cut_off = splinters.cut_off;
    report.parted += touch::part(work);
    if needles > 0.0 {
        let tidied = tidy(work, needles);
        report.collapsed += tidied.collapsed;
        report.flipped += tidied.flipped;
    }
}

fn shape(work: &Work) -> Topology {
    topology(&work.positions(), &work.faces())
}

fn before(work: &Work) -> Result<UnionReport, UnionError> {
    let shape = shape(work);
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

fn after(work: &Work, report: &mut UnionReport) {
    let shape = shape(work);
    report.volume = measure(&work.positions(), &work.faces()).volume;
    report.components = shape.components;
    report.handles = shape.genus;
}

/// How many faces of the input are no longer there.
fn changed(mesh: &SurfaceMesh, work: &Work) -> usize {
    let before = mesh.faces.triangles.len() + 2 * mesh.faces.quads.len();
    let kept = work.triangles.len() - work.changed_faces().len();
    before.saturating_sub(kept)
}
