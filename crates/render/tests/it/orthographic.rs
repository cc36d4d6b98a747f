//! Without perspective nothing depends on depth: neither sizes nor light, whatever draws it.

use std::convert::Infallible;

use crate::adapter::{device, gpu};
use crate::pictured::{CELL, by_type, mesh, one_template, spheres};
use glam::DVec3;
use neurotess_mesh::CoarseMesh;
use neurotess_refine::{LodCriterion, RefineOptions};
use neurotess_render::color::{ColorTable, category};
use neurotess_render::overlay::{Overlay, OverlayOptions};
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Combined, DEFAULT_FOV, Exploration, Gpu, Image, Instance,
    Lens, Marker, MarkerSettings, Markers, Occlusion, PictureOptions, Placement, Prerefined,
    PrerefinedSurface, Proxy, Scene, Side, VertexSource, Viewpoint, render_still,
};
use neurotess_testing::note;

const SIZE: [u32; 2] = [240, 320];

fn options(occlusion: Occlusion) -> PictureOptions {
    PictureOptions {
        size: SIZE,
        samples: 4,
        occlusion,
        ..PictureOptions::default()
    }
}

fn drawn(
    gpu: &Gpu,
    source: &mut dyn VertexSource,
    camera: &Camera,
    table: &ColorTable,
    occlusion: Occlusion,
) -> Image {
    let mut whole = Image::new(SIZE[0], SIZE[1]);
    let view = Viewpoint {
        camera: *camera,
        near: camera.near(&[(DVec3::ZERO, 2000.0)]),
    };
    let taken = |top: u32, band: Image| {
        whole.lay(0, i64::from(top), &band);
        Ok::<(), Infallible>(())
    };
    render_still(gpu, source, &view, table, &options(occlusion), taken).expect("drawn");
    whole
}

fn fitted(mesh: &CoarseMesh) -> Camera {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let lens = Lens::orthographic(DEFAULT_FOV);
    Camera::fit(Side::Front, lens, aspect, 0.05, &spheres(mesh)).expect("fits")
}

/// The camera, moved along its direction of view.
fn moved(camera: &Camera, backward: f64) -> Camera {
    let [_, up, axis] = camera.axes();
    let by = axis * backward;
    Camera::new(camera.eye() + by, camera.target() + by, up, camera.lens()).expect("a camera")
}

/// Every source of a mesh at some placements; exploration in full detail.
fn sources(gpu: &Gpu, mesh: &CoarseMesh) -> Vec<(&'static str, Box<dyn VertexSource>)> {
    let (color_keys, _) = by_type(mesh);
    let (templates, id) = one_template(gpu, mesh);
    let scene = Scene::new(templates, vec![Instance::new(id)]).expect("a scene");
    let settings = AdaptiveSettings {
        lod: LodCriterion::PixelError(0.25),
        ..AdaptiveSettings::default()
    };
    let adaptive = Adaptive::new(gpu, scene, settings, 1).expect("a source");
    let surface = PrerefinedSurface {
        mesh,
        color_keys: &color_keys,
    };
    let options = RefineOptions::default();
    let lod = |_: usize| LodCriterion::Homogeneous(4).into();
    let prerefined = Prerefined::new(gpu, &[surface], lod, &options, false).expect("uploaded");
    let mut explored = Exploration::new(gpu, 1).expect("a source");
    let proxies = [Proxy::new(mesh, &color_keys)];
    let ids = explored.add(gpu, &proxies).expect("uploaded");
    let instances = vec![Instance::new(ids[0])];
    explored.set_instances(gpu, instances).expect("placed");
    vec![
        ("adaptive", Box::new(adaptive)),
        ("prerefined", Box::new(prerefined)),
        ("exploration", Box::new(explored)),
    ]
}

