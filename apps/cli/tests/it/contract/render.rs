//! `neurotess render`, with an adapter and without one.

use std::collections::BTreeSet;
use std::fs;

use serde_json::Value;

use crate::needs::{gpu, mesa_opengl};
use crate::work::{BROKEN, Run, SMALL, Work};

/// A picture: width, height, samples of a pixel, bytes.
pub(crate) struct Picture {
    size: (u32, u32),
    channels: usize,
    pub(crate) pixels: Vec<u8>,
}

impl Picture {
    /// Samples of one pixel after the other.
    pub(crate) fn pixels(&self) -> std::slice::ChunksExact<'_, u8> {
        self.pixels.chunks_exact(self.channels)
    }

    pub(crate) fn read(work: &Work, name: &str) -> Self {
        let file = fs::File::open(work.path(name)).expect("a picture");
        let decoder = png::Decoder::new(std::io::BufReader::new(file));
        let mut reader = decoder.read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        let info = reader.next_frame(&mut pixels).expect("whole");
        Self {
            size: (info.width, info.height),
            channels: info.color_type.samples(),
            pixels,
        }
    }

    /// The different colors, reduced to 3 bits a channel.
    pub(crate) fn hues(&self) -> BTreeSet<Vec<u8>> {
        let pixels = self.pixels.chunks(self.channels);
        pixels
            .map(|p| p[..3].iter().map(|c| c >> 5).collect())
            .collect()
    }

    /// Pixels of which red (0) or blue (2) is far above the other.
    pub(crate) fn count(&self, channel: usize) -> usize {
        let pixels = self.pixels.chunks(self.channels);
        let other = 2 - channel;
        pixels
            .filter(|p| p[channel] > p[other].saturating_add(30))
            .count()
    }
}

/// Draws the small cell.
fn drawn(arguments: &str) -> (Work, Run) {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work
        .run(&format!(
            "render cell.swc -o cell.png --size 120x90 {arguments}"
        ))
        .exits(0);
    (work, run)
}

fn picture(arguments: &str) -> Picture {
    Picture::read(&drawn(arguments).0, "cell.png")
}

#[neurotess_testing::test]
fn a_cell_becomes_a_picture_in_the_colors_of_its_types() {
    let picture = picture("");
    assert_eq!((picture.size, picture.channels), ((120, 90), 3));
    assert_eq!(picture.pixels[..3], [255; 3], "white behind");
    assert!(picture.count(0) > 50, "red dendrites");
    assert!(picture.count(2) > 10, "a blue axon");
    let other = self::picture("--palette neuromorpho");
    assert!(other.count(2) < picture.count(2) && other.pixels != picture.pixels);
}

/// Cells are as thick as the factor says, in the same colors.
#[neurotess_testing::test]
fn radii_are_drawn_larger_by_a_factor() {
    let [traced, thick] = ["1", "3"].map(|factor| {
        let look = "--color-by radius --no-legend --types axon --soma none --range 0,3";
        picture(&format!("{look} --radius-factor {factor}"))
    });
    let ink = |picture: &Picture| picture.pixels().filter(|p| p[..3] != [255; 3]).count();
    let ratio = ink(&thick) as f64 / ink(&traced) as f64;
    assert!((1.5..4.0).contains(&ratio), "{ratio}");
    // Radii of 0.8 to 1 µm are blue in this range, those of 2.4 to 3 µm would be yellow.
    assert!(thick.count(2) > traced.count(2));
    assert_eq!(thick.count(0), 0, "colors of the traced radii");
}

#[neurotess_testing::test(needs(gpu))]
fn every_option_of_the_contract_draws() {
    let plain = picture("").pixels;
    let all = [
        "--level 1",
        "--lod homogeneous --level 2",
        "--pixels 2",
        "--lod prerefined --level 1",
        "--lod static",
        "--lod exploration",
        "--samples 1",
        "--background 203040",
        "--transparent",
        "--color-by neurite",
        "--color-by section",
        "--color-by order",
        "--color-by radius --colormap cividis",
        "--color-by depth --colormap magma",
        "--color-by neuron",
        "--wireframe",
        "--light flat",
        "--light 1,0,0.5",
        "--ao 0",
        "--ao 12",
        "--scale-bar",
        "--scale-bar 20",
        "--no-legend",
        "--view back",
        "--view left",
        "--view right",
        "--view top",
        "--view bottom",
        "--view iso",
        "--eye 0,-10,90 --target 0,10,0",
        "--eye 0,-10,90 --target 0,10,0 --up 1,0,0 --fov 40",
        "--orthographic --view iso",
        "--orthographic 60",
        "--eye 0,-10,90 --target 0,10,0 --orthographic",
        "--types axon",
        "--soma sphere",
    ];
    // In the quick lane every fifth: each is a start of the command.
    for arguments in all.into_iter().step_by(neurotess_testing::cases(5, 1)) {
        let other = picture(arguments);
        assert!(other.pixels != plain, "{arguments}");
        assert!(other.hues().len() > 3, "{arguments}: {:?}", other.hues());
    }
    let explicit =
        picture("--view front --samples 16 --palette neurom --light soft --ao --pixels 0.25");
    assert!(explicit.pixels == plain, "defaults are what help says");
}

