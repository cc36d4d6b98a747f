//! Pictures of sessions: the processor draws what a software adapter draws.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::sync::Arc;

use neurotess::render::Gpu;
use neurotess::render::adapter::adapters;
use neurotess_viewer::draw_session;
use neurotess_viewer::save::PictureFile;

use crate::common::circuit::write_circuit;

/// The need of tests that draw by a software adapter, whose pictures differ least.
fn software() -> Result<(), String> {
    let is_there = adapters().iter().any(|adapter| adapter.software);
    is_there.then_some(()).ok_or("no software adapter".into())
}

/// Sessions: name, what comes before the tracings, and tracings.
const SESSIONS: [(&str, &str, &[&str]); 8] = [
    ("plain", "", &["star"]),
    (
        "states",
        "grid = true\n[view]\neye = [0, 0, 1600]\n[look]\nhighlight_selected = true\nghost_others = true\n",
        &["granule", "star", "motor"],
    ),
    (
        "cut",
        "[look.cut]\naxis = 0\nplace = 0.5\nflipped = true\n",
        &["star"],
    ),
    (
        "wires",
        "[view]\neye = [30, 20, 60]\n[look]\nwireframe = true\nbackground = [0, 0, 0]\n",
        &["star"],
    ),
    (
        "parts",
        "[view]\neye = [0, 0, 500]\northographic = true\n[look]\nparts = \"neurites\"\nradius_factor = 3.0\nocclusion = false\n\
         color_by = \"radius\"\nlight = \"flat\"\n",
        &["granule"],
    ),
    (
        "points",
        "[markers]\npoints = \"points.csv\"\ncolumn = \"w\"\nsize = 9.0\n",
        &["star"],
    ),
    (
        "meshes",
        "[view]\neye = [0, 0, 900]\n[[mesh]]\npath = \"box.obj\"\nopacity = 0.4\n[[mesh]]\npath = \"box.obj\"\nscale = 1.4\nedges = true\n",
        &["star"],
    ),
    (
        "values",
        "report = \"circuit/voltage.h5\"\n[look]\ncolor_by = \"value\"\n[playback]\ntime = 4.0\nspeed = 0.0\nloops = true\n\
         [[circuit]]\npath = \"circuit/circuit_config.json\"\n",
        &[],
    ),
];

fn write_sessions(folder: &Path) {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("written");
    let points = (0..60).map(|i| format!("{},{},{},{i}\n", 7 * i - 200, (37 * i) % 300 - 150, i));
    write(
        "points.csv",
        &format!("x,y,z,w\n{}", points.collect::<String>()),
    );
    let corners = (0..8).map(|i| {
        let [x, y, z] = [i & 1, i >> 1 & 1, i >> 2].map(|n| 160 * n - 80);
        format!("v {x} {y} {z}\n")
    });
    let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    write("box.obj", &(corners.collect::<String>() + faces));
    write_circuit(&folder.join("circuit"), 4, 1, 3);
    for (name, before, tracings) in SESSIONS {
        let mut text = format!("version = 1\n{before}");
        for (index, kind) in tracings.iter().enumerate() {
            text += &format!("[[file]]\npath = \"sample:{kind}\"\n");
            text += &format!(
                "[[neuron]]\nname = \"{kind}\"\nfile = {index}\nselected = {}\n",
                index == 1
            );
        }
        if tracings.is_empty() {
            let cells = folder.join("circuit/morphologies");
            let cell = fs::read_dir(cells)
                .expect("a folder")
                .next()
                .expect("a cell");
            let path = cell.expect("a cell").path();
            text += &format!("[[file]]\npath = {:?}\n", path.display().to_string());
            for id in 0..4 {
                text += &format!("[[neuron]]\nname = \"{id}\"\nfile = 0\n");
                text += &format!("node = {{ circuit = 0, population = \"cortex\", id = {id} }}\n");
            }
        }
        write(&format!("{name}.neurotess"), &text);
    }
}

/// The bytes of pixels.
fn pixels(file: &Path) -> Vec<u8> {
    let file = BufReader::new(File::open(file).expect("a picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut pixels).expect("pixels");
    pixels
}

#[neurotess_testing::test(needs(software))]
fn the_processor_draws_sessions_as_an_adapter_does() {
    let folder = tempfile::tempdir().expect("a folder");
    write_sessions(folder.path());
    let found = adapters();
    let name = &found.iter().find(|a| a.software).expect("needed").name;
    let gpu = Arc::new(Gpu::open(Some(name)).expect("an adapter"));
    // Each look has pipelines of its own, which take a second or more.
    let few = if neurotess_testing::is_full() {
        SESSIONS.len()
    } else {
        2
    };
    for (session, ..) in &SESSIONS[..few] {
        let draw = |by: &str, gpu: Option<&Arc<Gpu>>| {
            let picture = PictureFile {
                out: folder.path().join(format!("{session}_{by}.png")),
                size: [320, 240],
                samples: 16,
                transparent: false,
                replace: false,
                recipe: true,
            };
            let file = folder.path().join(format!("{session}.neurotess"));
            let drawn = draw_session(&file, &picture, None, &|_| Ok(gpu.cloned()), true);
            assert_eq!(drawn.expect("drawn").failures, [], "{session}");
            pixels(&picture.out)
        };
        let (ours, theirs) = (draw("processor", None), draw("adapter", Some(&gpu)));
        let apart = ours
            .iter()
            .zip(&theirs)
            .map(|(a, b)| u64::from(a.abs_diff(*b)));
        let mean = apart.sum::<u64>() as f64 / ours.len() as f64;
        // At lines and at the edges of what one can see through, single samples are others.
        let most = match *session {
            "wires" | "meshes" => 0.3,
            _ => 0.1,
        };
        assert!(mean < most, "{session}: {mean}");
        let shown = ours.chunks(3).filter(|pixel| *pixel != &ours[..3]).count();
        assert!(shown > 1500, "{session}: {shown} pixels are no background");
    }
}
