//! Pictures for windows are as saved ones, however they are sliced.

use crate::adapter::{device, gpu};
use crate::pictured::{CELL, by_type, mesh};
use crate::renderer::{SIZE, difference, picks, picture, pixels, renderer, source, view};
use glam::DVec3;
use neurotess_refine::LodCriterion;
use neurotess_render::outline::Outlines;
use neurotess_render::state::OUTLINED;
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Exploration, Image, Instance, PictureOptions, Placement,
    Proxy, Scene, Steps, Templates, VertexSource, ViewParams, Viewpoint, render_still,
};

#[neurotess_testing::test(needs(gpu))]
fn a_picture_at_rest_is_as_a_saved_one() {
    let gpu = device();
    let mesh = mesh(CELL);
    let view = view(&mesh);
    let mut source = source(&gpu, &mesh, &[Placement::default()]);
    let mut renderer = renderer(&gpu, &mesh);
    let steps = Steps {
        steps: 4,
        slices: 1,
    };
    let shown = picture(&gpu, &mut renderer, &mut source, view, steps);
    let mut saved = Image::default();
    let options = PictureOptions {
        size: SIZE,
        ..PictureOptions::default()
    };
    let table = by_type(&mesh).1;
    render_still(
        &gpu,
        &mut source,
        &Viewpoint {
            camera: view.camera,
            near: view.near,
        },
        &table,
        &options,
        |_, band| {
            saved = band;
            Ok::<(), std::convert::Infallible>(())
        },
    )
    .expect("drawn");
    let empty = Image {
        pixels: vec![255; saved.pixels.len()],
        ..saved.clone()
    };
    assert!(difference(&empty, &saved) > 3.0, "something is there");
    assert!(
        difference(&shown, &saved) < 0.6,
        "{}",
        difference(&shown, &saved)
    );
}

#[neurotess_testing::test(needs(gpu))]
fn slices_change_nothing() {
    let gpu = device();
    let mesh = mesh(CELL);
    let mut source = source(&gpu, &mesh, &[Placement::default()]);
    let mut renderer = renderer(&gpu, &mesh);
    let mut with = |slices| {
        let steps = Steps { steps: 4, slices };
        picture(&gpu, &mut renderer, &mut source, view(&mesh), steps)
    };
    let whole = with(1);
    assert_eq!(difference(&whole, &with(7)), 0.0);
}

#[neurotess_testing::test(needs(gpu))]
fn a_lod_that_is_kept_changes_nothing() {
    let gpu = device();
    let mesh = mesh(CELL);
    let mut anew = source(&gpu, &mesh, &[Placement::default()]);
    let mut kept = source(&gpu, &mesh, &[Placement::default()]);
    kept.set_keeping(true);
    let mut renderer = renderer(&gpu, &mesh);
    let steps = Steps {
        steps: 4,
        slices: 3,
    };
    let mut turned = view(&mesh);
    turned.camera = turned.camera.turned(0.7);
    let coarse = AdaptiveSettings {
        lod: LodCriterion::Homogeneous(1),
        ..AdaptiveSettings::default()
    };
    let moved = Placement {
        translation: DVec3::Y * 4.0,
        ..Placement::default()
    };
    // Another view, other settings, another scene, ids between: each is noticed.
    for change in 0..4 {
        for source in [&mut anew, &mut kept] {
            match change {
                2 => source.set_settings(coarse),
                3 => {
                    let (templates, mut instances) = source.take_scene().into_parts();
                    instances[0].placement = moved;
                    source.set_scene(Scene::new(templates, instances).expect("a scene"));
                }
                _ => {}
            }
        }
        let view = if change == 0 { view(&mesh) } else { turned };
        let expected = picture(&gpu, &mut renderer, &mut anew, view, steps);
        let first = picture(&gpu, &mut renderer, &mut kept, view, steps);
        assert_eq!(difference(&expected, &first), 0.0, "change {change}");
        picks(&gpu, &mut renderer, &mut kept, &view);
        let again = picture(&gpu, &mut renderer, &mut kept, view, steps);
        assert_eq!(difference(&expected, &again), 0.0, "change {change}");
    }
}

#[neurotess_testing::test(needs(gpu))]
fn a_draft_shows_the_same_cell() {
    let gpu = device();
    let mesh = mesh(CELL);
    let mut source = source(&gpu, &mesh, &[Placement::default()]);
    let mut renderer = renderer(&gpu, &mesh);
    let fine = picture(
        &gpu,
        &mut renderer,
        &mut source,
        view(&mesh),
        Steps {
            steps: 4,
            slices: 1,
        },
    );
    renderer
        .draft(&gpu, &mut source, &view(&mesh))
        .expect("drawn");
    assert!(renderer.shows_draft() && renderer.progress().is_none());
    let apart = difference(&fine, &pixels(&gpu, &renderer));
    assert!(apart > 0.0 && apart < 3.0, "{apart}");
}