/// Number of bytes that differ by more than `step`.
fn differing(a: &Image, b: &Image, step: u8) -> usize {
    let pairs = a.pixels.iter().zip(&b.pixels);
    pairs.filter(|(a, b)| a.abs_diff(**b) > step).count()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn depth_changes_nothing_in_a_picture() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (_, table) = by_type(&mesh);
    let camera = fitted(&mesh);
    for (name, source) in &mut sources(&gpu, &mesh) {
        for occlusion in [Occlusion::Off, Occlusion::Within(6.0)] {
            let here = drawn(&gpu, source.as_mut(), &camera, &table, occlusion);
            let ink = here.pixels.iter().filter(|&&byte| byte < 200).count();
            assert!(ink > 3000, "{name}: {ink}");
            // Also with the eye within the cell, and behind it.
            for by in [500.0, -camera.eye().distance(camera.target()), -900.0] {
                let there = moved(&camera, by);
                let there = drawn(&gpu, source.as_mut(), &there, &table, occlusion);
                // Positions relative to the eye are rounded elsewhere.
                let count = differing(&here, &there, 24);
                note!("{name} moved by {by}: {count} of {ink} bytes differ");
                assert!(count * 200 < ink, "{name} by {by}: {count} of {ink}");
            }
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn sources_agree_on_sizes() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (_, table) = by_type(&mesh);
    let camera = fitted(&mesh);
    let pictures: Vec<Image> = sources(&gpu, &mesh)
        .iter_mut()
        .map(|(_, source)| drawn(&gpu, source.as_mut(), &camera, &table, Occlusion::Off))
        .collect();
    let ink = |image: &Image| -> f64 { image.pixels.iter().map(|&b| 255.0 - f64::from(b)).sum() };
    let stored = ink(&pictures[1]);
    for other in [&pictures[0], &pictures[2]] {
        let share = ink(other) / stored;
        assert!((share - 1.0).abs() < 0.03, "{share}");
    }
    // Of a soma of 5 µm, drawn where it was traced.
    let pixel = camera.pixel_at_target(f64::from(SIZE[1]));
    let [x, y] = camera.pixel_of(DVec3::ZERO, SIZE).expect("in the picture");
    for image in &pictures {
        let dark = |d: f64| image.at((x + d / pixel) as u32, y as u32)[0] < 128;
        assert!(dark(0.0) && dark(4.0) && !dark(9.0));
    }
}

/// Width (pixels) of what has a color in a picture.
fn width_of(image: &Image, color: [u8; 3]) -> u32 {
    let close = |x: u32, y: u32| {
        let pixel = image.at(x, y);
        (0..3).all(|k| pixel[k].abs_diff(color[k]) < 70)
    };
    let columns = (0..image.width).filter(|&x| (0..image.height).any(|y| close(x, y)));
    columns.count() as u32
}

#[neurotess_testing::test(needs(gpu))]
fn spheres_and_tubes_have_one_size_and_the_scale_bar_is_theirs() {
    let gpu = device();
    let cell = mesh(CELL);
    let (_, mut table) = by_type(&cell);
    let key = table.categories.len() as u32;
    let colors = [[255, 0, 255], [0, 255, 0]];
    table.categories.extend(colors);
    let camera = fitted(&cell);
    let [right, up, backward] = camera.axes();
    let pixel = camera.pixel_at_target(f64::from(SIZE[1]));
    assert!((pixel * f64::from(SIZE[1]) - camera.height()).abs() < 1e-9);
    // 20 µm between the two, of which one is 700 µm nearer; and a pair smaller than a pixel.
    let length = 20.0;
    let place = |side: f64, depth: f64| {
        camera.target() + right * side * length / 2.0 + up * 20.0 + backward * depth
    };
    let marker = |i: u32| Marker {
        position: place(
            if i == 0 { -1.0 } else { 1.0 },
            if i == 0 { -300.0 } else { 400.0 },
        ),
        color_key: category(key + i),
        ..Marker::default()
    };
    let none: &mut dyn VertexSource = &mut Exploration::new(&gpu, 1).expect("a source");
    for (radius, expected) in [(5.0, 10.0 / pixel), (1e-3, 8.0)] {
        let settings = MarkerSettings {
            radius,
            least: 4.0,
            ..MarkerSettings::default()
        };
        let all = [marker(0), marker(1)];
        let mut markers = Markers::new(&gpu, &all, settings).expect("uploaded");
        let mut source = Combined::new(none).with_markers(Some(&mut markers));
        let image = drawn(&gpu, &mut source, &camera, &table, Occlusion::Off);
        let widths = colors.map(|color| f64::from(width_of(&image, color)));
        note!("radius {radius}: {widths:?} pixels, {expected} expected");
        assert!((widths[0] - widths[1]).abs() <= 1.0, "{widths:?}");
        assert!((widths[0] - expected).abs() < 2.5, "{widths:?} {expected}");
    }
    let [a, b] = [0, 1].map(|i| camera.pixel_of(marker(i).position, SIZE).expect("seen"));
    let apart = (a[0] - b[0]).hypot(a[1] - b[1]);
    let overlay = OverlayOptions {
        legend: None,
        scale_bar: Some(length),
        axes: false,
        background: Some([255; 3]),
    };
    let mut paper = Image::new(SIZE[0], SIZE[1]);
    paper.pixels.fill(255);
    Overlay::new(&overlay, SIZE, &[camera], &[]).lay_on(0, &mut paper);
    let dark = |y: u32| {
        let row = (0..SIZE[0]).map(|x| f64::from(255 - paper.at(x, y)[0]) / 235.0);
        row.sum::<f64>()
    };
    let bar = (0..SIZE[1]).map(dark).fold(0.0, f64::max);
    assert!((bar - apart).abs() < 0.1, "{bar} pixels, {apart} apart");

    // A straight neurite: its copy 600 µm farther and 200 pixels lower is as wide, and one thinner than
    // a pixel as dark.
    let lens = Lens::orthographic(0.6);
    let camera = Camera::new(DVec3::Z * 100.0, DVec3::ZERO, DVec3::Y, lens).expect("a camera");
    let pixel = camera.pixel_at_target(f64::from(SIZE[1]));
    for (radius, least) in [(3.0, 1000.0), (0.02, 20.0)] {
        let rows = (0..8).map(|i| {
            let parent = if i == 0 { -1 } else { i };
            format!("{} 2 {} 0 0 {radius} {parent}\n", i + 1, 6 * i - 21)
        });
        let tube = mesh(&rows.collect::<String>());
        let (color_keys, table) = by_type(&tube);
        let mut explored = Exploration::new(&gpu, 1).expect("a source");
        let proxies = [Proxy::new(&tube, &color_keys)];
        let ids = explored.add(&gpu, &proxies).expect("uploaded");
        let (templates, template) = one_template(&gpu, &tube);
        let copies = |id| {
            [(100.3, 300.0), (-99.7, -300.0)].map(|(y, z)| Instance {
                placement: Placement {
                    translation: DVec3::new(0.0, y * pixel, z),
                    ..Placement::default()
                },
                ..Instance::new(id)
            })
        };
        let instances = copies(ids[0]).to_vec();
        explored.set_instances(&gpu, instances).expect("placed");
        let scene = Scene::new(templates, copies(template).to_vec()).expect("a scene");
        let settings = AdaptiveSettings::default();
        let adaptive = Adaptive::new(&gpu, scene, settings, 1).expect("a source");
        let both: [Box<dyn VertexSource>; 2] = [Box::new(explored), Box::new(adaptive)];
        for mut source in both {
            let image = drawn(&gpu, source.as_mut(), &camera, &table, Occlusion::Off);
            let half = |rows: std::ops::Range<u32>| -> f64 {
                let row = |y| (0..SIZE[0]).map(move |x| (x, y));
                let ink = |(x, y)| 1.0 - f64::from(image.at(x, y)[0]) / 255.0;
                rows.flat_map(row).map(ink).sum()
            };
            let (near, far) = (half(0..SIZE[1] / 2), half(SIZE[1] / 2..SIZE[1]));
            note!("radius {radius}: {near:.2} and {far:.2} pixels of ink");
            assert!(
                near > least && (near / far - 1.0).abs() < 0.01,
                "{near} {far}"
            );
        }
    }
}
