//! The surface of a cell as it is written: refined block by block, or whole in memory where what crosses is
//! merged.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use neurotess::generate::Separation;
use neurotess::mesh::{
    CoarseMesh, Extent, Quality, Soundness, Surface, SurfaceMesh, Topology, measure_surface,
    quality,
};
use neurotess::refine::{CoarseSurface, EdgeRule, Lod, Refinement};
use neurotess::union::{
    Filled, Joined, Kin, Place, UnionError, UnionOptions, UnionReport, union_stoppable,
};
use serde::Serialize;

use super::options::{MeshLevels, MeshOptions};
use crate::report::Failure;

/// How far surfaces of a mesh for simulators that cross are pressed in, of the radius: what is left of them after
/// branches were moved apart is less deep.
const PRESS: f64 = 0.6;

/// Circumferences of a branch up to which holes that merging made are filled in a mesh for simulators. Those of real
/// cells' bends and forks measure 1.5 at most; a loop between two branches of the astrocyte, 4.3.
const FILL: f64 = 2.0;

/// Angles (degrees) of a mesh for simulators that are made larger where the surface allows it. Tetrahedra on
/// narrower triangles are poor ones.
const LEAST_ANGLE: f64 = 20.0;

/// The same as a share of the angle of half a rectangle whose sides have the ratio that was asked for: where that
/// is narrow, wider triangles would only be had by giving up sides of the tubes. With 0.9 the area of straight
/// neurites grows by 1 %.
const LEAST_SHARE: f64 = 0.85;

/// A surface to be written, and what is known of it.
pub(super) struct CellSurface<'m> {
    made: MadeSurface<'m>,
    pub(super) topology: Topology,
    /// Seconds that it took to plan; none where it was merged before.
    pub(super) seconds: f64,
}

enum MadeSurface<'m> {
    /// Block by block.
    Refined(Box<dyn Surface + 'm>),
    /// Whole in memory.
    Merged(&'m Merged),
}

impl<'m> CellSurface<'m> {
    /// The surface of a coarse mesh as it is refined, or merged with itself.
    pub(super) fn new(
        mesh: &'m CoarseMesh,
        merged: Option<&'m Merged>,
        options: &MeshOptions,
    ) -> Self {
        if let Some(merged) = merged {
            return Self {
                made: MadeSurface::Merged(merged),
                topology: merged.topology,
                seconds: 0.0,
            };
        }
        let clock = Instant::now();
        // Refinement does not change the topology.
        let (refined, topology) = rayon::join(|| refined(mesh, options), || mesh.topology());
        Self {
            made: MadeSurface::Refined(refined),
            topology,
            seconds: clock.elapsed().as_secs_f64(),
        }
    }

    /// What is written.
    pub(super) fn surface(&self) -> &(dyn Surface + 'm) {
        match &self.made {
            MadeSurface::Refined(refined) => &**refined,
            MadeSurface::Merged(merged) => &merged.mesh,
        }
    }

    /// How it was merged, if it was.
    pub(super) fn merged(&self) -> Option<&'m Merged> {
        match self.made {
            MadeSurface::Refined(_) => None,
            MadeSurface::Merged(merged) => Some(merged),
        }
    }

    /// Volume (µm³) and area (µm²).
    pub(super) fn volume_and_area(&self) -> (f64, f64) {
        let measure = measure_surface(self.surface());
        (measure.volume, measure.area)
    }
}

/// A refined surface merged with itself where it crossed.
pub(super) struct Merged {
    pub(super) mesh: SurfaceMesh,
    pub(super) report: UnionReport,
    pub(super) topology: Topology,
    /// Shapes of the triangles, of a mesh for simulators.
    pub(super) quality: Option<Quality>,
    /// Seconds that it took.
    pub(super) seconds: f64,
}

impl Merged {
    /// Refines a coarse mesh and merges what crosses. Ends soon after another thread sets `stopped`.
    pub(super) fn new(
        mesh: &CoarseMesh,
        options: &MeshOptions,
        stopped: &AtomicBool,
    ) -> Result<Self, Failure> {
        let clock = Instant::now();
        let union_options = match options.simulation {
            true => UnionOptions {
                press: PRESS,
                fill: FILL,
                least_angle: least_angle(options.levels),
                ..UnionOptions::default()
            },
            false => UnionOptions::default(),
        };
        let merged = SurfaceMesh::collect_stoppable(&*refined(mesh, options), stopped)
            .ok_or(UnionError::Stopped)
            .and_then(|whole| union_stoppable(&whole, &union_options, stopped));
        let merged = merged.map_err(|e| Failure(format!("what crosses cannot be merged: {e}")))?;
        if merged.report.pairs > 0 {
            let at = merged.report.places.first().map(|p| p.points);
            return Err(Failure(format!(
                "{} pairs of triangles still cross after merging, first near sample {}: try another \
                 --level",
                merged.report.pairs,
                at.map_or(-1, |points| points[0])
            )));
        }
        let soundness = Soundness {
            volume: measure_surface(&merged.mesh).volume,
            reach: mesh.reach(),
        };
        let vertices = merged.mesh.vertices.iter();
        let extent = vertices.fold(Extent::NONE, |extent, v| extent.with(v.position));
        soundness
            .check(extent)
            .map_err(|e| Failure(e.to_string()))?;
        Ok(Self {
            topology: merged.topology,
            quality: options.simulation.then(|| quality(&merged.mesh)),
            mesh: merged.mesh,
            report: merged.report,
            seconds: clock.elapsed().as_secs_f64(),
        })
    }
}

