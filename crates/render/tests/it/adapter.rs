//! The graphics adapter of this machine.

use neurotess_render::Gpu;

/// The need of tests that draw or compute on an adapter.
pub(crate) fn gpu() -> Result<(), String> {
    Gpu::open(None).map(drop).map_err(|error| error.to_string())
}

/// A device of its own for each test. To open one takes 60 ms in software. A device that all share took far longer:
/// whoever waits for it waits for the work of all, and the tests of this program took 417 s instead of 230.
pub(crate) fn device() -> Gpu {
    Gpu::open(None).expect("the test has needs(gpu)")
}
