//! Pictures that must stay as they are, unless somebody looked at them.
//!
//! `NEUROTESS_GOLDEN=renew cargo test -p neurotess-render --test golden` (or `cargo xtask pictures
//! --golden`) writes them anew. Where one fails, `before`, `after` and `difference` are written to
//! the folder that the failure names.
//!
//! **Tolerance.** Drivers place samples and round differently, so pictures are compared as an eye
//! does: blurred over 3 × 3 pixels, at most 1 of 255 apart in the mean and at most one pixel in 200
//! more than 16 apart.

mod adapter;
mod pictured;

use std::fs;
use std::path::{Path, PathBuf};

use adapter::{device, gpu};
use glam::DVec3;
use neurotess_mesh::CoarseMesh;
use neurotess_render::color::{ColorMap, fraction};
use neurotess_render::overlay::{Legend, Overlay, OverlayOptions};
use neurotess_render::{Camera, Image, Light, Look, Occlusion, PictureOptions, PngWriter, Side};
use pictured::{explored, mesh, picture, picture_of, spheres};

/// Greatest mean difference of blurred channels, of 255.
const MEAN: f64 = 1.0;
/// Difference of a blurred channel that counts, of 255.
const MUCH: f64 = 16.0;
/// Greatest share of pixels that differ by so much.
const SHARE: f64 = 0.005;

fn sample(name: &str) -> CoarseMesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../samples")
        .join(name);
    mesh(&fs::read_to_string(path).expect("a sample"))
}

fn close() -> Camera {
    let (eye, target) = (DVec3::new(60.0, 40.0, 140.0), DVec3::ZERO);
    Camera::new(eye, target, DVec3::Y, 0.4).expect("a camera")
}

fn small() -> PictureOptions {
    PictureOptions {
        size: [200, 150],
        ..PictureOptions::default()
    }
}

#[neurotess_testing::test(needs(gpu))]
fn a_whole_cell_in_the_colors_of_its_types() {
    let gpu = device();
    let cell = sample("pyramidal.swc");
    let fit = Camera::fit(Side::Front, 0.35, 150.0 / 200.0, 0.04, &spheres(&cell));
    let options = PictureOptions {
        size: [150, 200],
        ..small()
    };
    let image = picture(&gpu, &cell, &fit.expect("fits"), &options);
    compare("whole", &image);
}

#[neurotess_testing::test(needs(gpu))]
fn a_soma_from_near() {
    let gpu = device();
    compare(
        "near",
        &picture(&gpu, &sample("pyramidal.swc"), &close(), &small()),
    );
}

#[neurotess_testing::test(needs(gpu))]
fn neurons_within_a_budget() {
    let gpu = device();
    let (eye, target) = (DVec3::new(90.0, 60.0, 260.0), DVec3::new(30.0, 10.0, 0.0));
    let camera = Camera::new(eye, target, DVec3::Y, 0.5).expect("a camera");
    // A third of what half a pixel everywhere takes.
    let image = explored(
        &gpu,
        &sample("pyramidal.swc"),
        12,
        16_000,
        &camera,
        &small(),
    );
    compare("explored", &image);
}

#[neurotess_testing::test(needs(gpu))]
fn a_wireframe_on_black() {
    let gpu = device();
    let options = PictureOptions {
        background: Some([0; 3]),
        look: Look {
            light: Light::From(glam::Vec3::new(1.0, 0.5, 1.0)),
            wire: 1.0,
            ..Look::default()
        },
        occlusion: Occlusion::Off,
        ..small()
    };
    let (eye, target) = (DVec3::new(9.0, 6.0, 40.0), DVec3::ZERO);
    let camera = Camera::new(eye, target, DVec3::Y, 0.4).expect("a camera");
    compare(
        "wireframe",
        &picture(&gpu, &sample("granule.swc"), &camera, &options),
    );
}

