//! Nothing pops: when the camera moves, the picture changes as that of the finest surface does.
//!
//! Levels are whole numbers and jump. What a jump moves on the screen is bounded by the error that
//! was asked for, half a pixel by default: less than what shows. So there is neither hysteresis nor
//! morphing, and a picture depends on its camera alone. Here a camera moves slowly, and what
//! changes from frame to frame is compared with what changes on the level-64 surface.

use crate::adapter::{device, gpu};
use crate::common::smooth_cell;
use glam::DVec3;
use neurotess_refine::LodCriterion;
use neurotess_render::color::ColorTable;
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Gpu, Image, Instance, Occlusion, PictureOptions, Scene,
    Template, Templates, Viewpoint, render_still,
};
use neurotess_testing::note;

const FRAMES: usize = 10;

fn frames(gpu: &Gpu, source: &mut Adaptive) -> Vec<Image> {
    let options = PictureOptions {
        size: [200, 150],
        samples: 16,
        occlusion: Occlusion::Off,
        ..PictureOptions::default()
    };
    let table = ColorTable {
        scale: vec![[200, 60, 30]],
        ..ColorTable::default()
    };
    let frame = |i: usize| {
        // Towards the soma, a thousandth nearer in every frame, and a little around it.
        let t = i as f64;
        let distance = 60.0 * 0.999_f64.powf(t);
        let eye = DVec3::new((0.0005 * t).sin(), 0.3, (0.0005 * t).cos()) * distance;
        let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, 0.7).expect("a camera");
        let mut whole = Image::default();
        render_still(
            gpu,
            source,
            &Viewpoint { camera, near: 1.0 },
            &table,
            &options,
            |_, band| {
                whole = band;
                Ok::<(), std::convert::Infallible>(())
            },
        )
        .expect("drawn");
        whole
    };
    (0..FRAMES).map(frame).collect()
}

/// Mean change of a drawn pixel's bytes from each frame to the next.
fn changes(frames: &[Image]) -> Vec<f64> {
    let change = |pair: &[Image]| {
        let pairs = pair[0].pixels.iter().zip(&pair[1].pixels);
        let sum: u64 = pairs.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        sum as f64 / pair[0].pixels.iter().filter(|&&byte| byte != 255).count() as f64
    };
    frames.windows(2).map(change).collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_slow_camera_sees_no_level_change() {
    let gpu = device();
    let mesh = smooth_cell(3);
    let mut templates = Templates::new();
    let template = Template {
        mesh: &mesh,
        color_keys: &[],
        values: &[],
    };
    let ids = templates.add(&gpu, &[template]).expect("uploaded");
    let scene = Scene::new(templates, vec![Instance::new(ids[0])]).expect("a scene");
    let mut source = Adaptive::new(&gpu, scene, AdaptiveSettings::default(), 1).expect("a source");
    let mut sequence = |lod| {
        source.set_settings(AdaptiveSettings {
            lod,
            ..AdaptiveSettings::default()
        });
        frames(&gpu, &mut source)
    };
    let reference = sequence(LodCriterion::Homogeneous(32));
    let reference = changes(&reference);
    // Mean and greatest ratio.
    let ratios = |lod| {
        let changes = changes(&sequence(lod));
        note!("{lod:?}: {changes:.3?}");
        let pairs = changes.iter().zip(&reference);
        let ratios: Vec<f64> = pairs.map(|(found, expected)| found / expected).collect();
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        (mean, ratios.into_iter().fold(0.0, f64::max))
    };
    note!("level 32: {reference:.3?}");
    let [(half, worst), (coarse, most)] = [0.5, 8.0].map(LodCriterion::PixelError).map(ratios);
    note!("{half} {worst}, {coarse} {most}");
    // The greatest of eight such cells, on lavapipe, is 1.036 to 1.099; with the rings beside branches as
    // vertices 1.036 to 1.093. For one of them it hangs on the last bits, the mean does not.
    assert!(worst < 1.12, "{worst}");
    // Where the error may be eight pixels, the measure sees popping.
    assert!(half < 1.03, "{half}");
    assert!(coarse - 1.0 > 2.0 * (half - 1.0), "{coarse} {half}");
}
