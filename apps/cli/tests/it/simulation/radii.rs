//! `--radii` and `--simulation`: volume, triangles and loops.

use std::f64::consts::PI;
use std::path::Path;

use neurotess::mesh::{Report, check, read};
use serde_json::Value;

use super::neurotess;
use crate::work::sample;

/// Meshes a tracing: what the command and the checks say.
fn meshed(folder: &Path, options: &str) -> (Value, Report) {
    let command = format!("mesh cell.swc -o cell.ply --force --json {options}");
    let told = neurotess(folder, &command).expect("meshed");
    let mut told: Value = serde_json::from_str(&told).expect("JSON");
    let mesh = read(&folder.join("cell.ply")).expect("our file");
    (told[0].take(), check(&mesh))
}

/// A straight neurite of radius 0.5 µm and 60 µm without a soma.
fn rod(folder: &Path) -> f64 {
    let samples = (0..13).map(|n| {
        format!(
            "{} 2 {} 0 0 0.5 {}\n",
            n + 1,
            5 * n,
            if n == 0 { -1 } else { n }
        )
    });
    std::fs::write(folder.join("cell.swc"), samples.collect::<String>()).expect("a file");
    PI * 0.25 * 60.0
}

#[neurotess_testing::test]
fn radii_of_equal_area_keep_the_volume() {
    let folder = tempfile::tempdir().expect("a folder");
    let traced = rod(folder.path());
    let volume = |options: &str| meshed(folder.path(), options).1.volume / traced;
    assert!((0.88..0.92).contains(&volume("--level 2 --caps flat")));
    for levels in [
        "--level 1",
        "--level 2",
        "--level 2 --level-along 3",
        "--isotropic 0.5",
    ] {
        let kept = volume(&format!("{levels} --caps flat --radii equal-area"));
        assert!((kept - 1.0).abs() < 0.003, "{levels}: {kept}");
    }
    let kept = volume("--simulation --caps flat");
    assert!((kept - 1.0).abs() < 0.005, "{kept}");
    let lost = volume("--simulation --radii traced --caps flat");
    assert!(lost < 0.92, "{lost}");
    let unknown = "mesh cell.swc -o cell.ply --force --max-error 0.1 --radii equal-area";
    let refused = neurotess(folder.path(), unknown).expect_err("no sides are known");
    assert!(refused.contains("use --level or --isotropic"), "{refused}");
}

#[neurotess_testing::test]
fn simulators_get_wide_triangles_and_half_as_many() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::copy(sample("granule.swc"), folder.path().join("cell.swc")).expect("copied");
    let (told, usual) = meshed(folder.path(), "--simulation");
    assert!(usual.closed && usual.self_intersections == 0 && usual.genus == Some(0));
    assert!(usual.quality.min_angle_p1 >= 15.0, "{:?}", usual.quality);
    let ratio = told["crossings"]["volume_ratio"]
        .as_f64()
        .expect("a number");
    assert!((ratio - 1.0).abs() < 0.002, "{ratio}");
    let (_, even) = meshed(folder.path(), "--simulation --max-aspect 1");
    assert!(even.quality.min_angle_p1 >= 20.0, "{:?}", even.quality);
    assert!(10 * usual.triangles < 6 * even.triangles);
}

/// A neurite that turns back through itself again and again.
const TANGLE: &str = "1 3 0 0 0 0.4 -1\n2 3 0.72 0.39 0.38 0.4 1\n3 3 1.49 0.35 -0.09 0.4 2\n4 3 0.66 0.07 -0.29 0.4 3\n\
    5 3 -0.2 -0.07 -0.08 0.4 4\n6 3 -0.37 -0.06 -0.96 0.4 5\n7 3 -0.14 -0.93 -0.94 0.4 6\n8 3 0.13 -1.7 -0.55 0.4 7\n\
    9 3 -0.21 -0.93 -0.23 0.4 8\n10 3 0.61 -0.6 -0.07 0.4 9\n11 3 -0.11 -0.12 0.18 0.4 10\n12 3 -0.87 0.36 0.25 0.4 11\n\
    13 3 -1.38 -0.22 -0.21 0.4 12\n14 3 -0.66 -0.76 -0.27 0.4 13\n15 3 -1.4 -1.23 -0.48 0.4 14\n";

#[neurotess_testing::test]
fn a_tangle_is_one_piece_without_loops() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("cell.swc"), TANGLE).expect("a file");
    let (told, mesh) = meshed(folder.path(), "--simulation");
    let warnings = told["warnings"].as_array().expect("a list");
    let told = |code: &str| warnings.iter().any(|warning| warning["code"] == code);
    // Before bends kept the points around them, it needed thinner tubes.
    assert!(told("rings_cross") && !told("thinned") && !told("handles"));
    assert!(mesh.closed && mesh.self_intersections == 0);
    assert_eq!((mesh.components, mesh.genus), (1, Some(0)));
}
