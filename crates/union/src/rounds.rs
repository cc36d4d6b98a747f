//! Cut, mend, check, and once more, until nothing crosses.

use neurotess_mesh::{Watch, measure};

use crate::arrange::region::{Region, around, everything};
use crate::arrange::splice::{Fault, splice};
use crate::mend::parts::{drop_splinters, least_volume};
use crate::mend::tidy::tidy;
use crate::mend::touch;
use crate::options::{UnionError, UnionOptions};
use crate::report::UnionReport;
use crate::surface::work::Work;

/// Rounds after which crossings are no longer cut only, but pressed apart too. Real cells need two at most.
const EXACT_ROUNDS: u32 = 2;

/// Merging is given up where a round leaves this many times the crossing pairs that there were, and one more for each
/// face: where rounds make crossings they multiply, and so does memory. A few pairs may become ten times as many and still
/// come to nothing: `simple.asc` with its points moved by 0.6 radii has 68 after a round. A guard.
pub(crate) const MAX_GROWTH: usize = 4;

/// Most rings of neighbors that an arrangement is tried with, before it is tried with the whole surface. A guard.
const MAX_RINGS: u32 = 4;

/// How often what crosses is pressed in, by a thousandth of its radius more each time, where even the whole surface could
/// not be arranged. Tuned by nothing: no surface is known to need it. A guard.
const MAX_PRESSES: u32 = 4;

/// Merges surfaces at the faces of `pairs`, which cross; returns what still crosses. It is given up once a round leaves
/// more than `most` pairs: what multiplies takes ever more time and memory, and comes to nothing. `insists`: whether all is
/// tried where a cut fails, which may take long. `check` is asked between steps whether to stop.
pub(crate) fn merge(
    work: &mut Work,
    mut pairs: Vec<[u32; 2]>,
    most: usize,
    insists: bool,
    options: &UnionOptions,
    report: &mut UnionReport,
    watch: &Watch<'_>,
) -> Result<Vec<[u32; 2]>, UnionError> {
    let mut needles = options.needles;
    while !pairs.is_empty() && pairs.len() <= most && report.rounds < options.rounds {
        report.rounds += 1;
        watch.check()?;
        if report.rounds > EXACT_ROUNDS {
            let times = f64::from(report.rounds - EXACT_ROUNDS);
            report.parted += touch::press_all(work, &pairs, times);
            pairs = work.crossings_of_changed();
            if pairs.is_empty() {
                break;
            }
        }
        let faces = touch::faces(work, &pairs);
        cut(work, pairs, insists, report, watch, &splice)?;
        watch.check()?;
        let last = report.rounds == options.rounds;
        mend(work, if last { 0.0 } else { needles }, report);
        // What is finer stays: collapsing may be what made the new crossings.
        needles *= 0.5;
        pairs = work.crossings_of_changed();
        let pressed = touch::press(work, &pairs, &faces);
        if pressed > 0 {
            report.parted += pressed;
            pairs = work.crossings_of_changed();
        }
    }
    Ok(pairs)
}

/// Replaces the faces around crossings by their union. Where that fails and it `insists`, the whole surface is arranged, or
/// what crosses pressed in a little, and cut where it then crosses. `splice`: [`splice()`], but in tests.
fn cut(
    work: &mut Work,
    mut pairs: Vec<[u32; 2]>,
    insists: bool,
    report: &mut UnionReport,
    watch: &Watch<'_>,
    splice: &dyn Fn(&mut Work, &Region) -> Result<(), Fault>,
) -> Result<(), UnionError> {
    let mut times = 0;
    loop {
        let Err(fault) = cut_at(work, &pairs, insists, splice) else {
            return Ok(());
        };
        if !insists || times == MAX_PRESSES {
            return Err(UnionError::Failed(match fault {
                Fault::Engine(text) => text,
                Fault::Open => "what is kept does not close".into(),
                Fault::Inconsistent => "winding numbers contradict one another".into(),
            }));
        }
        watch.check()?;
        times += 1;
        report.parted += touch::press_all(work, &pairs, f64::from(times));
        // All faces that crossed have moved.
        pairs = work.crossings_of_changed();
    }
}