#[neurotess_testing::test(needs(gpu))]
fn modes_draw_the_same_and_memory_on_the_fly_does_not_grow() {
    let drawn = |arguments: &str| {
        let (work, _) = drawn(&format!("--stats stats.json {arguments}"));
        let stats = work.text("stats.json");
        let stats: Value = serde_json::from_str(&stats).expect("JSON");
        (Picture::read(&work, "cell.png").pixels, stats)
    };
    let (stored, _) = drawn("--lod prerefined --level 4");
    let (made, four) = drawn("--level 4");
    // A line along a pixel's border may fall to either side.
    let apart = stored
        .iter()
        .zip(&made)
        .filter(|(a, b)| a.abs_diff(**b) > 24)
        .count();
    assert!(apart * 200 < stored.len(), "{apart} of {}", stored.len());
    let (_, sixteen) = drawn("--level 16");
    assert!(sixteen["triangles"].as_u64() > four["triangles"].as_u64());
    assert_eq!(sixteen["bytes_per_point"], four["bytes_per_point"]);
    assert_eq!(
        four["level_histogram"]
            .as_object()
            .map(serde_json::Map::len),
        Some(1)
    );
}

#[neurotess_testing::test]
fn transparent_pictures_have_alpha() {
    let picture = picture("--transparent --no-legend");
    assert_eq!(picture.channels, 4);
    let alphas: BTreeSet<u8> = picture.pixels.chunks(4).map(|p| p[3]).collect();
    assert!(alphas.contains(&0) && alphas.contains(&255) && alphas.len() > 6);
}

#[neurotess_testing::test]
fn stats_have_the_keys_of_the_contract() {
    let (work, run) = drawn("--stats stats.json --json");
    let text = work.text("stats.json");
    let stats: Value = serde_json::from_str(&text).expect("JSON");
    for key in [
        "neurons",
        "patches",
        "patches_drawn",
        "vertices",
        "triangles",
    ] {
        assert!(stats[key].as_u64().is_some_and(|n| n > 0), "{key}: {stats}");
    }
    assert!(stats["adapter"].is_string() && stats["backend"].is_string());
    let bytes = stats["gpu_bytes"].as_object().expect("by buffer");
    assert!(
        bytes.len() > 3 && bytes.values().all(Value::is_u64),
        "{bytes:?}"
    );
    assert!(stats["bytes_per_point"].as_f64() > Some(1.0));
    assert!(stats["frame_ms"]["cpu"].as_f64() > Some(0.0));
    assert!(stats["level_histogram"].is_object());
    let json = run.json();
    assert_eq!(json["files"][0], "cell.png");
    assert_eq!(json["inputs"][0]["file"], "cell.swc");
    assert_eq!(json["triangles"], stats["triangles"]);
}

#[neurotess_testing::test]
fn turntables_are_numbered_and_turn() {
    let (work, _) = {
        let work = Work::new();
        work.file("cell.swc", SMALL);
        let run = work
            .run("render cell.swc -o t.png --turntable --frames 4 --size 60x60 --no-legend")
            .exits(0);
        (work, run)
    };
    let names = [
        "cell.swc",
        "t_0000.png",
        "t_0001.png",
        "t_0002.png",
        "t_0003.png",
    ];
    assert_eq!(work.names("."), names);
    let [a, b] = ["t_0000.png", "t_0001.png"].map(|name| Picture::read(&work, name).pixels);
    assert!(a != b);
}

