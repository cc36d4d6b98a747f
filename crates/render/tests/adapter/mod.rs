//! The graphics adapter of this machine.

use neurotess_render::Gpu;

/// The need of tests that draw or compute on an adapter.
pub(crate) fn gpu() -> Result<(), String> {
    Gpu::open(None).map(drop).map_err(|error| error.to_string())
}

/// A device of its own for each test.
pub(crate) fn device() -> Gpu {
    Gpu::open(None).expect("the test has needs(gpu)")
}
