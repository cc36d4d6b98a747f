//! A driver that draws on the processor does not ask the system for the memory of every frame anew. A test
//! program of its own, since what other tests free changes what the allocator keeps.

#[path = "../it/adapter.rs"]
mod adapter;
#[path = "../it/pictured.rs"]
mod pictured;

use std::ffi::OsString;

use adapter::{device, gpu};
use neurotess_refine::{LodCriterion, RefineOptions};
use neurotess_render::{Frame, Meter, Prerefined, PrerefinedSurface};
use neurotess_testing::note;
use pictured::{CELL, by_type, camera, mesh, spheres};

const SIZE: [u32; 2] = [600, 600];
/// Frames that are counted.
const FRAMES: u64 = 10;
/// Most pages of a frame. It takes thousands where the triangles' memory is asked for anew.
const MAX_PAGES: u64 = 500;

/// The need of a driver that draws on the processor, and of glibc's allocator as it is by default.
fn software() -> Result<(), String> {
    if !cfg!(all(target_os = "linux", target_env = "gnu")) {
        return Err("the allocator is not glibc's".into());
    }
    let set = |(name, _): &(OsString, OsString)| {
        let name = name.to_string_lossy();
        name.starts_with("MALLOC_") || name == "GLIBC_TUNABLES"
    };
    if let Some((name, _)) = std::env::vars_os().find(set) {
        return Err(format!("{} is set", name.display()));
    }
    match neurotess_render::Gpu::open(None) {
        Ok(gpu) if gpu.adapter.software => Ok(()),
        Ok(gpu) => Err(format!("{} does not draw on the processor", gpu.adapter)),
        Err(error) => Err(error.to_string()),
    }
}

/// Pages that the system has given to this program so far.
fn pages() -> u64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    // After the name, which may have spaces: the state, and then numbers.
    let (_, rest) = stat.rsplit_once(')').expect("a name");
    let minor_faults = rest.split_whitespace().nth(7).expect("a count");
    minor_faults.parse().expect("a number")
}

#[neurotess_testing::test(needs(gpu, software))]
fn frames_use_the_memory_of_the_frames_before() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (color_keys, table) = by_type(&mesh);
    let surface = PrerefinedSurface {
        mesh: &mesh,
        color_keys: &color_keys,
    };
    let lod = |_| LodCriterion::Homogeneous(24).into();
    let options = RefineOptions::default();
    let mut source = Prerefined::new(&gpu, &[surface], lod, &options, false).expect("uploaded");
    let camera = camera(&mesh, SIZE);
    let frame = Frame::whole(camera, camera.near(&spheres(&mesh)), SIZE);
    let mut meter = Meter::new(&gpu, &source, &table).expect("a meter");
    let mut draw = || {
        meter.time(&mut source, &frame).expect("drawn");
    };
    (0..3).for_each(|_| draw());
    let before = pages();
    (0..FRAMES).for_each(|_| draw());
    let each = (pages() - before) / FRAMES;
    note!("{each} pages a frame, {} triangles", source.shown());
    assert!(source.shown() > 100_000, "{}", source.shown());
    assert!(each < MAX_PAGES, "{each} pages a frame");
}

neurotess_testing::main!();
