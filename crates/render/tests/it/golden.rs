//! Pictures that must stay as they are, unless somebody looked at them: the processor's to the byte, an adapter's nearly.
//!
//! `NEUROTESS_GOLDEN=renew cargo test -p neurotess-render --test it golden::` (or `cargo xtask pictures
//! --golden`) writes them anew. Where one fails, `before`, `after` and `difference` are written to
//! the folder that the failure names.

use std::fs;
use std::path::Path;

use crate::adapter::{device, gpu};
use crate::compared::{Difference, MEAN};
use crate::pictured::{By, explored, mesh, spheres};
use glam::DVec3;
use neurotess_mesh::CoarseMesh;
use neurotess_render::color::{ColorMap, fraction};
use neurotess_render::overlay::{Legend, Overlay, OverlayOptions};
use neurotess_render::{Camera, Image, Light, Look, Occlusion, PictureOptions, PngWriter, Side};
use neurotess_testing::workspace;

fn sample(name: &str) -> CoarseMesh {
    let path = workspace().join("samples").join(name);
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

/// Draws a picture.
type Draw = fn(&By<'_>) -> Image;

/// Pictures of both, the processor's and an adapter's, by the names of their files.
const BOTH: [(&str, Draw); 4] = [
    ("whole", whole),
    ("near", near),
    ("wireframe", wireframe),
    ("scale", scale),
];

/// A whole cell in the colors of its types.
fn whole(by: &By<'_>) -> Image {
    let cell = sample("pyramidal.swc");
    let fit = Camera::fit(Side::Front, 0.35, 150.0 / 200.0, 0.04, &spheres(&cell));
    let options = PictureOptions {
        size: [150, 200],
        ..small()
    };
    by.picture(&cell, &fit.expect("fits"), &options)
}

/// A soma from near.
fn near(by: &By<'_>) -> Image {
    by.picture(&sample("pyramidal.swc"), &close(), &small())
}

/// A wireframe on black.
fn wireframe(by: &By<'_>) -> Image {
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
    by.picture(&sample("granule.swc"), &camera, &options)
}

/// A scale with its legend, on nothing.
fn scale(by: &By<'_>) -> Image {
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
    let mut image = by.picture_of(&cell, &color_keys, &scale, &camera, &options);
    let overlay = Overlay::new(
        &OverlayOptions {
            legend: Some(Legend::bar("distance", "µm", scale, [0.0, reach], false)),
            scale_bar: Some(0.0),
            axes: false,
            background: None,
        },
        options.size,
        &[camera],
        &spheres(&cell),
    );
    overlay.lay_on(0, &mut image);
    image
}

#[neurotess_testing::test]
fn the_processor_draws_the_same_bytes_as_ever() {
    for (name, draw) in BOTH {
        compare(name, &draw(&By::Processor), &Difference::is_any);
    }
}

/// With any number of threads, too.
#[neurotess_testing::test]
fn the_bytes_do_not_depend_on_threads() {
    let drawn = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads")
            .install(|| BOTH.map(|(_, draw)| draw(&By::Processor)))
    };
    assert!(drawn(1) == drawn(3));
}

/// Within a tenth of what an eye sees.
#[neurotess_testing::test(needs(gpu))]
fn adapters_draw_what_the_processor_draws() {
    if renews() {
        return;
    }
    let gpu = device();
    for (name, draw) in BOTH {
        compare(name, &draw(&By::Adapter(&gpu)), &|difference| {
            difference.exceeds(0.1)
        });
    }
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
    compare("explored", &image, &Difference::is_seen);
}

/// Whether the pictures that are kept are made anew.
fn renews() -> bool {
    std::env::var("NEUROTESS_GOLDEN").is_ok_and(|value| value == "renew")
}

/// `differs`: whether a difference to the picture that is kept is too large.
#[expect(clippy::print_stdout, reason = "whoever renews pictures looks at them")]
fn compare(name: &str, image: &Image, differs: &dyn Fn(&Difference) -> bool) {
    let kept = workspace().join(format!("crates/render/tests/golden/{name}.png"));
    if renews() {
        write(&kept, image);
        println!("renewed {}", kept.display());
        return;
    }
    let before = read(&kept);
    let difference = Difference::between(&before, image);
    if differs(&difference) {
        let folder = workspace().join("target/golden");
        fs::create_dir_all(&folder).expect("a folder");
        let shown = Image {
            pixels: difference
                .steps
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
            ("difference", &shown),
        ] {
            write(&folder.join(format!("{name}-{what}.png")), image);
        }
        panic!(
            "{name}: {difference}: look at {}/{name}-*.png; if it is right, cargo xtask pictures --golden",
            folder.display()
        );
    }
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
    let apart = |a: usize, b: usize| Difference::between(&image(a), &image(b));
    assert_eq!(apart(0, 0).mean, 0.0);
    assert!(!apart(0, 0).is_seen());
    assert!(apart(0, 2).mean > MEAN && apart(0, 2).is_seen());
}