/// Replaces the faces around crossings, or if it `insists` all faces, by their union.
fn cut_at(
    work: &mut Work,
    pairs: &[[u32; 2]],
    insists: bool,
    splice: &dyn Fn(&mut Work, &Region) -> Result<(), Fault>,
) -> Result<(), Fault> {
    if pairs.is_empty() {
        return Ok(());
    }
    let mut done = Ok(());
    for rings in 1..=MAX_RINGS {
        done = splice(work, &around(work, pairs, rings));
        if done.is_ok() {
            return done;
        }
    }
    match insists {
        true => splice(work, &everything(work, pairs)),
        false => done,
    }
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

#[cfg(test)]
mod tests {
    use neurotess_mesh::{SurfaceMesh, SurfaceVertex, self_intersections};

    use super::*;

    /// Two tetrahedra of a radius of 1 µm, one through the other.
    fn crossing() -> Work {
        let mut mesh = SurfaceMesh::default();
        for shift in [0.0_f32, 0.3] {
            let first = mesh.vertices.len() as u32;
            for [x, y, z] in [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]] {
                mesh.vertices.push(SurfaceVertex {
                    position: [x + shift, y + 0.9 * shift, z + 0.8 * shift].into(),
                    radius: 1.0,
                    ..SurfaceVertex::default()
                });
            }
            let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
            let faces = faces.map(|face| face.map(|corner| first + corner));
            mesh.faces.triangles.extend(faces);
        }
        Work::new(&mesh).expect("a mesh")
    }

    /// Cuts where the first `failures` tries fail.
    fn cut_after(failures: u32, insists: bool) -> (Work, UnionReport, Result<(), UnionError>) {
        let mut work = crossing();
        let pairs = self_intersections(&work.positions(), &work.faces());
        let left = std::cell::Cell::new(failures);
        let fails = |work: &mut Work, region: &Region| match left.get() {
            0 => splice(work, region),
            more => {
                left.set(more - 1);
                Err(Fault::Open)
            }
        };
        let mut report = UnionReport::default();
        let done = cut(
            &mut work,
            pairs,
            insists,
            &mut report,
            &Watch::default(),
            &fails,
        );
        (work, report, done)
    }

    #[test]
    fn where_a_cut_fails_a_wider_one_or_a_thousandth_of_the_radius_helps() {
        let (exact, report, done) = cut_after(0, true);
        assert_eq!((report.parted, done), (0, Ok(())));
        let volume = |work: &Work| measure(&work.positions(), &work.faces()).volume;
        for failures in [MAX_RINGS, MAX_RINGS + 1, 3 * (MAX_RINGS + 1)] {
            let (work, report, done) = cut_after(failures, true);
            assert_eq!(done, Ok(()), "{failures}");
            let presses = failures / (MAX_RINGS + 1);
            assert_eq!(report.parted > 0, presses > 0, "{failures}");
            let shape = work.shape();
            assert!(shape.closed && shape.oriented && shape.vertex_manifold);
            assert_eq!(shape.components, 1);
            assert!(self_intersections(&work.positions(), &work.faces()).is_empty());
            // Six micrometers squared at most, moved by thousandths of one.
            let moved = volume(&exact) - volume(&work);
            let most = 6e-3 * f64::from(presses * (presses + 1) / 2);
            assert!((0.0..=most).contains(&moved), "{failures}: {moved}");
        }
    }

    #[test]
    fn what_can_be_cut_in_no_way_is_an_error() {
        let told = UnionError::Failed("what is kept does not close".into());
        for (failures, insists) in [(u32::MAX, true), (MAX_RINGS, false)] {
            let (_, report, done) = cut_after(failures, insists);
            assert_eq!(done, Err(told.clone()));
            assert_eq!(report.parted > 0, insists);
        }
    }
}