#[neurotess_testing::test]
fn several_cells_are_in_one_picture_and_a_broken_one_is_reported() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", BROKEN);
    let moved = SMALL.replace("1 1 0 0 0 5 -1", "1 1 90 0 0 5 -1");
    work.file("cells/c.swc", moved);
    let run = work
        .run("render cells -o all.png --size 90x60 --color-by neuron --json")
        .exits(1);
    assert_eq!(run.errors().len(), 1, "{}", run.stderr());
    let json = run.json();
    assert_eq!(json["neurons"], 2);
    assert!(json["inputs"][1]["error"].is_string());
    assert_eq!(Picture::read(&work, "all.png").size, (90, 60));
}

#[neurotess_testing::test]
fn nothing_to_draw_is_a_picture_of_nothing() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work
        .run("render cell.swc -o none.png --size 20x20 --soma none --types custom_9")
        .exits(0);
    assert!(
        run.stderr().contains("nothing is left to draw"),
        "{}",
        run.stderr()
    );
    assert!(
        Picture::read(&work, "none.png")
            .pixels
            .iter()
            .all(|&byte| byte == 255)
    );
}

#[neurotess_testing::test]
fn files_stay_without_force_and_nothing_is_left_half_written() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("cell.png", "precious");
    let run = work.run("render cell.swc -o cell.png").exits(1);
    assert!(run.errors()[0].contains("--force"), "{}", run.stderr());
    assert_eq!(fs::read(work.path("cell.png")).expect("there"), b"precious");
    work.file("bad.swc", BROKEN);
    let run = work.run("render bad.swc -o bad.png").exits(1);
    assert!(
        run.errors()[0].starts_with("error: bad.swc:2: "),
        "{}",
        run.stderr()
    );
    let run = work
        .run("render cell.swc -o new.png --adapter nonsense")
        .exits(1);
    assert_eq!(run.errors().len(), 1, "{}", run.stderr());
    assert_eq!(work.names("."), ["bad.swc", "cell.png", "cell.swc"]);
}

/// Drivers are hidden by the variables of the loaders that Linux has.
#[cfg(target_os = "linux")]
#[neurotess_testing::test]
fn without_a_driver_the_processor_draws_and_a_named_adapter_says_what_to_install() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = |arguments: &str| {
        let mut command = work.command(arguments);
        for variable in [
            "VK_DRIVER_FILES",
            "VK_ICD_FILENAMES",
            "__EGL_VENDOR_LIBRARY_FILENAMES",
            "LIBGL_DRIVERS_PATH",
        ] {
            command.env(variable, "/nonexistent");
        }
        Run(command.output().expect("it runs"))
    };
    for named in ["--adapter llvmpipe", "--lod exploration"] {
        let drawn = run(&format!("render cell.swc -o cell.png {named}")).exits(1);
        assert_eq!(drawn.errors().len(), 1, "{}", drawn.stderr());
        assert!(drawn.errors()[0].contains("install"), "{}", drawn.stderr());
        assert_eq!(work.names("."), ["cell.swc"]);
    }
    run("render cell.swc -o cell.png --stats stats.json").exits(0);
    let stats: Value = serde_json::from_str(&work.text("stats.json")).expect("JSON");
    assert_eq!(stats["adapter"], "cpu");
    let explored = run("render cell.swc -o e.png --adapter cpu --lod exploration").exits(2);
    assert!(explored.stderr().contains("--lod"), "{}", explored.stderr());
    let version = run("--version -v").exits(0).stdout();
    assert!(version.contains("adapter: none"), "{version}");
}

#[neurotess_testing::test(needs(mesa_opengl))]
fn an_adapter_that_cannot_draw_says_what_it_lacks() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut command = work.command("render cell.swc -o cell.png --adapter gl");
    command
        .env("MESA_GL_VERSION_OVERRIDE", "4.2")
        .env("MESA_EXTENSION_OVERRIDE", "-GL_ARB_compute_shader");
    let run = Run(command.output().expect("it runs")).exits(1);
    let errors = run.errors();
    assert_eq!(errors.len(), 1, "{}", run.stderr());
    assert!(
        errors[0].contains("[gl]")
            && errors[0].contains("no compute shaders")
            && errors[0].contains("another adapter"),
        "{}",
        run.stderr()
    );
    assert_eq!(work.names("."), ["cell.swc"]);
}

