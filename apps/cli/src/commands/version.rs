//! `neurotess --version`.

use neurotess::mesh::Format;
use neurotess::render::{AdapterName, DeviceError, Gpu};
use serde_json::json;

use crate::io::morphologies::{MORPHOLOGIES, written};
use crate::report::Reporter;

/// The adapter that pictures would be drawn with.
fn adapter() -> Result<AdapterName, DeviceError> {
    Gpu::open(None).map(|gpu| gpu.adapter)
}

/// Prints the version; with -v what this build can do.
pub(crate) fn run(reporter: &Reporter) -> anyhow::Result<()> {
    let version = env!("CARGO_PKG_VERSION");
    let meshes = Format::ALL.map(Format::extension);
    reporter.answer(&format!("neurotess {version}"));
    if reporter.verbose() {
        reporter.answer(&match adapter() {
            Ok(adapter) => format!("adapter: {adapter}"),
            Err(e) => format!("adapter: none: {e}"),
        });
        reporter.answer(&format!("reads: {}", MORPHOLOGIES.join(" ")));
        reporter.answer(&format!("writes: {}", written().join(" ")));
        reporter.answer(&format!("meshes: {}", meshes.join(" ")));
        let system = (std::env::consts::OS, std::env::consts::ARCH);
        reporter.answer(&format!("system: {} {}", system.0, system.1));
    }
    if !reporter.json() {
        return Ok(());
    }
    reporter.document(&json!({
        "version": version,
        "adapter": adapter().ok().map(|adapter| adapter.to_string()),
        "reads": MORPHOLOGIES,
        "writes": written(),
        "meshes": meshes,
    }))
}
