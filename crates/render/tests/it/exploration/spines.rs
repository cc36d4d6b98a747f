//! Spines: left out where they are too small, with their ink.

use super::*;

/// A soma with six dendrites that wind, without and with spines, and how many spines there are.
fn with_spines() -> ([CoarseMesh; 2], usize) {
    let mut text = String::from("1 1 0 0 0 6 -1\n");
    let mut id = 2;
    for dendrite in 0..6 {
        let (sin, cos) = (f64::from(dendrite) * 1.05).sin_cos();
        let mut parent = 1;
        for step in (0..46).map(f64::from) {
            let (far, aside) = (8.0 + 2.0 * step, 3.0 * (0.3 * step).sin());
            let (x, y) = (far * cos - aside * sin, far * sin + aside * cos);
            let z = 2.0 * (0.41 * step).cos() - 2.0;
            text.push_str(&format!("{id} 3 {x} {y} {z} 0.6 {parent}\n"));
            (parent, id) = (id, id + 1);
        }
    }
    let read = swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default());
    let plain = read.expect("a cell").morphology;
    let places = SpinePlaces::Density(1.0);
    let spiny = edit::apply(&plain, &[Edit::Spines { places, seed: 1 }]).expect("grown");
    let spines = (spiny.morphology.sections.len() - plain.sections.len()) / 2;
    let mesh = |morphology| {
        let generated = generate(morphology, &GenerateOptions::default());
        generated.expect("meshed").mesh
    };
    ([mesh(&plain), mesh(&spiny.morphology)], spines)
}

/// The longest spines begin to fade at some 500 µm, and all are left out from 2,000 µm on.
#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn far_spines_cost_nothing_and_leave_their_ink() {
    let gpu = device();
    let ([plain, spiny], spines) = with_spines();
    assert!(spines > 400, "{spines}");
    let (_, table) = by_type(&spiny);
    let one = [Instance::new(TemplateId(0))];
    let (_, mut without) = both(&gpu, &plain, &one);
    let (mut adaptive, mut with) = both(&gpu, &spiny, &one);
    for source in [&mut without, &mut with] {
        source.set_budget(2_000_000);
    }
    for distance in [150.0, 300.0, 400.0, 500.0, 700.0, 1000.0, 2000.0, 4000.0] {
        let eye = DVec3::new(0.1, 0.2, 1.0).normalize_or(DVec3::Z) * distance;
        let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
        let expected = ink(&picture(&gpu, &mut adaptive, &camera, &table));
        let found = ink(&picture(&gpu, &mut with, &camera, &table));
        let all: f64 = expected.iter().sum();
        let change = found.iter().sum::<f64>() / all - 1.0;
        picture(&gpu, &mut without, &camera, &table);
        let [few, many] = [&without, &with].map(|source| {
            let stats = source.stats(&gpu).expect("counted");
            assert_eq!(stats.triangles, stats.requested);
            stats.triangles
        });
        note!("{distance}: {change:+.4} ink, {many} triangles, {few} without spines");
        // Measured on lavapipe: 0.081, where all of them are drawn.
        assert!(change.abs() < 0.1, "{distance}: {change}");
        if distance >= 2000.0 {
            assert!(many <= few + spines as u64 / 4, "{distance}: {many}, {few}");
        }
        if distance <= 150.0 {
            assert!(many > few + spines as u64, "{many} {few}");
        }
    }
    // While they fade, a slow camera sees no more change than of the refined surface.
    let mut worst = |from: f64| {
        let mut changes = [&mut adaptive as &mut dyn VertexSource, &mut with].map(|source| {
            let frame = |i: i32| {
                let distance = from * 0.999_f64.powi(i);
                let eye = DVec3::new(0.1, 0.2, 1.0).normalize_or(DVec3::Z) * distance;
                let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
                picture(&gpu, source, &camera, &table)
            };
            let frames: Vec<Image> = (0..7).map(frame).collect();
            let change = |pair: &[Image]| {
                let pairs = pair[0].pixels.iter().zip(&pair[1].pixels);
                pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>()
            };
            frames.windows(2).map(change).fold(0.0, f64::max)
        });
        changes[1] /= changes[0];
        note!(
            "from {from}: {:.3} of the refined surface's change",
            changes[1]
        );
        changes[1]
    };
    for from in [200.0, 300.0, 450.0, 800.0] {
        let change = worst(from);
        // Measured on lavapipe: 1.085, 1.026, 0.917 and 0.767; the first two also if none are left out. With the meshes of before
        // 2026-11-29, whose twigs begin otherwise, 1.053, 1.030, 0.924 and 0.750.
        assert!(change < 1.11, "{from}: {change}");
    }
}
