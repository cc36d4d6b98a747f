//! The command line as scripts see it: one test for each row of its contract.

mod attacks;
mod bench;
mod cache;
mod check;
mod circuit;
mod convert;
mod display;
mod help;
mod info;
mod inputs;
mod kill;
mod markers;
mod mesh;
mod meshes;
mod palettes;
mod render;
mod resume;
mod snudda;
mod streams;
mod synth;
mod tables;
mod values;
mod view;
mod view_keys;
#[path = "../common/work.rs"]
mod work;

/// The need of tests that draw.
pub(crate) fn gpu() -> Result<(), String> {
    let missing = || "no graphics adapter was found".to_owned();
    let adapters = neurotess::render::adapter::adapters();
    adapters.first().map(drop).ok_or_else(missing)
}

/// The need of tests that take features away from OpenGL, by variables of Mesa's.
pub(crate) fn mesa_opengl() -> Result<(), String> {
    let adapters = neurotess::render::adapter::adapters();
    let is_there = adapters
        .iter()
        .any(|a| a.backend == "gl" && a.name.contains("Mesa"));
    match is_there {
        true => Ok(()),
        false => Err("no OpenGL by Mesa".into()),
    }
}

neurotess_testing::main!();
