//! A refined surface merged with itself where it crosses.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use neurotess_mesh::{
    CoarseMesh, Extent, Quality, Soundness, SurfaceMesh, Topology, measure_surface, quality,
};
use neurotess_refine::EdgeRule;
use neurotess_union::{UnionError, UnionOptions, UnionReport, union_watched};

use crate::refined::refined;
use crate::{Levels, MeshError, MeshOptions, Watch};

/// How far surfaces of a mesh for simulators that cross are pressed in, of the radius: what is left of them after
/// branches were moved apart is less deep.
const PRESS: f64 = 0.6;

/// Circumferences of a branch up to which holes that merging made are filled in a mesh for simulators. Those of real
/// cells' bends and forks measure 1.5 at most; a loop between two branches of the astrocyte, 4.3.
const FILL: f64 = 2.0;

/// Angles (degrees) of a mesh for simulators that are made larger where the surface allows it. Tetrahedra on
/// narrower triangles are poor ones.
const MIN_ANGLE: f64 = 20.0;

/// The same as a share of the angle of half a rectangle between two rings: where that is narrow, wider triangles would only be
/// had by giving up sides of the tubes.
const MIN_SHARE: f64 = 0.95;

/// A refined surface merged with itself where it crossed.
pub struct Merged {
    /// The surface.
    pub mesh: SurfaceMesh,
    /// What merging did.
    pub report: UnionReport,
    /// What its indices say.
    pub topology: Topology,
    /// Shapes of the triangles, of a mesh for simulators.
    pub quality: Option<Quality>,
}

impl Merged {
    /// Refines a coarse mesh and merges what crosses.
    pub(crate) fn new(
        mesh: &CoarseMesh,
        options: &MeshOptions,
        watch: &Watch<'_>,
    ) -> Result<Self, MeshError> {
        let union_options = match options.is_simulation() {
            true => UnionOptions {
                press: PRESS,
                fill: FILL,
                least_angle: least_angle(options.levels),
                ..UnionOptions::default()
            },
            false => UnionOptions::default(),
        };
        let merged = SurfaceMesh::collect_watched(&*refined(mesh, options, true), watch)
            .map_err(UnionError::from)
            .and_then(|whole| union_watched(&whole, &union_options, watch))?;
        if merged.report.pairs > 0 {
            let first = merged.report.places.first();
            return Err(MeshError::StillCrosses {
                pairs: merged.report.pairs,
                sample: first.map_or(-1, |place| place.points[0]),
            });
        }
        let soundness = Soundness {
            volume: measure_surface(&merged.mesh).volume,
            reach: mesh.reach(),
        };
        let vertices = merged.mesh.vertices.iter();
        let extent = vertices.fold(Extent::NONE, |extent, v| extent.with(v.position));
        soundness.check(extent)?;
        Ok(Self {
            topology: merged.topology,
            quality: options.is_simulation().then(|| quality(&merged.mesh)),
            mesh: merged.mesh,
            report: merged.report,
        })
    }
}

/// Which angles (degrees) of a mesh for simulators are made larger.
fn least_angle(levels: Levels) -> f64 {
    match levels {
        Levels::Edges(EdgeRule::Lengths { radii, aspect, .. }) => {
            // Pieces of a ring's four edges, which are arcs of a right angle.
            let pieces = (FRAC_PI_2 / f64::from(radii)).round().max(1.0);
            let chord = 2.0 * (FRAC_PI_4 / pieces).sin();
            let half_rectangle = (chord / f64::from(radii * aspect)).atan().to_degrees();
            MIN_ANGLE.min(MIN_SHARE * half_rectangle)
        }
        _ => MIN_ANGLE,
    }
}