#[neurotess_testing::test]
fn wrong_usage_of_render_exits_with_2() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for wrong in [
        "render cell.swc",
        "render cell.swc -o cell.jpg",
        "render cell.swc -o cell.png --size 0x5",
        "render cell.swc -o cell.png --samples 65",
        "render cell.swc -o cell.png --level 65",
        "render cell.swc -o cell.png --lod adaptive --level 3",
        "render cell.swc -o cell.png --level 3 --pixels 1",
        "render cell.swc -o cell.png --budget 3",
        "render cell.swc -o cell.png --lod exploration --level 3",
        "render cell.swc -o cell.png --lod exploration --pixels 1",
        "render cell.swc -o cell.png --lod exploration --budget 9000000000",
        "render cell.swc -o cell.png --lod exploration --gpu-memory 0",
        "render cell.swc -o cell.png --lod exploration --gpu-memory much",
        "render cell.swc -o cell.png --lod static --pixels 1",
        "render cell.swc -o cell.png --background reddish",
        "render cell.swc -o cell.png --transparent --background white",
        "render cell.swc -o cell.png --color-by luck",
        "render cell.swc -o cell.png --colormap jet",
        "render cell.swc -o cell.png --palette mine",
        "render cell.swc -o cell.png --eye 1,2,3",
        "render cell.swc -o cell.png --eye 1,2,3 --target 1,2,3",
        "render cell.swc -o cell.png --eye nan,2,3 --target 0,0,0",
        "render cell.swc -o cell.png --eye 0,9,0 --target 0,0,0 --up 0,1,0",
        "render cell.swc -o cell.png --fov 200",
        "render cell.swc -o cell.png --orthographic 0",
        "render cell.swc -o cell.png --orthographic -5",
        "render cell.swc -o cell.png --frames 3",
        "render cell.swc -o cell.png --light dim",
        "render cell.swc -o cell.png --ao -3",
        "render cell.swc -o cell.png --least-width -1",
    ] {
        let run = work.run(wrong).exits(2);
        assert!(
            run.stdout().is_empty() && !run.stderr().is_empty(),
            "{wrong}"
        );
    }
    assert_eq!(work.names("."), ["cell.swc"]);
}