#[neurotess_testing::test(needs(gpu))]
fn a_scale_with_its_legend_on_nothing() {
    let gpu = device();
    let cell = sample("star.swc");
    let reach = cell
        .tracing
        .iter()
        .map(|t| t.center.length())
        .fold(0.0, f32::max);
    let color_keys: Vec<u32> = cell
        .tracing
        .iter()
        .map(|t| fraction(t.center.length() / reach))
        .collect();
    let scale = ColorMap::Viridis.scale();
    let camera = Camera::fit(Side::Iso, 0.4, 200.0 / 150.0, 0.04, &spheres(&cell)).expect("fits");
    let options = PictureOptions {
        background: None,
        ..small()
    };
    let mut image = picture_of(&gpu, &cell, &color_keys, &scale, &camera, &options);
    let overlay = Overlay::new(
        &OverlayOptions {
            legend: Some(Legend::bar("distance", "µm", scale, [0.0, reach], false)),
            scale_bar: Some(0.0),
            background: None,
        },
        options.size,
        &[camera],
        &spheres(&cell),
    );
    overlay.lay_on(0, &mut image);
    compare("scale", &image);
}

#[expect(clippy::print_stdout, reason = "whoever renews pictures looks at them")]
fn compare(name: &str, image: &Image) {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{name}.png"));
    if std::env::var("NEUROTESS_GOLDEN").is_ok_and(|value| value == "renew") {
        write(&kept, image);
        println!("renewed {}", kept.display());
        return;
    }
    let before = read(&kept);
    assert_eq!(
        (before.width, before.height),
        (image.width, image.height),
        "{name}"
    );
    let [a, b] = [&before, image].map(blurred);
    let steps: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).collect();
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    let far = |pixel: &&[f64]| pixel.iter().any(|&step| step > MUCH);
    let share = 4.0 * steps.chunks(4).filter(far).count() as f64 / steps.len() as f64;
    if mean > MEAN || share > SHARE {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        let difference = Image {
            pixels: steps
                .chunks(4)
                .flat_map(|p| {
                    [0, 1, 2, 3].map(|k| {
                        if k < 3 {
                            255 - (8.0 * p[k].max(p[3])) as u8
                        } else {
                            255
                        }
                    })
                })
                .collect(),
            ..*image
        };
        for (what, image) in [
            ("before", &before),
            ("after", image),
            ("difference", &difference),
        ] {
            write(&folder.join(format!("{name}-{what}.png")), image);
        }
        panic!(
            "{name}: {mean:.2} apart in the mean, {:.2} % of pixels far apart: look at {}/{name}-*.png; \
             if it is right, cargo xtask pictures --golden",
            100.0 * share,
            folder.display()
        );
    }
}

/// Means over 3 × 3 pixels, colors premultiplied.
fn blurred(image: &Image) -> Vec<f64> {
    let (width, height) = (i64::from(image.width), i64::from(image.height));
    let mut out = Vec::with_capacity(image.pixels.len());
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0; 4];
            for (dx, dy) in (0..9).map(|i| (i % 3 - 1, i / 3 - 1)) {
                let (x, y) = ((x + dx).clamp(0, width - 1), (y + dy).clamp(0, height - 1));
                let p = image.at(x as u32, y as u32).map(f64::from);
                for k in 0..4 {
                    sum[k] += if k < 3 { p[k] * p[3] / 255.0 } else { p[k] } / 9.0;
                }
            }
            out.extend(sum);
        }
    }
    out
}

fn write(path: &Path, image: &Image) {
    let file = fs::File::create(path).expect("a file");
    let mut png = PngWriter::new(file, [image.width, image.height], true).expect("begun");
    png.write(image).expect("written");
    png.finish().expect("whole");
}

fn read(path: &Path) -> Image {
    let missing = "no golden image: make it with cargo xtask pictures --golden";
    let file = std::io::BufReader::new(fs::File::open(path).expect(missing));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    let info = reader.next_frame(&mut pixels).expect("whole");
    Image {
        width: info.width,
        height: info.height,
        pixels,
    }
}

#[neurotess_testing::test]
fn a_changed_picture_is_noticed() {
    let image = |shift: usize| {
        let mut image = Image::new(60, 40);
        for pixel in 0..image.pixels.len() / 4 {
            let inside = (pixel % 60 + shift) % 60 < 25;
            let value = if inside { 40 } else { 250 };
            image.pixels[4 * pixel..4 * pixel + 4].copy_from_slice(&[value, value, value, 255]);
        }
        image
    };
    let apart = |a: &Image, b: &Image| {
        let steps = blurred(a)
            .into_iter()
            .zip(blurred(b))
            .map(|(a, b)| (a - b).abs());
        steps.fold(0.0, |sum, step| sum + step) / a.pixels.len() as f64
    };
    assert_eq!(apart(&image(0), &image(0)), 0.0);
    assert!(apart(&image(0), &image(2)) > MEAN);
}

neurotess_testing::main!();
