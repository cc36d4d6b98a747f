//! Exploration keeps its budget, spends it where it shows most, and loses nothing on the way.

mod somata;
mod spines;

use std::convert::Infallible;

use crate::adapter::{device, gpu};
use crate::common::{Random, cell, extent, smooth_cell};
use crate::pictured::{CELL, by_type, mesh, one_template};
use glam::{DQuat, DVec3};
use neurotess_formats::{ReadOptions, swc};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::CoarseMesh;
use neurotess_morphology::edit::{self, Edit, SpinePlaces};
use neurotess_render::color::ColorTable;
use neurotess_render::testing::{LodRequest, lod_requests};
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Exploration, ExplorationError, Frame, Gpu, Image, Instance,
    MAX_BUDGET, Occlusion, PictureOptions, Placement, Projection, Proxy, Scene, TemplateId,
    VertexSource, Viewpoint, render_still,
};
use neurotess_testing::note;

fn frame(camera: Camera, width: u32, height: u32) -> Frame {
    // Without perspective everything is in front.
    let near = if camera.is_orthographic() { -1e6 } else { 1e-2 };
    Frame::whole(camera, near, [width, height])
}

/// Instances of so many templates in a box of this edge (µm).
fn scattered(random: &mut Random, count: usize, templates: usize, edge: f64) -> Vec<Instance> {
    let instance = |random: &mut Random| {
        let half = edge / 2.0;
        let mut at = || random.real(-half, half);
        let translation = DVec3::new(at(), at(), at());
        let angle = random.real(0.0, 6.0);
        Instance {
            placement: Placement {
                rotation: DQuat::from_axis_angle(random.direction(), angle).normalize(),
                scale: random.real(0.5, 2.0),
                translation,
            },
            ..Instance::new(TemplateId(random.whole(templates as u64) as u32))
        }
    };
    (0..count).map(|_| instance(random)).collect()
}

fn explored(gpu: &Gpu, proxies: &[Proxy], instances: Vec<Instance>) -> Exploration {
    let mut source = Exploration::new(gpu, 1).expect("a source");
    source.add(gpu, proxies).expect("uploaded");
    source.set_instances(gpu, instances).expect("instances");
    source
}

fn any_camera(random: &mut Random, reach: f64) -> Camera {
    let distance = reach * random.real(-3.0, 4.0).exp2();
    let eye = random.direction() * distance;
    let target = random.direction() * reach * 0.3;
    let up = (target - eye).any_orthogonal_vector();
    Camera::new(eye, target, up, random.real(0.1, 1.5)).expect("a camera")
}

