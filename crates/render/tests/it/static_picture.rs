//! Static pictures: colored anew they equal pictures that are drawn anew.

use std::convert::Infallible;

use crate::adapter::{device, gpu};
use crate::pictured::{CELL, camera, mesh};
use glam::{DQuat, DVec3};
use neurotess_mesh::CoarseMesh;
use neurotess_refine::LodCriterion;
use neurotess_render::color::{ColorMap, ColorTable, InstanceValues, category, fraction};
use neurotess_render::state::{GHOSTED, HIGHLIGHTED};
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Clip, Exploration, Gpu, Image, Instance, KeyColors, Light,
    Look, Occlusion, PictureOptions, Placement, ProgressiveRenderer, Proxy, Scene, StaticError,
    Steps, StillRenderer, Template, TemplateId, Templates, VertexSource, ViewParams, Viewpoint,
};
use neurotess_testing::note;

const SIZE: [u32; 2] = [320, 240];

/// Three cells, one behind the other and turned.
fn instances() -> Vec<Instance> {
    let instance = |i: u32| Instance {
        placement: Placement {
            rotation: DQuat::from_rotation_y(f64::from(i)),
            translation: DVec3::new(9.0, 5.0, -30.0) * f64::from(i),
            ..Placement::default()
        },
        ..Instance::new(TemplateId(0))
    };
    (0..3).map(instance).collect()
}

fn adaptive(gpu: &Gpu, mesh: &CoarseMesh, color_keys: &[u32], lod: LodCriterion) -> Adaptive {
    let mut templates = Templates::new();
    let template = Template {
        mesh,
        color_keys,
        values: &[],
    };
    templates.add(gpu, &[template]).expect("uploaded");
    let scene = Scene::new(templates, instances()).expect("a scene");
    let settings = AdaptiveSettings {
        lod,
        ..AdaptiveSettings::default()
    };
    Adaptive::new(gpu, scene, settings, 2).expect("a source")
}

fn budgeted(gpu: &Gpu, mesh: &CoarseMesh, color_keys: &[u32], budget: u32) -> Exploration {
    let mut source = Exploration::new(gpu, 2).expect("a source");
    source.set_budget(budget);
    source
        .add(gpu, &[Proxy::new(mesh, color_keys)])
        .expect("uploaded");
    source.set_instances(gpu, instances()).expect("placed");
    source
}

/// Every second tracing point, by index.
fn by_value(mesh: &CoarseMesh) -> Vec<u32> {
    (0..mesh.tracing.len() as u32).collect()
}

/// Fractions of a scale by height; the soma has a category.
fn by_height(mesh: &CoarseMesh) -> Vec<u32> {
    let heights = mesh.tracing.iter().map(|point| point.center.y);
    heights
        .map(|y| match y.abs() < 4.0 {
            true => category(0),
            false => fraction((y + 45.0) / 90.0),
        })
        .collect()
}

fn table(map: ColorMap, shift: f32, values: bool, count: usize) -> ColorTable {
    let mut table = ColorTable {
        scale: map.scale(),
        categories: vec![[60, 60, 64], [200, 30, 90]],
        values: InstanceValues::default(),
    };
    if values {
        for instance in 0..3 {
            let value = |k: usize| (0.37 * k as f32 + shift + 0.2 * instance as f32).fract();
            let mut all: Vec<f32> = (0..count).map(value).collect();
            all[0] = f32::NAN;
            table.values.push(&all);
        }
    }
    table
}

fn drawn(
    gpu: &Gpu,
    renderer: &mut StillRenderer,
    source: &mut dyn VertexSource,
    view: &Viewpoint,
    table: &ColorTable,
    options: &PictureOptions,
) -> Image {
    let mut whole = Image::new(options.size[0], 0);
    renderer
        .render(gpu, source, view, table, options, |_, band| {
            whole.height += band.height;
            whole.pixels.extend(band.pixels);
            Ok::<(), Infallible>(())
        })
        .expect("drawn");
    whole
}

/// What one sample of 16, the fewest that a pixel has here, can change of it (of 255): one on the edge between two faces
/// belongs to either. Seen where a plane cuts a cell: 5, in one of 384,000 pixels.
const ONE_SAMPLE: u8 = 255 / 16;

