//! `neurotess --version`.

use neurotess::mesh::Format;
use serde_json::json;

use crate::convert;
use crate::info::MORPHOLOGIES;
use crate::report::Reporter;

/// Prints the version; with -v what this build can do.
pub(crate) fn run(reporter: &Reporter) -> anyhow::Result<()> {
    let version = env!("CARGO_PKG_VERSION");
    let meshes = Format::ALL.map(Format::extension);
    reporter.result(&format!("neurotess {version}"));
    if reporter.verbose() {
        reporter.result("adapter: none (this build does not draw)");
        reporter.result(&format!("reads: {}", MORPHOLOGIES.join(" ")));
        reporter.result(&format!("writes: {}", convert::written().join(" ")));
        reporter.result(&format!("meshes: {}", meshes.join(" ")));
        let system = (std::env::consts::OS, std::env::consts::ARCH);
        reporter.result(&format!("system: {} {}", system.0, system.1));
    }
    reporter.document(&json!({
        "version": version,
        "adapter": null,
        "reads": MORPHOLOGIES,
        "writes": convert::written(),
        "meshes": meshes,
    }))
}