#[neurotess_testing::test(needs(gpu))]
fn the_budget_is_never_exceeded_and_used_when_it_is_needed() {
    let gpu = device();
    let mut random = Random(5);
    let proxies: Vec<Proxy> = (0..3).map(|i| Proxy::new(&cell(i, 30), &[])).collect();
    for (count, edge) in [(1, 1.0), (7, 100.0), (300, 800.0)] {
        let instances = scattered(&mut random, count, proxies.len(), edge);
        let mut source = explored(&gpu, &proxies, instances);
        for budget in [0, 1, 2, 3, 10, 100, 1000, 12_345, 100_000, MAX_BUDGET] {
            source.set_budget(budget);
            for _ in 0..4 {
                let camera = any_camera(&mut random, edge + 60.0);
                source
                    .prepare(&gpu, &frame(camera, 400, 300))
                    .expect("prepared");
                let stats = source.stats(&gpu).expect("counted");
                assert!(stats.triangles <= u64::from(budget), "{stats:?}");
                assert_eq!(stats.all_instances, count as u64);
                if stats.requested <= u64::from(budget) {
                    assert_eq!(stats.triangles, stats.requested, "all that is wanted");
                } else if budget >= 10_000 {
                    // What is left of a budget is less than the class that did not fit.
                    assert!(5 * stats.triangles >= 3 * u64::from(budget), "{stats:?}");
                }
            }
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn what_is_drawn_is_what_is_worth_most() {
    let gpu = device();
    let mut random = Random(11);
    let proxies: Vec<Proxy> = (0..2).map(|i| Proxy::new(&cell(i, 40), &[])).collect();
    let instances = scattered(&mut random, 40, proxies.len(), 300.0);
    let mut source = explored(&gpu, &proxies, instances.clone());
    let (mut compared, mut off) = (0, 0);
    for budget in [500, 5000, 60_000, MAX_BUDGET] {
        source.set_budget(budget);
        for projection in [Projection::Perspective, Projection::Orthographic].repeat(3) {
            let camera = any_camera(&mut random, 300.0).with_projection(projection);
            let frame = frame(camera, 500, 300);
            source.prepare(&gpu, &frame).expect("prepared");
            let shown = source.shown(&gpu).expect("read back");
            let mut shown = shown
                .iter()
                .map(|s| ((s.instance, s.chunk), s.quads))
                .peekable();
            let (mut least, mut most) = (f64::MAX, f64::MIN);
            for (i, instance) in (0..).zip(&instances) {
                let proxy = &proxies[instance.template.0 as usize];
                let chunks = lod_requests(proxy, &instance.placement, &frame, 1, i);
                for (chunk, steps) in (0..).zip(chunks) {
                    let there = shown.next_if(|&(at, _)| at == (i, chunk));
                    let quads = there.map_or(0, |(_, quads)| quads);
                    compared += 1;
                    match drawn_steps(&steps, quads) {
                        Some(drawn) => {
                            let class = |step: &LodRequest| step.class;
                            least = steps[..drawn].iter().map(class).fold(least, f64::min);
                            most = steps[drawn..].iter().map(class).fold(most, f64::max);
                        }
                        // On an edge between two levels of detail, f32 and f64 may disagree.
                        None => off += 1,
                    }
                }
            }
            assert_eq!(shown.next(), None, "drawn in order, and nothing else");
            assert!(most < least + 1.01, "{most} was left out, {least} drawn");
            if budget == MAX_BUDGET {
                assert_eq!(most, f64::MIN, "nothing is left out");
            }
        }
    }
    note!("{off} of {compared} chunks on an edge");
    // Measured on lavapipe: none of 12,512. Another driver rounds elsewhere: one in 2000.
    assert!(off * 2000 < compared, "{off} of {compared}");
}

#[neurotess_testing::test(needs(gpu))]
fn the_frame_before_changes_nothing_but_the_cost() {
    let gpu = device();
    let mut random = Random(17);
    let proxies: Vec<Proxy> = (0..3).map(|i| Proxy::new(&cell(i, 60), &[])).collect();
    let instances = scattered(&mut random, 400, proxies.len(), 1500.0);
    let all: usize = instances
        .iter()
        .map(|i| proxies[i.template.0 as usize].spheres().len())
        .sum();
    let mut source = explored(&gpu, &proxies, instances);
    let mut measured = 0;
    for budget in [200, 3000, 30_000, 200, MAX_BUDGET, 3000] {
        source.set_budget(budget);
        for _ in 0..5 {
            // Far jumps: the least worth of the frame before is too high or too low a guess.
            let frame = frame(any_camera(&mut random, 1500.0), 400, 300);
            source.prepare(&gpu, &frame).expect("prepared");
            let shown = source.shown(&gpu).expect("read back");
            let again = source.shown(&gpu).expect("read back");
            assert!(shown == again, "the second time it is a good guess");
            // Statistics measure everything.
            let stats = source.stats(&gpu).expect("counted");
            let triangles: u64 = shown.iter().map(|s| 2 * u64::from(s.quads)).sum();
            assert_eq!(stats.triangles, triangles, "budget {budget}");
            assert_eq!(stats.visible_chunks, shown.len() as u64);
            assert!(!stats.at_least);
            if budget == 200 {
                measured += source.measured(&gpu).expect("counted");
            }
        }
    }
    // Measured: a tenth, most of it where only a few cells are in view.
    note!(
        "{} of {all} chunks measured for 200 triangles",
        measured / 10
    );
    assert!(measured / 10 < all as u64 / 4, "{}", measured / 10);
}

/// How many steps make these quads.
fn drawn_steps(steps: &[LodRequest], quads: u32) -> Option<usize> {
    let mut sum = 0;
    let sums = steps.iter().map(|step| {
        sum += step.quads;
        sum
    });
    let mut sums = vec![0].into_iter().chain(sums.collect::<Vec<_>>());
    sums.position(|sum| sum == quads)
}

fn picture(gpu: &Gpu, source: &mut dyn VertexSource, camera: &Camera, table: &ColorTable) -> Image {
    let options = PictureOptions {
        size: [320, 240],
        samples: 16,
        occlusion: Occlusion::Off,
        ..PictureOptions::default()
    };
    let mut whole = Image::default();
    let take = |_: u32, band: Image| {
        whole = band;
        Ok::<(), Infallible>(())
    };
    render_still(
        gpu,
        source,
        &Viewpoint {
            camera: *camera,
            near: 1.0,
        },
        table,
        &options,
        take,
    )
    .expect("drawn");
    whole
}

/// How much darker than the background a picture is, summed over tiles of 16 × 16 pixels.
fn ink(image: &Image) -> Vec<f64> {
    let across = image.width.div_ceil(16);
    let mut tiles = vec![0.0; (across * image.height.div_ceil(16)) as usize];
    for y in 0..image.height {
        for x in 0..image.width {
            let [r, g, b, _] = image.at(x, y).map(f64::from);
            tiles[(y / 16 * across + x / 16) as usize] += 255.0 - (r + g + b) / 3.0;
        }
    }
    tiles
}

/// Both sources of one scene.
fn both(gpu: &Gpu, mesh: &CoarseMesh, instances: &[Instance]) -> (Adaptive, Exploration) {
    let (color_keys, _) = by_type(mesh);
    let (templates, _) = one_template(gpu, mesh);
    let scene = Scene::new(templates, instances.to_vec()).expect("a scene");
    let adaptive = Adaptive::new(gpu, scene, AdaptiveSettings::default(), 2).expect("a source");
    let mut source = explored(gpu, &[Proxy::new(mesh, &color_keys)], instances.to_vec());
    source.set_sub_pixels(2);
    (adaptive, source)
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn nothing_vanishes_near_or_far() {
    let gpu = device();
    let mesh = smooth_cell(3);
    let (_, table) = by_type(&mesh);
    let mut random = Random(2);
    for (count, edge) in [(1, 1.0), (40, 250.0)] {
        let instances = scattered(&mut random, count, 1, edge);
        let (mut adaptive, mut source) = both(&gpu, &mesh, &instances);
        source.set_budget(2_000_000);
        for distance in [60.0, 200.0, 600.0, 2000.0] {
            let eye = DVec3::new(0.3, 0.5, 1.0).normalize_or(DVec3::Z) * (distance + edge);
            let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
            let expected = ink(&picture(&gpu, &mut adaptive, &camera, &table));
            let found = ink(&picture(&gpu, &mut source, &camera, &table));
            let all: f64 = expected.iter().sum();
            let change = found.iter().sum::<f64>() / all - 1.0;
            let off: f64 = expected
                .iter()
                .zip(&found)
                .map(|(a, b)| (a - b).abs())
                .sum();
            note!(
                "{count} at {distance}: {change:+.4} ink, {:.4} off",
                off / all
            );
            // As much ink, and where it was, in each 16 × 16 pixels. Measured on lavapipe: 0.024
            // and 0.047, both at the greatest distance.
            assert!(change.abs() < 0.03, "{count} at {distance}: {change}");
            assert!(off / all < 0.06, "{count} at {distance}: {}", off / all);
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn the_position_in_the_world_does_not_matter() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (_, table) = by_type(&mesh);
    let (_, mut source) = both(&gpu, &mesh, &[Instance::new(TemplateId(0))]);
    let mut at = |position: DVec3| {
        let instance = Instance {
            placement: Placement {
                translation: position,
                ..Placement::default()
            },
            ..Instance::new(TemplateId(0))
        };
        source.set_instances(&gpu, vec![instance]).expect("placed");
        let eye = position + DVec3::new(3.0, 4.0, 60.0);
        let camera = Camera::new(eye, position, DVec3::Y, 0.7).expect("a camera");
        picture(&gpu, &mut source, &camera, &table)
    };
    let here = at(DVec3::ZERO);
    let there = at(DVec3::new(1e6 + 0.123, -2e6, 3e6));
    let steps = here.pixels.iter().zip(&there.pixels);
    let off = steps.filter(|(a, b)| a.abs_diff(**b) > 8).count();
    // Positions are kept within a 16,000th of a µm: a sample at an edge may fall to the other side.
    assert!(off * 1000 < here.pixels.len(), "{off}");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_slow_camera_sees_nothing_pop() {
    let gpu = device();
    let mesh = smooth_cell(3);
    let (_, table) = by_type(&mesh);
    let instances = scattered(&mut Random(4), 30, 1, 200.0);
    let (mut adaptive, mut source) = both(&gpu, &mesh, &instances);
    let worst = |source: &mut dyn VertexSource| {
        let frames: Vec<Image> = (0..9)
            .map(|i| {
                let t = f64::from(i);
                let eye = DVec3::new((0.0005 * t).sin(), 0.3, (0.0005 * t).cos());
                let eye = eye * 420.0 * 0.999_f64.powf(t);
                let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
                picture(&gpu, source, &camera, &table)
            })
            .collect();
        let change = |pair: &[Image]| {
            let pairs = pair[0].pixels.iter().zip(&pair[1].pixels);
            pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>()
        };
        frames.windows(2).map(change).fold(0.0, f64::max)
    };
    let reference = worst(&mut adaptive);
    source.set_budget(1_000_000);
    let all = worst(&mut source) / reference;
    source.set_budget(4_000);
    let few = worst(&mut source) / reference;
    note!("changes: {all:.3} of the refined surface's; within a small budget {few:.3}");
    // Measured on lavapipe: 0.970 and 0.983.
    assert!(all < 1.02, "{all}");
    assert!(few < 1.05, "{few}");
}

#[neurotess_testing::test(needs(gpu))]
fn what_passes_beside_the_eye_takes_no_budget() {
    let gpu = device();
    let mesh = cell(7, 60);
    let (_, table) = by_type(&mesh);
    let instances = scattered(&mut Random(6), 300, 1, 250.0);
    let (_, mut source) = both(&gpu, &mesh, &instances);
    let camera = Camera::new(DVec3::Z * 20.0, DVec3::ZERO, DVec3::Y, 0.9).expect("a camera");
    source.set_budget(MAX_BUDGET);
    let all: f64 = ink(&picture(&gpu, &mut source, &camera, &table))
        .iter()
        .sum();
    source.set_budget(40_000);
    let found: f64 = ink(&picture(&gpu, &mut source, &camera, &table))
        .iter()
        .sum();
    let stats = source.stats(&gpu).expect("counted");
    note!("{:.3} of the ink, {stats:?}", found / all);
    assert!(stats.requested > 10 * stats.budget && found > 0.8 * all);
}

#[neurotess_testing::test(needs(gpu))]
fn instances_hide_and_come_back() {
    let gpu = device();
    let proxy = Proxy::new(&cell(1, 20), &[]);
    let mut random = Random(8);
    let instances = scattered(&mut random, 5, 1, 100.0);
    let mut source = explored(&gpu, &[proxy], instances);
    let camera = Camera::new(DVec3::Z * 500.0, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
    let seen = |source: &mut Exploration| {
        source
            .prepare(&gpu, &frame(camera, 300, 300))
            .expect("prepared");
        let shown = source.shown(&gpu).expect("read back");
        let mut instances: Vec<u32> = shown.iter().map(|chunk| chunk.instance).collect();
        instances.dedup();
        instances
    };
    assert_eq!(seen(&mut source), [0, 1, 2, 3, 4]);
    source.set_hidden(0, true);
    source.set_hidden(3, true);
    assert_eq!(seen(&mut source), [1, 2, 4]);
    source.set_hidden(3, false);
    source.set_state(1, 7);
    assert_eq!(seen(&mut source), [1, 2, 3, 4]);
    assert_eq!(source.instances()[1].state, 7);
    for i in 0..5 {
        source.set_hidden(i, true);
    }
    assert!(seen(&mut source).is_empty());
    // Another template while it is in use.
    let ids = source
        .add(&gpu, &[Proxy::new(&cell(2, 10), &[])])
        .expect("uploaded");
    assert_eq!(ids, [TemplateId(1)]);
    source
        .set_instances(&gpu, vec![Instance::new(ids[0])])
        .expect("placed");
    assert_eq!(seen(&mut source), [0]);
}

#[neurotess_testing::test(needs(gpu))]
fn poor_scenes_are_drawn_and_wrong_ones_are_errors() {
    let gpu = device();
    let camera = Camera::new(DVec3::Z * 50.0, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
    let table = ColorTable {
        scale: vec![[0; 3]],
        ..ColorTable::default()
    };
    let mut source = Exploration::new(&gpu, 1).expect("a source");
    assert!(
        ink(&picture(&gpu, &mut source, &camera, &table))
            .iter()
            .all(|&i| i == 0.0)
    );
    let none = Proxy::new(&CoarseMesh::default(), &[]);
    let soma = Proxy::new(&mesh("1 1 0 0 0 6 -1\n"), &[]);
    let free = Proxy::new(&mesh("1 3 0 0 0 1 -1\n2 3 5 0 0 1 1\n"), &[]);
    assert_eq!(
        (
            none.spheres().len(),
            soma.spheres().len(),
            free.spheres().len()
        ),
        (0, 1, 1)
    );
    let ids = source.add(&gpu, &[none, soma, free]).expect("uploaded");
    for (id, drawn) in ids.iter().zip([false, true, true]) {
        source
            .set_instances(&gpu, vec![Instance::new(*id)])
            .expect("placed");
        let found = ink(&picture(&gpu, &mut source, &camera, &table))
            .iter()
            .sum::<f64>();
        assert_eq!(found > 0.0, drawn, "{id:?}");
    }
    // Frames of no sense draw something or nothing, within the budget.
    for near in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let frame = Frame {
            near,
            ..frame(camera, 100, 100)
        };
        source.prepare(&gpu, &frame).expect("prepared");
        let stats = source.stats(&gpu).expect("counted");
        assert!(stats.triangles <= stats.budget);
    }
    let nowhere = Instance {
        placement: Placement {
            translation: DVec3::NAN,
            ..Placement::default()
        },
        ..Instance::new(ids[1])
    };
    for wrong in [nowhere, Instance::new(TemplateId(9))] {
        let refused = source.set_instances(&gpu, vec![wrong]);
        assert!(matches!(refused, Err(ExplorationError::Scene(_))));
    }
    assert_eq!(source.instances().len(), 1, "those before stay");
}

#[neurotess_testing::test(needs(gpu))]
fn a_point_takes_a_few_bytes_and_an_instance_under_128() {
    let gpu = device();
    // Eight neurites of 400 points, each a wave that forks once.
    let mut swc = String::from("1 1 0 0 0 8 -1\n");
    for i in 0..3200_u32 {
        let (neurite, k) = (i / 400, i % 400);
        let parent = match k {
            0 => 1,
            200 => i + 2 - 150,
            _ => i + 1,
        };
        let (along, fork) = (f64::from(k % 200) + 9.0, f64::from(k / 200) * 40.0);
        let angle = f64::from(neurite) * 0.785 + 0.002 * along;
        let [x, y] = [angle.cos() * along, angle.sin() * along];
        let z = (0.3 * along).sin() + fork;
        swc += &format!("{} 3 {x:.3} {y:.3} {z:.3} 0.4 {parent}\n", i + 2);
    }
    let mesh = mesh(&swc);
    let proxy = Proxy::new(&mesh, &[]);
    let (_, reach) = extent(&mesh);
    let resident = |count: usize| {
        let instances = scattered(&mut Random(1), count, 1, 4.0 * reach);
        let mut source = explored(&gpu, std::slice::from_ref(&proxy), instances);
        let camera = Camera::new(DVec3::Z * 9e3, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
        source
            .prepare(&gpu, &frame(camera, 300, 300))
            .expect("prepared");
        let bytes = source.bytes().iter().map(|(_, bytes)| bytes).sum::<u64>();
        (bytes, source.bytes_per_point())
    };
    let (few, per_point) = resident(20_000);
    let (many, _) = resident(40_000);
    let per_instance = (many - few) as f64 / 20_000.0;
    note!(
        "{per_point:.1} bytes a point of {}, {per_instance:.1} an instance",
        proxy.point_count()
    );
    assert!(per_point < 16.0, "{per_point}");
    assert!(per_instance < 128.0, "{per_instance}");
}