/// Number of pixels that are nearly of a color, left and right of the middle.
fn of_color(image: &Image, color: [u8; 3]) -> [usize; 2] {
    let near = |p: &[u8]| (0..3).all(|k| p[k].abs_diff(color[k]) < 40);
    let mut counts = [0; 2];
    for (i, pixel) in image.pixels.chunks(4).enumerate() {
        let right = i % image.width as usize >= image.width as usize / 2;
        counts[usize::from(right)] += usize::from(near(pixel));
    }
    counts
}

#[neurotess_testing::test(needs(gpu))]
fn drafts_have_outlines_round_what_is_outlined() {
    let gpu = device();
    let mesh = mesh(CELL);
    let aside = |x: f64| Placement {
        translation: DVec3::X * x,
        scale: 0.4,
        ..Placement::default()
    };
    // The picture's middle is at -9 µm.
    let both = [aside(-23.0), aside(5.0)];
    let mut refined = source(&gpu, &mesh, &both);
    let (color_keys, _) = by_type(&mesh);
    let mut explored = Exploration::new(&gpu, 1).expect("a source");
    let ids = explored
        .add(&gpu, &[Proxy::new(&mesh, &color_keys)])
        .expect("added");
    let instance = |&placement: &Placement| Instance {
        placement,
        ..Instance::new(ids[0])
    };
    explored
        .set_instances(&gpu, both.iter().map(instance).collect())
        .expect("placed");
    let orange = [255, 140, 0];
    let outlines = Outlines {
        width: 1,
        selected: orange,
        ..Outlines::default()
    };
    let sources: [&mut dyn VertexSource; 2] = [&mut refined, &mut explored];
    for (which, source) in sources.into_iter().enumerate() {
        let mut renderer = renderer(&gpu, &mesh);
        renderer.set_outlines(&gpu, outlines, None);
        let mut drawn = |states: [u32; 2]| {
            renderer.set_states(states.to_vec());
            renderer.draft(&gpu, source, &view(&mesh)).expect("drawn");
            of_color(&pixels(&gpu, &renderer), orange)
        };
        assert_eq!(drawn([0, 0]), [0, 0], "source {which}");
        let [left, right] = drawn([0, OUTLINED]);
        assert!(left == 0 && right > 100, "source {which}: {left} {right}");
        let [left, right] = drawn([OUTLINED, 0]);
        assert!(left > 100 && right == 0, "source {which}: {left} {right}");
    }
}

#[neurotess_testing::test(needs(gpu))]
fn levels_frozen_for_the_same_camera_change_nothing() {
    let gpu = device();
    let mesh = mesh(CELL);
    let mut source = source(&gpu, &mesh, &[Placement::default()]);
    let mut renderer = renderer(&gpu, &mesh);
    let view = view(&mesh);
    let steps = Steps {
        steps: 1,
        slices: 1,
    };
    let free = picture(&gpu, &mut renderer, &mut source, view, steps);
    let turned = ViewParams {
        camera: view.camera.turned(0.5),
        ..view
    };
    let other = picture(&gpu, &mut renderer, &mut source, turned, steps);
    let frozen = ViewParams {
        frozen: Some((view.camera.turned(0.5), view.near)),
        ..view
    };
    let frozen = picture(&gpu, &mut renderer, &mut source, frozen, steps);
    assert!(difference(&free, &other) > 2.0);
    assert!(
        difference(&free, &frozen) < 0.6,
        "{}",
        difference(&free, &frozen)
    );
}

#[neurotess_testing::test(needs(gpu))]
fn nothing_is_drawn_of_an_empty_scene() {
    let gpu = device();
    let scene = Scene::new(Templates::new(), Vec::new()).expect("empty");
    let mut source = Adaptive::new(&gpu, scene, AdaptiveSettings::default(), 1).expect("a source");
    let mesh = mesh(CELL);
    let mut renderer = renderer(&gpu, &mesh);
    let camera = Camera::new(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.5).expect("a camera");
    let view = ViewParams {
        camera,
        near: 0.1,
        size: [1, 1],
        ..view(&mesh)
    };
    let shown = picture(
        &gpu,
        &mut renderer,
        &mut source,
        view,
        Steps {
            steps: 16,
            slices: 4,
        },
    );
    assert_eq!(shown.pixels, [255; 4]);
}
