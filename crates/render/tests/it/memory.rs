//! Bytes on the device per tracing point, on real cells where they are at hand and on one of
//! LiveMesh's size.

use crate::adapter::{device, gpu};
use crate::common::trees::{Twig, grow};
use neurotess_formats::{ReadOptions, swc};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, Surface};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_render::{Gpu, Template, Templates};
use neurotess_testing::{note, shared, shared_data};

/// Bytes per point, and how many points.
fn bytes_per_point(gpu: &Gpu, mesh: &CoarseMesh) -> (f64, usize) {
    // As many colors as coloring by section needs.
    let color_keys: Vec<u32> = mesh.tracing.iter().map(|t| t.section.0 as u32).collect();
    let template = Template {
        mesh,
        color_keys: &color_keys,
        values: &[],
    };
    let mut templates = Templates::new();
    templates.add(gpu, &[template]).expect("uploaded");
    (templates.bytes_per_point(), templates.point_count())
}

#[neurotess_testing::test(needs(gpu, shared))]
fn real_cells_take_28_bytes_a_point() {
    let gpu = device();
    let entries = std::fs::read_dir(shared_data().join("swc")).expect("tracings");
    let mut paths: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    paths.sort();
    for path in paths {
        // The largest take their time to mesh and are no harder.
        let Ok(bytes) = std::fs::read(&path) else {
            continue;
        };
        if bytes.len() > 2_000_000 {
            continue;
        }
        let Ok(read) = swc::read_bytes(&bytes, "cell", &ReadOptions::default()) else {
            continue;
        };
        let mesh = generate(&read.morphology, &GenerateOptions::default())
            .expect("meshed")
            .mesh;
        let (each, points) = bytes_per_point(&gpu, &mesh);
        if points >= 2000 {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            note!("{each:6.2} bytes a point, {points:6} points: {name}");
            // 26 with circles at bends: rings with a crease take 20 more, a sixth of all in the worst of these.
            assert!(each <= 28.0, "{name}: {each}");
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn a_cell_of_live_mesh_s_size_takes_22_bytes_a_point() {
    let gpu = device();
    // 271 sections of 25.6 segments.
    let twigs: Vec<Twig> = (0..271)
        .map(|i| Twig {
            parent: if i < 5 { i } else { (i - 3) / 2 },
            seed: i as u64 * 31 + 7,
            points: 25 + usize::from(i % 9 < 5),
            step: 4.0,
            wild: 0.2,
            radius: 0.5,
        })
        .collect();
    let mesh = generate(&grow(&twigs, Some(7.0)), &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    let (each, points) = bytes_per_point(&gpu, &mesh);
    let whole = each * points as f64;
    note!("{points} points, {each:.2} bytes each, {whole:.0} in all; LiveMesh: 160400");
    for level in 1..=6 {
        let stored = Refinement::new(
            &mesh,
            LodCriterion::Homogeneous(level),
            &RefineOptions::default(),
        );
        let bytes = 24 * stored.vertex_count() + 12 * stored.triangle_count();
        note!("level {level} stored: {bytes} bytes");
        assert!(bytes as f64 > 4.0 * whole);
    }
    assert!((6500..7400).contains(&points), "{points}");
    // LiveMesh takes 160,400 for a cell of this size, without smooth forks.
    assert!(whole <= 22.0 * points as f64, "{whole}");
}