/// At most 1 of 255 in all but one pixel of 10,000, and one sample's worth there; told with the numbers.
fn assert_equal(what: &str, expected: &Image, found: &Image) {
    assert_eq!(
        (expected.width, expected.height),
        (found.width, found.height)
    );
    let pixels = expected.pixels.chunks(4).zip(found.pixels.chunks(4));
    let differences: Vec<u8> = pixels
        .map(|(a, b)| {
            a.iter()
                .zip(b)
                .map(|(a, b)| a.abs_diff(*b))
                .max()
                .unwrap_or(0)
        })
        .collect();
    let worst = differences.iter().copied().max().unwrap_or(0);
    let above = differences.iter().filter(|&&d| d > 1).count();
    let covered = expected
        .pixels
        .chunks(4)
        .filter(|p| *p != [255; 4] && *p != [0; 4])
        .count();
    note!("{what}: {covered} pixels, {above} differ by more than 1, worst {worst}");
    assert!(covered > 500, "{what}: hardly anything shows");
    assert!(worst <= ONE_SAMPLE, "{what}: {worst} of 255");
    assert!(
        above * 10_000 <= differences.len(),
        "{what}: {above} pixels differ"
    );
}

/// Makes a static picture with one table, colors it with another, and draws that anew.
fn check(
    gpu: &Gpu,
    what: &str,
    source: &mut dyn VertexSource,
    view: &Viewpoint,
    tables: [&ColorTable; 2],
    options: &PictureOptions,
    states: &[u32],
) {
    let mut renderer = StillRenderer::new();
    renderer.set_states(states);
    let made = renderer
        .render_static(gpu, source, view, tables[0], options)
        .expect("made");
    for table in tables {
        let colors = KeyColors {
            table,
            states,
            values: None,
        };
        made.recolor(gpu, &colors).expect("colored");
        let found = made.image(gpu).expect("read");
        let expected = drawn(gpu, &mut renderer, source, view, table, options);
        assert_equal(what, &expected, &found);
    }
}

fn view(camera: Camera) -> Viewpoint {
    Viewpoint { camera, near: 0.1 }
}

