//! Somata: there at any distance, and many of them.

use super::*;

#[neurotess_testing::test(needs(gpu))]
fn somata_below_a_pixel_spend_the_budget() {
    let gpu = device();
    let mut random = Random(23);
    let proxies = [Proxy::new(&cell(3, 20), &[])];
    let instances = scattered(&mut random, 30_000, 1, 40_000.0);
    let mut source = explored(&gpu, &proxies, instances);
    for budget in [1000, 10_000] {
        source.set_budget(budget);
        let camera = Camera::new(DVec3::Z * 60_000.0, DVec3::ZERO, DVec3::Y, 1.0);
        let frame = frame(camera.expect("a camera"), 200, 200);
        source.prepare(&gpu, &frame).expect("prepared");
        let stats = source.stats(&gpu).expect("counted");
        assert!(stats.requested > 2 * u64::from(budget), "{stats:?}");
        assert!(100 * stats.triangles > 95 * u64::from(budget), "{stats:?}");
    }
}

#[neurotess_testing::test(needs(gpu))]
fn a_crowd_of_somata_looks_like_one_also_within_a_budget() {
    let gpu = device();
    let mut random = Random(29);
    let soma = mesh("1 1 0 0 0 6 -1\n");
    let (color_keys, table) = by_type(&soma);
    let proxies = [Proxy::new(&soma, &color_keys)];
    let camera = Camera::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 1.0).expect("a camera");
    let halves = |image: &Image| {
        let ink = ink(image);
        let of = |left: bool| -> f64 {
            let here = (0..).zip(&ink).filter(|(tile, _)| (tile % 20 < 10) == left);
            here.map(|(_, ink)| ink).sum()
        };
        [of(true), of(false)]
    };
    // Two crowds side by side in the picture, one three times as far away as the other: somata of a radius of 0.04 and
    // 0.015 sub-pixels, then of 0.4 and 0.13. Dots are at least a pixel, so that those left out are
    // made up for where they are about as large.
    for (scale, least) in [(0.25, [0.4, 0.4]), (2.2, [1.1, 0.4])] {
        let mut instances = Vec::new();
        for (count, at, edge) in [(1500, -9000.0, 12_000.0), (3000, 27_000.0, 36_000.0)] {
            let far = if at < 0.0 { 30_000.0 } else { 90_000.0 };
            for mut instance in scattered(&mut random, count, 1, edge) {
                instance.placement.translation += DVec3::new(at, 0.0, -far);
                instance.placement.scale = scale;
                instances.push(instance);
            }
        }
        let mut source = explored(&gpu, &proxies, instances);
        source.set_budget(MAX_BUDGET);
        let all = halves(&picture(&gpu, &mut source, &camera, &table));
        for share in [2, 4, 8] {
            source.set_budget(2 * 4500 / share);
            let some = halves(&picture(&gpu, &mut source, &camera, &table));
            let kept = [some[0] / all[0], some[1] / all[1]];
            let fair = 1.0 / f64::from(share);
            note!(
                "1 of {share} somata, scale {scale}: {:.2} and {:.2} of the ink",
                kept[0],
                kept[1]
            );
            for (kept, least) in kept.iter().zip(least) {
                assert!((least * fair..1.3).contains(kept), "{kept} of {fair}");
            }
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn somata_are_seen_from_any_distance() {
    let gpu = device();
    let mesh = mesh("1 1 0 0 0 6 -1\n");
    let (_, table) = by_type(&mesh);
    let (_, mut source) = both(&gpu, &mesh, &[Instance::new(TemplateId(0))]);
    for distance in [30.0, 300.0, 3e3, 3e4, 3e5, 3e6] {
        let camera = Camera::new(DVec3::Z * distance, DVec3::ZERO, DVec3::Y, 0.7).expect("one");
        let found: f64 = ink(&picture(&gpu, &mut source, &camera, &table))
            .iter()
            .sum();
        // Black on white: a pixel's worth of light, were it spread over four.
        assert!(found > 110.0, "{distance}: {found}");
    }
}