/// Which angles (degrees) of a mesh for simulators are made larger.
fn least_angle(levels: MeshLevels) -> f64 {
    match levels {
        MeshLevels::Edges(EdgeRule::Lengths { aspect, .. }) => {
            let half_rectangle = (1.0 / f64::from(aspect)).atan().to_degrees();
            LEAST_ANGLE.min(LEAST_SHARE * half_rectangle)
        }
        _ => LEAST_ANGLE,
    }
}

/// The surface of a coarse mesh, made block by block.
fn refined<'m>(mesh: &'m CoarseMesh, options: &MeshOptions) -> Box<dyn Surface + Send + 'm> {
    let refined = |lod: Lod<'_>| Box::new(Refinement::new(mesh, lod, &options.refine));
    match options.levels {
        MeshLevels::Coarse => Box::new(CoarseSurface::new(mesh, options.format.has_quads())),
        MeshLevels::Criterion(criterion) => refined(criterion.into()),
        MeshLevels::Edges(rule) => refined(Lod::by_edge(rule)),
    }
}

/// What became of places where the surface crosses itself, as JSON.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CrossingsReport {
    /// Pairs of triangles that crossed before merging.
    pairs_before: usize,
    /// Pairs that still cross.
    pairs: usize,
    /// Volume after merging by volume before, which counts what is enclosed twice twice.
    volume_ratio: f64,
    components_before: usize,
    /// Handles that merging made: each is a short circuit.
    handles_made: Option<i64>,
    /// Where surfaces were merged.
    places: Vec<PlaceReport>,
    /// Where they were pressed in instead.
    pressed: Vec<PlaceReport>,
    /// Small holes that merging made and that were filled.
    filled: Vec<FilledReport>,
    /// Pieces that merging cut off, where the surface was inside out, and that were joined again.
    joined: Vec<JoinedReport>,
}

#[derive(Clone, Debug, Serialize)]
struct JoinedReport {
    /// µm, in the tracing's coordinates.
    position: [f64; 3],
    sample: i32,
    section: i32,
    /// The way (µm) over the surface that was left out.
    gap: f64,
    /// Volume (µm³) that joining added.
    volume: f64,
}

#[derive(Clone, Debug, Serialize)]
struct FilledReport {
    /// µm, in the tracing's coordinates.
    position: [f64; 3],
    sample: i32,
    section: i32,
    /// Length (µm) of the shortest loop around the hole.
    girth: f64,
    /// Volume (µm³) that filling added; negative if the surface around was flattened by more.
    volume: f64,
}

#[derive(Clone, Debug, Serialize)]
struct PlaceReport {
    /// µm, in the tracing's coordinates.
    position: [f64; 3],
    pairs: usize,
    samples: [i32; 2],
    sections: [i32; 2],
    /// µm.
    depth: f64,
    /// In radii of the thinner branch.
    relative_depth: f64,
    /// `near`: a bend or a fork; `apart`: branches that were traced through one another.
    kind: &'static str,
}

impl CrossingsReport {
    pub(super) fn new(Merged { report, .. }: &Merged) -> Self {
        let place = |place: &Place| PlaceReport {
            position: place.position.to_array(),
            pairs: place.pairs,
            samples: place.points,
            sections: place.sections,
            depth: place.depth,
            relative_depth: place.relative_depth,
            kind: match place.kin {
                Kin::Near => "near",
                Kin::Apart => "apart",
            },
        };
        Self {
            pairs_before: report.pairs_before,
            pairs: report.pairs,
            volume_ratio: report.volume_ratio(),
            components_before: report.components_before,
            handles_made: report.handles_made(),
            places: report.places.iter().map(place).collect(),
            pressed: report.pressed_places.iter().map(place).collect(),
            filled: report.filled.iter().map(FilledReport::from).collect(),
            joined: report.joined.iter().map(JoinedReport::from).collect(),
        }
    }
}

impl From<&Filled> for FilledReport {
    fn from(hole: &Filled) -> Self {
        Self {
            position: hole.position.to_array(),
            sample: hole.point,
            section: hole.section,
            girth: hole.girth,
            volume: hole.volume,
        }
    }
}

impl From<&Joined> for JoinedReport {
    fn from(piece: &Joined) -> Self {
        Self {
            position: piece.position.to_array(),
            sample: piece.point,
            section: piece.section,
            gap: piece.gap,
            volume: piece.volume,
        }
    }
}

/// How branches were moved apart, as JSON.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SeparationReport {
    places: Vec<SeparatedReport>,
    moved_points: usize,
    /// µm.
    median_move: f64,
    largest_move: f64,
    /// In radii.
    median_move_radii: f64,
    largest_move_radii: f64,
    /// Share of the length of all neurites.
    length_change: f64,
    /// Whether all contacts were looked at.
    complete: bool,
}

#[derive(Clone, Debug, Serialize)]
struct SeparatedReport {
    samples: [i64; 2],
    /// µm, as traced and at the end.
    depth_before: f64,
    depth: f64,
}

impl From<&Separation> for SeparationReport {
    fn from(report: &Separation) -> Self {
        let places = report.places.iter().map(|place| SeparatedReport {
            samples: place.samples,
            depth_before: place.before,
            depth: place.after,
        });
        Self {
            places: places.collect(),
            moved_points: report.moved,
            median_move: report.median_move,
            largest_move: report.largest_move,
            median_move_radii: report.median_move_radii,
            largest_move_radii: report.largest_move_radii,
            length_change: report.length_change,
            complete: report.complete,
        }
    }
}
