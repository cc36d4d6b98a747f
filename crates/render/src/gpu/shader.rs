//! The shaders of this crate: their files, and the modules composed of them.

use neurotess_refine::gpu;
use neurotess_refine::wgsl::{Shader, ShaderParts, WgslFile, compose};

use crate::gpu::device::Gpu;

/// The file `$folder/$name` below `src`.
macro_rules! file {
    ($folder:literal, $name:literal) => {
        WgslFile {
            name: $name,
            text: include_str!(concat!("../", $folder, "/", $name)),
        }
    };
}

/// All files of this crate, for imports.
pub(crate) const FILES: [WgslFile; 51] = [
    file!("sources", "surface_vertex.wgsl"),
    file!("sources", "surface_keys.wgsl"),
    file!("sources", "octahedral.wgsl"),
    file!("sources/adaptive", "placed.wgsl"),
    file!("sources/adaptive", "clusters.wgsl"),
    file!("sources/adaptive", "shown.wgsl"),
    file!("sources/adaptive", "classify.wgsl"),
    file!("sources/adaptive", "cull.wgsl"),
    file!("sources/adaptive", "note.wgsl"),
    file!("sources/adaptive", "coarse_point.wgsl"),
    file!("sources/adaptive", "coarse.wgsl"),
    file!("sources/adaptive", "scan.wgsl"),
    file!("sources/adaptive", "flatten.wgsl"),
    file!("sources/adaptive", "list.wgsl"),
    file!("sources/adaptive", "tube.wgsl"),
    file!("sources/adaptive", "vertices.wgsl"),
    file!("sources/adaptive", "expand.wgsl"),
    file!("sources/adaptive", "surface_id.wgsl"),
    file!("sources/adaptive", "vertex_keys.wgsl"),
    file!("sources/adaptive", "surface_key.wgsl"),
    file!("sources/prerefined", "prerefined.wgsl"),
    file!("sources/markers", "markers.wgsl"),
    file!("sources/markers", "marker_id.wgsl"),
    file!("sources/markers", "marker_keys.wgsl"),
    file!("sources/meshes", "meshes.wgsl"),
    file!("sources/meshes", "sheets.wgsl"),
    file!("sources/meshes", "mesh_id.wgsl"),
    file!("sources/meshes", "mesh_keys.wgsl"),
    file!("sources/budgeted", "budgeted.wgsl"),
    file!("sources/budgeted", "selection.wgsl"),
    file!("sources/budgeted", "candidates.wgsl"),
    file!("sources/budgeted", "select.wgsl"),
    file!("sources/budgeted", "visible_chunks.wgsl"),
    file!("sources/budgeted", "visible_chunks_id.wgsl"),
    file!("sources/budgeted", "visible_chunk_keys.wgsl"),
    file!("shading", "shade.wgsl"),
    file!("shading", "lighting.wgsl"),
    file!("shading", "keyed.wgsl"),
    file!("shading", "srgb.wgsl"),
    file!("shading", "finish.wgsl"),
    file!("shading", "blocks.wgsl"),
    file!("shading", "occlusion.wgsl"),
    file!("shading", "obscurance.wgsl"),
    file!("shading", "gather.wgsl"),
    file!("shading", "accumulate.wgsl"),
    file!("shading", "mask.wgsl"),
    file!("shading", "present.wgsl"),
    file!("output", "ids.wgsl"),
    file!("output/composite", "composite.wgsl"),
    file!("output/static_picture", "collect.wgsl"),
    file!("output/static_picture", "recolor.wgsl"),
];

/// A shader file of this crate.
///
/// # Panics
/// If there is no file of that name: a bug.
pub(crate) fn file(name: &str) -> WgslFile {
    let found = FILES.iter().find(|file| file.name == name);
    *found.unwrap_or_else(|| panic!("no shader file {name}"))
}

/// A shader composed of these parts and all that they import.
pub(crate) fn shader(name: &'static str, parts: &ShaderParts) -> Shader {
    compose(name, parts, &[&FILES, &gpu::FILES])
}

impl Gpu {
    /// Compiles a shader. Errors of the compiler, which [`Gpu::check`] returns, name file and line.
    pub(crate) fn shader_module(&self, shader: &Shader) -> wgpu::ShaderModule {
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(shader.name),
            source: wgpu::ShaderSource::Wgsl(shader.text.as_str().into()),
        };
        let module = self.caught(|| self.device.create_shader_module(descriptor));
        // Others compile beside it.
        let label = format!("'{}'", shader.name);
        self.explain_fault(|message| match message.contains(&label) {
            true => shader.explain(message),
            false => message.to_owned(),
        });
        module
    }
}
