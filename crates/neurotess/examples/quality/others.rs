//! What `cargo xtask sweep` needs beside the figures: whether a mesh is the same as another, and other ways to mesh a cell:
//! branches moved apart, and meshes for simulations.

use std::collections::hash_map::DefaultHasher;
use std::hash::Hasher;
use std::sync::Arc;
use std::time::Instant;

use neurotess::generate::{Crossings, GenerateOptions, Smooth, SomaKeep, SomaMethod, generate};
use neurotess::mesh::{ByteWriter, SurfaceMesh};
use neurotess::morphology::Morphology;
use neurotess::recipe::{MeshOptions, Watch, mesh_watched};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

use super::facets::{crossings, folded};
use super::tree::Tree;

/// Cells of fewer points are also meshed in other ways.
const FEW: usize = 3000;

/// A number that differs where coarse meshes do: that of the usual options, and of small cells with others.
pub(crate) fn digest(morphology: &Morphology) -> Result<String, Box<dyn std::error::Error>> {
    let usual = GenerateOptions::default();
    let mut all = vec![usual.clone()];
    if morphology.points.len() < FEW {
        let area = GenerateOptions {
            soma_keep: SomaKeep::Area,
            ..usual.clone()
        };
        let smooth = GenerateOptions {
            smooth: Smooth::Auto,
            ..usual.clone()
        };
        let profile = GenerateOptions {
            soma: SomaMethod::Profile,
            ..usual
        };
        all.extend([area, smooth, profile]);
    }
    let mut hasher = DefaultHasher::new();
    for options in &all {
        let mut bytes = ByteWriter::default();
        let generated = generate(morphology, options)?;
        generated.mesh.write_bytes(&mut bytes);
        hasher.write(&bytes.into_bytes());
        hasher.write_usize(generated.warnings.len());
    }
    Ok(format!(r#", "digest": "{:x}""#, hasher.finish()))
}

/// With branches moved apart: what still crosses at level 2, how deep branches still are in one another (µm), and how far
/// points were moved (radii).
pub(crate) fn separated(morphology: &Morphology) -> Result<String, Box<dyn std::error::Error>> {
    let options = GenerateOptions {
        crossings: Crossings::Separate,
        ..GenerateOptions::default()
    };
    let generated = generate(morphology, &options)?;
    let level = LodCriterion::Homogeneous(2);
    let refinement = Refinement::new(&generated.mesh, level, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refinement);
    let positions: Vec<_> = surface.vertices.iter().map(|v| v.position).collect();
    let [near, all] = crossings(&positions, &surface.faces, &Tree::new(morphology));
    let mut line = format!(
        r#", "near": {near}, "pairs": {all}, "folded": {}"#,
        folded(&positions, &surface.faces.triangles)
    );
    if let Some(separation) = &generated.separation {
        let depth = separation.places.iter().map(|place| place.after);
        let left = depth.clone().filter(|&depth| depth > 0.0).count();
        line += &format!(
            r#", "places": {}, "left": {left}, "depth": {}, "moved": {}, "median_move": {}, "largest_move": {}, "length": {}, "complete": {}"#,
            separation.places.len(),
            depth.sum::<f64>(),
            separation.moved,
            separation.median_move_radii,
            separation.largest_move_radii,
            separation.length_change,
            separation.complete,
        );
    }
    Ok(line)
}

/// A mesh for simulations: whether it is closed, its pieces, holes, triangles and volume, their shapes, and the time it takes.
pub(crate) fn simulated(morphology: &Morphology) -> Result<String, Box<dyn std::error::Error>> {
    let clock = Instant::now();
    let morphology = Arc::new(morphology.clone());
    let cell = mesh_watched(morphology, &MeshOptions::simulation(), &Watch::default())?;
    let surface = cell.surface();
    let report = cell.report_of(&surface);
    let seconds = clock.elapsed().as_secs_f64();
    let (volume, _) = surface.volume_and_area();
    let genus = report.components as i64 - report.euler / 2;
    let mut line = format!(
        r#", "closed": {}, "pieces": {}, "genus": {genus}, "volume": {volume}, "warnings": {}, "seconds": {seconds}"#,
        report.closed,
        report.components,
        report.warnings.len(),
    );
    if let Some(merged) = surface.merged() {
        let report = &merged.report;
        line += &format!(
            r#", "pairs": {}, "triangles": {}, "places": {}, "pressed": {}, "filled": {}, "joined": {}, "dropped": {}, "changed": {}"#,
            report.pairs,
            merged.mesh.faces.triangles.len(),
            report.places.len(),
            report.pressed_places.len(),
            report.filled.len(),
            report.joined.len(),
            report.dropped.len(),
            report.faces_changed,
        );
    }
    if let Some(quality) = &report.quality {
        line += &format!(
            r#", "angle": {}, "angle_p1": {}, "angle_median": {}, "aspect_p99": {}, "thin_gaps": {}"#,
            quality.min_angle,
            quality.min_angle_p1,
            quality.min_angle_median,
            quality.aspect_p99,
            quality.thin_gaps,
        );
    }
    Ok(line)
}
