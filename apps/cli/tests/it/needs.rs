//! What tests of pictures and windows need.
#![cfg(feature = "view")]

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
