//! Cut, mend, check, and once more, until nothing crosses.

use neurotess_mesh::{measure, self_intersections_of};

use crate::options::{UnionError, UnionOptions};
use crate::parts::{drop_splinters, least_volume};
use crate::region::around;
use crate::report::UnionReport;
use crate::splice::{Fault, splice};
use crate::tidy::tidy;
use crate::touch;
use crate::work::Work;

/// Rounds after which crossings are no longer cut only, but pressed apart too. Real cells need two at most.
const EXACT_ROUNDS: u32 = 2;

/// Merging is given up where a round leaves this many times the crossing pairs that there were, and one more for each
/// face: where rounds make crossings they multiply, and so does memory. A few pairs may become ten times as many and still
/// come to nothing: `simple.asc` with its points moved by 0.6 radii has 68 after a round.
pub(crate) const MAX_GROWTH: usize = 4;

/// Most rings of neighbors that an arrangement is tried with.
const MAX_RINGS: u32 = 4;

/// Merges surfaces at the faces of `pairs`, which cross; returns what still crosses. It is given up once a round leaves
/// more than `most` pairs: what multiplies takes ever more time and memory, and comes to nothing. `check` is asked between
/// steps whether to stop.
pub(crate) fn merge(
    work: &mut Work,
    mut pairs: Vec<[u32; 2]>,
    most: usize,
    options: &UnionOptions,
    report: &mut UnionReport,
    check: &dyn Fn() -> Result<(), UnionError>,
) -> Result<Vec<[u32; 2]>, UnionError> {
    let mut needles = options.needles;
    while !pairs.is_empty() && pairs.len() <= most && report.rounds < options.rounds {
        report.rounds += 1;
        check()?;
        if report.rounds > EXACT_ROUNDS {
            let times = f64::from(report.rounds - EXACT_ROUNDS);
            report.parted += touch::press_all(work, &pairs, times);
            pairs = crossings_of_changed(work);
            if pairs.is_empty() {
                break;
            }
        }
        let faces = touch::faces(work, &pairs);
        cut(work, &pairs)?;
        check()?;
        let last = report.rounds == options.rounds;
        mend(work, if last { 0.0 } else { needles }, report);
        // What is finer stays: collapsing may be what made the new crossings.
        needles *= 0.6;
        pairs = crossings_of_changed(work);
        let pressed = touch::press(work, &pairs, &faces);
        if pressed > 0 {
            report.parted += pressed;
            pairs = crossings_of_changed(work);
        }
    }
    Ok(pairs)
}

/// Crossings of faces that are not of the input: the others' were all cut.
pub(crate) fn crossings_of_changed(work: &Work) -> Vec<[u32; 2]> {
    match work.changed_faces() {
        none if none.is_empty() => Vec::new(),
        changed => self_intersections_of(&work.positions(), &work.faces(), &changed),
    }
}

/// Replaces the faces around crossings by their union.
fn cut(work: &mut Work, pairs: &[[u32; 2]]) -> Result<(), UnionError> {
    let mut fault = None;
    for rings in 1..=MAX_RINGS {
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
