//! `neurotess --version`.

use neurotess::batch::MORPHOLOGIES;
use neurotess::mesh::Format;
use serde_json::json;

use crate::io::morphologies::written;
use crate::report::Reporter;

/// The best graphics adapter, or why there is none: pictures need none.
#[cfg(feature = "gpu")]
fn adapter() -> Result<String, String> {
    match neurotess::render::Gpu::open(None) {
        Ok(gpu) => Ok(gpu.adapter.to_string()),
        Err(e) => Err(e.to_string()),
    }
}

/// The reason why there is none.
#[cfg(not(feature = "gpu"))]
fn adapter() -> Result<String, String> {
    Err("this build draws by the processor alone: build it with the feature 'gpu'".into())
}

/// Prints the version; with -v also formats and features of this build.
pub(crate) fn run(reporter: &Reporter) -> anyhow::Result<()> {
    let version = env!("CARGO_PKG_VERSION");
    let meshes = Format::ALL.map(Format::name);
    reporter.answer(&format!("neurotess {version}"));
    if reporter.verbose() {
        reporter.answer(&match adapter() {
            Ok(adapter) => format!("adapter: {adapter}"),
            Err(e) => format!("adapter: none: {e}"),
        });
        // Files in XML and JSON are not looked for in folders.
        reporter.answer(&format!("reads: {} xml json", MORPHOLOGIES.join(" ")));
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
        "adapter": adapter().ok(),
        "reads": MORPHOLOGIES,
        "writes": written(),
        "meshes": meshes,
    }))
}