#[neurotess_testing::test(needs(gpu))]
fn circuits_are_drawn_cell_by_cell_at_their_positions() {
    let work = Work::new();
    work.run("synth circuit -o circuit --neurons 6 --morphologies 2 --seed 5")
        .exits(0);
    let drawn = |options: &str| {
        let json = work
            .run(&format!(
                "render circuit -o c.png --force --size 96x72 --samples 1 {options} --json"
            ))
            .exits(0)
            .json();
        (
            json["neurons"].clone(),
            Picture::read(&work, "c.png").pixels,
        )
    };
    let (all, picture) = drawn("");
    assert_eq!(all, 6);
    let (some, other) = drawn("--nodes 0,3");
    assert_eq!(some, 2);
    assert_ne!(picture, other);
    let run = work
        .run("render circuit cell.swc -o c.png --force")
        .exits(2);
    assert!(run.stderr().contains("alone"), "{}", run.stderr());
    work.file("cell.swc", SMALL);
    let run = work
        .run("render cell.swc -o c.png --force --sample 3")
        .exits(2);
    assert!(
        run.stderr().contains("no input is a circuit"),
        "{}",
        run.stderr()
    );
    let run = work
        .run("render circuit -o c.png --force --lod exploration --budget 400 --stats s.json")
        .exits(0);
    let stats = work.text("s.json");
    let stats: Value = serde_json::from_str(&stats).expect("JSON");
    let number = |key: &str| stats["exploration"][key].as_u64().expect("a number");
    assert!(number("wanted") > 400 && number("left_out") > 0);
    assert!(
        stats["triangles"]
            .as_u64()
            .is_some_and(|n| n <= 400 && n > 0)
    );
    assert!(run.stderr().contains("left out"), "{}", run.stderr());
    let run = work
        .run("render circuit -o c.png --force --lod prerefined --level 1")
        .exits(2);
    assert!(run.stderr().contains("--lod"), "{}", run.stderr());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn tracings_that_do_not_fit_the_adapter_are_drawn_as_those_that_do() {
    let work = Work::new();
    work.run("synth circuit -o circuit --neurons 120 --morphologies 80 --points 400 --reported 1")
        .exits(0);
    // From afar: most cells show no more than their coarse forms have.
    let draw = "render circuit -o c.png --force --lod exploration --budget 4000000 --size 160x120 --samples 1 \
                --eye 0,0,9000 --target 0,0,0 --stats s.json";
    let streamed = |memory: &str| {
        work.run(&format!("{draw} {memory}")).exits(0);
        let stats = work.text("s.json");
        let stats: Value = serde_json::from_str(&stats).expect("JSON");
        let bytes =
            ["chunks", "points", "color_keys"].map(|name| stats["gpu_bytes"][name].as_u64());
        let bytes: u64 = bytes.iter().map(|bytes| bytes.expect("bytes")).sum();
        let streamed = stats["exploration"]["streamed"].clone();
        (Picture::read(&work, "c.png").pixels, bytes, streamed)
    };
    let (whole, all, none) = streamed("");
    assert!(none.is_null());
    let (picture, bytes, some) = streamed(&format!("--gpu-memory {}", all * 4 / 5));
    assert!(bytes <= all * 4 / 5, "{bytes} of {all}");
    let count = |what: &str| some[what].as_u64().expect("a number");
    assert!(
        count("tracings") > 40 && count("whole") < count("tracings"),
        "{some}"
    );
    assert!(picture == whole, "another picture");
    let near = "render circuit -o c.png --force --lod exploration --size 160x120 --samples 1";
    let said = |run: &Run| run.stderr().contains("more coarsely than they show");
    let run = work
        .run(&format!("{near} --gpu-memory {}", all / 8))
        .exits(0);
    assert!(
        said(&run) && !said(&work.run(near).exits(0)),
        "{}",
        run.stderr()
    );
    let mut command = work.command(draw);
    command.env("NEUROTESS_GPU_MEMORY", "1KiB");
    let run = Run(command.output().expect("it runs")).exits(1);
    assert!(
        run.stderr().contains("bytes at least, but there are"),
        "{}",
        run.stderr()
    );
}

#[neurotess_testing::test]
fn thin_neurites_are_widened_unless_they_are_not_to_be() {
    let work = Work::new();
    let thin = "1 1 0 0 0 4 -1\n2 2 0 5 0 0.1 1\n3 2 0 60 0 0.1 2\n4 2 3 120 0 0.1 3\n";
    work.file("thin.swc", thin);
    let ink = |arguments: &str| -> u64 {
        let line =
            format!("render thin.swc -o thin.png --force --size 96x120 --no-legend {arguments}");
        work.run(&line).exits(0);
        let picture = Picture::read(&work, "thin.png");
        let bytes = picture.pixels.iter().map(|&byte| u64::from(255 - byte));
        bytes.sum()
    };
    let [usual, same, off] = ["", "--least-width 1.5", "--least-width 0"].map(ink);
    assert_eq!(usual, same);
    assert!(3 * usual > 4 * off, "{usual} {off}");
}

#[neurotess_testing::test]
fn axes_are_drawn_where_there_is_room() {
    // The green of y, which the cell has not.
    let green = |pixel: &[u8]| pixel[1] > pixel[0].max(pixel[2]).saturating_add(40);
    let axis = |picture: &Picture| picture.pixels().any(green);
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for (name, options, shows) in [
        ("with", "--size 240x180 --axes", true),
        ("without", "--size 240x180", false),
        ("tiny", "--size 40x30 --axes", false),
    ] {
        let line = format!("render cell.swc -o {name}.png --samples 1 {options}");
        work.run(&line).exits(0);
        let picture = Picture::read(&work, &format!("{name}.png"));
        assert_eq!(axis(&picture), shows, "{name}");
    }
}

#[neurotess_testing::test]
fn the_library_draws_the_same_picture() {
    use neurotess::options::words::{Fit, Size};
    use neurotess::recipe::MeshOptions;
    let (work, _) = drawn("--scale-bar");
    let tracing = neurotess::read(work.path("cell.swc")).expect("a cell");
    let cell = neurotess::mesh(&tracing, &MeshOptions::default()).expect("meshed");
    let mut options = neurotess::options::Picture::default();
    options.look.size = Size([120, 90]);
    options.look.scale_bar = Some(Fit::Auto);
    let picture = neurotess::draw(&[&cell], &options).expect("drawn");
    picture.save(work.path("ours.png")).expect("saved");
    let [theirs, ours] = ["cell.png", "ours.png"].map(|name| Picture::read(&work, name));
    assert_eq!(ours.size, theirs.size);
    assert!(ours.pixels == theirs.pixels);
    assert!(neurotess::draw(&[], &options).is_err());
}