fn options() -> PictureOptions {
    PictureOptions {
        size: SIZE,
        look: Look {
            contrast: Some([255; 3]),
            ..Look::default()
        },
        ..PictureOptions::default()
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn recordings_and_color_maps_are_as_if_drawn_anew() {
    let gpu = device();
    let mesh = mesh(CELL);
    let view = view(camera(&mesh, SIZE));
    let count = mesh.tracing.len();
    let values = [0.1, 0.6].map(|shift| table(ColorMap::Viridis, shift, true, count));
    let maps = [ColorMap::Viridis, ColorMap::Plasma].map(|map| table(map, 0.0, false, 0));
    for (name, keys, tables) in [
        ("values", by_value(&mesh), &values),
        ("heights", by_height(&mesh), &maps),
    ] {
        let tables = [&tables[0], &tables[1]];
        for lod in [LodCriterion::Homogeneous(1), LodCriterion::PixelError(0.5)] {
            let mut source = adaptive(&gpu, &mesh, &keys, lod);
            let what = format!("{name}, {lod:?}");
            check(&gpu, &what, &mut source, &view, tables, &options(), &[]);
        }
        for budget in [60, 100_000] {
            let mut source = budgeted(&gpu, &mesh, &keys, budget);
            let what = format!("{name}, budget {budget}");
            check(&gpu, &what, &mut source, &view, tables, &options(), &[]);
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn states_cuts_lights_and_backgrounds_are_as_if_drawn_anew() {
    let gpu = device();
    let mesh = mesh(CELL);
    let view = view(camera(&mesh, SIZE));
    let keys = by_value(&mesh);
    let tables = [0.1, 0.6].map(|shift| table(ColorMap::Magma, shift, true, keys.len()));
    let tables = [&tables[0], &tables[1]];
    let mut source = adaptive(&gpu, &mesh, &keys, LodCriterion::PixelError(0.5));
    let states = [HIGHLIGHTED, 0, GHOSTED];
    let highlighted = PictureOptions {
        look: Look {
            highlighted: ([255, 160, 0], 0.5),
            ..options().look
        },
        ..options()
    };
    check(
        &gpu,
        "states",
        &mut source,
        &view,
        tables,
        &highlighted,
        &states,
    );
    let cut = PictureOptions {
        look: Look {
            clip: Some(Clip {
                point: DVec3::ZERO,
                normal: DVec3::new(0.2, 0.1, -1.0).normalize_or(DVec3::Z),
            }),
            ..options().look
        },
        ..options()
    };
    check(&gpu, "cut", &mut source, &view, tables, &cut, &[]);
    let flat = PictureOptions {
        look: Look {
            light: Light::Flat,
            ..options().look
        },
        ..options()
    };
    check(&gpu, "no light", &mut source, &view, tables, &flat, &[]);
    let transparent = PictureOptions {
        background: None,
        samples: 36,
        look: Look::default(),
        ..options()
    };
    check(
        &gpu,
        "transparent",
        &mut source,
        &view,
        tables,
        &transparent,
        &[],
    );
}

#[neurotess_testing::test(needs(gpu))]
fn tiles_fit_together() {
    let gpu = device();
    let mesh = mesh(CELL);
    let view = view(camera(&mesh, SIZE));
    let keys = by_value(&mesh);
    let tables = [0.1, 0.6].map(|shift| table(ColorMap::Viridis, shift, true, keys.len()));
    let mut source = adaptive(&gpu, &mesh, &keys, LodCriterion::PixelError(0.5));
    let small = PictureOptions {
        tile: 300,
        ..options()
    };
    let tables = [&tables[0], &tables[1]];
    check(&gpu, "tiles", &mut source, &view, tables, &small, &[]);
}

#[neurotess_testing::test(needs(gpu))]
fn only_what_shows_has_keys_and_values_for_them_are_enough() {
    let gpu = device();
    let mesh = mesh(CELL);
    let view = view(camera(&mesh, SIZE));
    let keys = by_value(&mesh);
    let full = table(ColorMap::Viridis, 0.3, true, keys.len());
    let mut source = adaptive(&gpu, &mesh, &keys, LodCriterion::PixelError(0.5));
    let mut renderer = StillRenderer::new();
    let made = renderer
        .render_static(&gpu, &mut source, &view, &full, &options())
        .expect("made");
    assert!(made.keys().windows(2).all(|pair| pair[0] < pair[1]));
    assert!(made.keys().iter().all(|key| key.instance < 3));
    assert!(made.keys().len() <= 3 * keys.len());
    let values: Vec<f32> = made
        .keys()
        .iter()
        .map(|key| match key.color_key {
            0 => f32::NAN,
            k => (0.37 * k as f32 + 0.3 + 0.2 * key.instance as f32).fract(),
        })
        .collect();
    let bare = table(ColorMap::Viridis, 0.0, false, 0);
    let by_key = KeyColors {
        table: &bare,
        states: &[],
        values: Some(&values),
    };
    made.recolor(&gpu, &by_key).expect("colored");
    let found = made.image(&gpu).expect("read");
    let expected = drawn(&gpu, &mut renderer, &mut source, &view, &full, &options());
    assert_equal("values by key", &expected, &found);
}

/// A view of a window that is higher than a band.
fn window(camera: Camera) -> ViewParams {
    ViewParams {
        camera,
        near: 0.1,
        size: [640, 600],
        look: options().look,
        occlusion: Occlusion::Fit,
        background: [255; 3],
        frozen: None,
    }
}

const STEPS: Steps = Steps {
    steps: 4,
    slices: 2,
};

/// Makes the static picture of a window's view, with a draft after each part.
fn make_static(
    gpu: &Gpu,
    renderer: &mut ProgressiveRenderer,
    source: &mut Adaptive,
    params: &ViewParams,
) {
    let begun = renderer.begin_static(gpu, source, params, STEPS);
    assert!(begun.expect("begun"));
    let mut parts = 0;
    while !renderer.static_slice(gpu, source).expect("made") {
        gpu.wait().expect("done");
        renderer.draft(gpu, source, params).expect("drawn");
        assert!(renderer.shows_draft());
        parts += 1;
    }
    assert!(parts >= 8, "two bands of four steps: {parts}");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_window_recolors_its_picture_as_if_it_drew_it_anew() {
    let gpu = device();
    let mesh = mesh(CELL);
    let keys = by_value(&mesh);
    let tables = [0.1, 0.6].map(|shift| table(ColorMap::Viridis, shift, true, keys.len()));
    let mut source = adaptive(&gpu, &mesh, &keys, LodCriterion::PixelError(0.5));
    let whole = window(camera(&mesh, [640, 600]));
    let cut = ViewParams {
        occlusion: Occlusion::Off,
        look: Look {
            clip: Some(Clip {
                point: DVec3::ZERO,
                normal: DVec3::new(0.2, 0.1, -1.0).normalize_or(DVec3::Z),
            }),
            ..whole.look
        },
        ..whole
    };
    for (what, params) in [("window", whole), ("cut in a window", cut)] {
        let mut renderer = ProgressiveRenderer::new(&gpu);
        renderer.set_colors(tables[0].clone());
        // Without a picture before, and after one.
        make_static(&gpu, &mut renderer, &mut source, &params);
        let none = renderer.static_picture().expect("made").bytes();
        let first = crate::renderer::picture(&gpu, &mut renderer, &mut source, params, STEPS);
        make_static(&gpu, &mut renderer, &mut source, &params);
        assert_eq!(renderer.static_picture().expect("made").bytes(), none);
        for (table, states) in [
            (&tables[1], vec![]),
            (&tables[0], vec![HIGHLIGHTED, 0, 0]),
            (&tables[0], vec![]),
        ] {
            renderer.set_colors(table.clone());
            renderer.set_states(states.clone());
            renderer.recolor(&gpu, None).expect("colored");
            assert!(!renderer.shows_draft());
            let found = crate::renderer::pixels(&gpu, &renderer);
            let mut other = ProgressiveRenderer::new(&gpu);
            other.set_colors(table.clone());
            other.set_states(states);
            let expected = crate::renderer::picture(&gpu, &mut other, &mut source, params, STEPS);
            assert_equal(what, &expected, &found);
        }
        let last = crate::renderer::pixels(&gpu, &renderer);
        assert_equal("as it was", &first, &last);
    }
}

#[neurotess_testing::test(needs(gpu))]
fn a_window_draws_anew_what_cannot_be_recolored() {
    let gpu = device();
    let mesh = mesh(CELL);
    let keys = by_value(&mesh);
    let mut source = adaptive(&gpu, &mesh, &keys, LodCriterion::PixelError(0.5));
    let mut renderer = ProgressiveRenderer::new(&gpu);
    let whole = window(camera(&mesh, [640, 600]));
    let mut wires = whole;
    wires.look.wire = 1.0;
    let frozen = ViewParams {
        frozen: Some((whole.camera, whole.near)),
        ..whole
    };
    for params in [wires, frozen] {
        let begun = renderer.begin_static(&gpu, &source, &params, STEPS);
        assert!(!begun.expect("no fault"));
        assert!(renderer.static_progress().is_none());
    }
    assert!(
        renderer
            .begin_static(&gpu, &source, &whole, STEPS)
            .expect("begun")
    );
    renderer.static_slice(&gpu, &mut source).expect("drawn");
    // Another picture: what was made is of no use.
    renderer.begin(whole, STEPS);
    assert!(renderer.static_progress().is_none() && renderer.static_picture().is_none());
    renderer.recolor(&gpu, None).expect("nothing to color");
}

#[neurotess_testing::test(needs(gpu))]
fn what_shows_nothing_is_the_background_and_wireframes_are_refused() {
    let gpu = device();
    let mesh = mesh(CELL);
    let away = Camera::new(DVec3::Z * 500.0, DVec3::Z * 900.0, DVec3::Y, 0.6).expect("a camera");
    let keys = by_value(&mesh);
    let table = table(ColorMap::Viridis, 0.3, false, 0);
    let mut source = adaptive(&gpu, &mesh, &keys, LodCriterion::Homogeneous(1));
    let mut renderer = StillRenderer::new();
    let made = renderer
        .render_static(&gpu, &mut source, &view(away), &table, &options())
        .expect("made");
    let colors = KeyColors {
        table: &table,
        states: &[],
        values: None,
    };
    made.recolor(&gpu, &colors).expect("colored");
    assert!(made.keys().is_empty());
    assert!(
        made.image(&gpu)
            .expect("read")
            .pixels
            .iter()
            .all(|&byte| byte == 255)
    );
    let wires = PictureOptions {
        look: Look {
            wire: 1.0,
            ..Look::default()
        },
        ..options()
    };
    let refused = renderer.render_static(&gpu, &mut source, &view(away), &table, &wires);
    assert!(matches!(refused, Err(StaticError::Wireframe)));
}
