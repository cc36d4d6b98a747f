//! What the adapter is able to do.

use neurotess::render::adapter::Capabilities;
use serde::Serialize;

use super::args::AdapterArgs;
use crate::report::Reporter;

/// The JSON document.
#[derive(Serialize)]
struct Document<'a> {
    adapter: &'a str,
    backend: &'a str,
    kind: &'a str,
    software: bool,
    largest_buffer: u64,
    largest_binding: u64,
    largest_texture: u32,
    workgroup_threads: u32,
    workgroup_bytes: u32,
    dispatched_workgroups: u32,
    timestamps: bool,
    mesh_shaders: bool,
}

/// Prints it.
pub(super) fn run(args: &AdapterArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let able = Capabilities::of(args.adapter.as_deref())?;
    let has = |it: bool| if it { "yes" } else { "no" };
    for (what, value) in [
        ("adapter", format!("{} [{}]", able.name, able.backend)),
        ("kind", able.kind.to_owned()),
        ("largest buffer", format!("{} bytes", able.largest_buffer)),
        ("largest binding", format!("{} bytes", able.largest_binding)),
        (
            "largest texture",
            format!("{} pixels", able.largest_texture),
        ),
        (
            "workgroups",
            format!(
                "{} threads, {} bytes, {} in a row",
                able.workgroup_threads, able.workgroup_bytes, able.dispatched_workgroups
            ),
        ),
        ("times of passes", has(able.has_timestamps).to_owned()),
        ("mesh shaders", has(able.has_mesh_shaders).to_owned()),
    ] {
        reporter.result(&format!("{what:<16} {value}"));
    }
    reporter.document(&Document {
        adapter: &able.name,
        backend: &able.backend,
        kind: able.kind,
        software: able.kind == "software",
        largest_buffer: able.largest_buffer,
        largest_binding: able.largest_binding,
        largest_texture: able.largest_texture,
        workgroup_threads: able.workgroup_threads,
        workgroup_bytes: able.workgroup_bytes,
        dispatched_workgroups: able.dispatched_workgroups,
        timestamps: able.has_timestamps,
        mesh_shaders: able.has_mesh_shaders,
    })
}
