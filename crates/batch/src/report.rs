//! What is known of a cell that was meshed, under the names that `neurotess mesh --json` has.

use std::path::Path;

use neurotess_mesh::Quality;
use neurotess_recipe::{
    CrossingsReport, MeshReport, PartFile, SeparationReport, SmoothingReport, Warning, WrittenFiles,
};
use serde::Serialize;

/// One object of the JSON list, and one line of the log.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct CellReport {
    /// The tracing.
    pub file: String,
    /// The mesh.
    pub out: String,
    /// The files that were written instead of `out`, one for each type.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartFile>,
    /// The file of materials.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub materials: Option<String>,
    /// The cell's node, if it is of a circuit.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub node: Option<NodeName>,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of quads.
    pub quads: usize,
    /// Whether each edge has two faces, in opposite directions, and each vertex one disk of faces.
    pub closed: bool,
    /// Vertices minus edges plus faces.
    pub euler: i64,
    /// Pieces.
    pub components: usize,
    /// Volume (µm³) of the written mesh; none if it is not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub volume: Option<f64>,
    /// Area (µm²) of the written mesh; none if it is not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// Volume (µm³) of the somata, as meshed.
    pub soma_volume: f64,
    /// Area (µm²) of the somata, as meshed; what neurites take is no part of it.
    pub soma_area: f64,
    /// Volume (µm³) of the somata, as traced.
    pub soma_volume_traced: f64,
    /// Area (µm²) of the somata, as traced.
    pub soma_area_traced: f64,
    /// How far smoothing moved points, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<SmoothingReport>,
    /// What became of crossings, where they are merged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossings: Option<CrossingsReport>,
    /// How branches were moved apart, where they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub separation: Option<SeparationReport>,
    /// Shapes of the triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quality: Option<Quality>,
    /// What took how long.
    pub seconds: Seconds,
    /// What is said of the file, the coarse mesh and the surface.
    pub warnings: Vec<Warning>,
}

/// A node of a circuit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NodeName {
    /// Its population.
    pub population: String,
    /// Its id in there.
    pub node_id: u64,
}

/// Seconds by stage.
///
/// Refining and writing are one streamed pass over all threads: `refine` is the planning and the
/// time of the blocks, divided by the number of threads; `write` is the rest of the pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Seconds {
    /// Reading the file.
    pub read: f64,
    /// Placing neurites on somata, and elasticity.
    pub soma: f64,
    /// The rest of the coarse mesh.
    pub coarse: f64,
    /// Making the surface, merging among it.
    pub refine: f64,
    /// Writing it.
    pub write: f64,
    /// Topology, volume and area, for the report only.
    pub measure: f64,
}

impl Seconds {
    /// All that the mesh took; what only the report took is not counted.
    pub fn of_mesh(&self) -> f64 {
        self.read + self.soma + self.coarse + self.refine + self.write
    }
}

/// What a report is made of.
pub(crate) struct Told<'t> {
    pub(crate) file: &'t Path,
    pub(crate) out: &'t Path,
    pub(crate) materials: Option<std::path::PathBuf>,
    pub(crate) node: Option<NodeName>,
    /// Volume (µm³) and area (µm²) as traced, if they were measured.
    pub(crate) measured: Option<(f64, f64)>,
    /// By how much its placement multiplies volumes.
    pub(crate) growth: f64,
    pub(crate) seconds: Seconds,
}

impl CellReport {
    /// The report of a cell's files and mesh.
    pub(crate) fn new(
        told: Told<'_>,
        parts: Vec<PartFile>,
        written: &WrittenFiles,
        mesh: MeshReport,
        warnings: Vec<Warning>,
    ) -> Self {
        let of_area = told.growth.cbrt().powi(2);
        Self {
            file: told.file.display().to_string(),
            out: told.out.display().to_string(),
            parts,
            materials: told.materials.map(|file| file.display().to_string()),
            node: told.node,
            vertices: written.vertices,
            triangles: written.triangles,
            quads: written.quads,
            closed: mesh.closed,
            euler: mesh.euler,
            components: mesh.components,
            volume: told.measured.map(|(volume, _)| told.growth * volume),
            area: told.measured.map(|(_, area)| of_area * area),
            soma_volume: told.growth * mesh.soma_volume,
            soma_area: of_area * mesh.soma_area,
            soma_volume_traced: told.growth * mesh.soma_volume_traced,
            soma_area_traced: of_area * mesh.soma_area_traced,
            smoothing: mesh.smoothing,
            crossings: mesh.crossings,
            separation: mesh.separation,
            quality: mesh.quality,
            seconds: told.seconds,
            warnings,
        }
    }
}
