//! What is known of a cell's mesh, under the names that `neurotess mesh --json` has.

use neurotess_generate::{Generated, Separation, Smoothing, SomaReport};
use neurotess_mesh::Quality;
use neurotess_union::{Filled, Joined, Kin, Place};
use serde::{Serialize, Serializer};

use crate::merged::Merged;
use crate::{CellMesh, CellSurface, SurfaceWarning, Warning};

/// What is known of a cell's mesh.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct MeshReport {
    /// Whether each edge has two faces, in opposite directions, and each vertex one disk of faces.
    pub closed: bool,
    /// Vertices minus edges plus faces: 2 for each piece without a hole.
    pub euler: i64,
    /// Pieces.
    pub components: usize,
    /// Volume (µm³) of all somata.
    pub soma_volume: f64,
    /// Area (µm²) of all somata without what neurites take.
    pub soma_area: f64,
    /// Volume (µm³) of all somata as they were traced.
    pub soma_volume_traced: f64,
    /// Area (µm²) of all somata as they were traced.
    pub soma_area_traced: f64,
    /// How far smoothing moved points, if it was asked for.
    pub smoothing: Option<SmoothingReport>,
    /// What became of crossings, where they are merged.
    pub crossings: Option<CrossingsReport>,
    /// How branches were moved apart, where they are.
    pub separation: Option<SeparationReport>,
    /// Shapes of the triangles of a mesh for simulators.
    pub quality: Option<Quality>,
    /// What is said of the coarse mesh and the surface.
    pub warnings: Vec<Warning>,
}

impl CellMesh {
    /// What is known of it.
    pub fn report(&self) -> MeshReport {
        self.report_of(&self.surface())
    }

    /// [`CellMesh::report`], given its surface.
    pub fn report_of(&self, surface: &CellSurface<'_>) -> MeshReport {
        let (generated, merged) = (&self.generated, surface.merged());
        MeshReport {
            closed: surface.topology.closed,
            euler: surface.topology.euler,
            components: surface.topology.components,
            soma_volume: of_somata(generated, |soma| soma.volume),
            soma_area: of_somata(generated, |soma| soma.area),
            soma_volume_traced: of_somata(generated, |soma| soma.traced_volume),
            soma_area_traced: of_somata(generated, |soma| soma.traced_area),
            smoothing: generated.smoothing.as_ref().map(SmoothingReport::from),
            crossings: merged.map(CrossingsReport::new),
            separation: generated.separation.as_ref().map(SeparationReport::from),
            quality: merged.and_then(|merged| merged.quality),
            warnings: self.warnings(surface),
        }
    }

    /// What is said of the coarse mesh and of the surface.
    fn warnings(&self, surface: &CellSurface<'_>) -> Vec<Warning> {
        let of_mesh = self.generated.warnings.iter().cloned().map(Warning::Mesh);
        let of_surface = surface.merged().into_iter();
        let of_surface = of_surface.flat_map(SurfaceWarning::of_merged);
        let thinned = (!self.thinned.is_empty()).then(|| SurfaceWarning::Thinned {
            samples: self.thinned.clone(),
        });
        let of_surface = of_surface.chain(thinned).map(Warning::Surface);
        of_mesh.chain(of_surface).collect()
    }
}

/// The sum of a figure of all somata.
fn of_somata(generated: &Generated, figure: fn(&SomaReport) -> f64) -> f64 {
    // Adding 0 turns −0, the sum of no somata, into 0.
    generated.somata.iter().map(figure).sum::<f64>() + 0.0
}

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Told {
            line: Option<u64>,
            sample: Option<i64>,
            code: &'static str,
            message: String,
            count: u64,
        }
        Told {
            line: self.line(),
            sample: self.sample(),
            code: self.code(),
            message: self.to_string(),
            count: self.count(),
        }
        .serialize(serializer)
    }
}

/// What became of places where the surface crosses itself, as JSON.
#[derive(Clone, Debug, Serialize)]
pub struct CrossingsReport {
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
    pub(crate) fn new(Merged { report, .. }: &Merged) -> Self {
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
pub struct SeparationReport {
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

/// How far smoothing moved points, as JSON.
#[derive(Clone, Debug, Serialize)]
pub struct SmoothingReport {
    /// Points between roots, forks and ends, which were free to move.
    points: usize,
    /// µm.
    median_move: f64,
    largest_move: f64,
    /// In radii.
    median_move_radii: f64,
    largest_move_radii: f64,
    /// Share of the length of all neurites.
    length_change: f64,
}

impl From<&Smoothing> for SmoothingReport {
    fn from(report: &Smoothing) -> Self {
        Self {
            points: report.points,
            median_move: report.median_move,
            largest_move: report.largest_move,
            median_move_radii: report.median_move_radii,
            largest_move_radii: report.largest_move_radii,
            length_change: report.length_change,
        }
    }
}
