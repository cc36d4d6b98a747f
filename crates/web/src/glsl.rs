//! GLSL ES 3.00 for WebGL, from WGSL by naga.

use std::collections::BTreeMap;

use naga::back::glsl::{Options, PipelineOptions, Version, Writer, WriterFlags};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, GlobalVariable, Handle, Module, ShaderStage};
use serde::Serialize;

use crate::error::WebError;
use crate::minified;
use crate::shortened::{Language, shortened};

/// A program of two stages.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct GlslProgram {
    pub(crate) vertex: String,
    pub(crate) fragment: String,
    /// Names in GLSL of uniform blocks and textures, by their names in WGSL.
    names: BTreeMap<String, Vec<String>>,
}

/// Translates a vertex and a fragment stage: the texts that have them, and their entry points.
pub(crate) fn glsl(
    name: &str,
    texts: [&str; 2],
    entries: [&str; 2],
) -> Result<GlslProgram, WebError> {
    let mut names = BTreeMap::new();
    let mut stage = |k: usize, stage| {
        let fault = |said: String| WebError::Shader(format!("{name}: {said}"));
        let (text, entry) = (texts[k], entries[k]);
        let module = naga::front::wgsl::parse_str(text);
        let mut module = module.map_err(|e| fault(e.emit_to_string(text)))?;
        // naga writes all functions, whether they are called or not.
        module.entry_points.retain(|point| point.name == entry);
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
        let info = validator.validate(&module);
        let info = info.map_err(|e| fault(e.emit_to_string(text)))?;
        let written = stage_text(&module, &info, stage, entry, &mut names);
        written.map_err(|e| fault(e.to_string()))
    };
    let stages = [
        stage(0, ShaderStage::Vertex)?,
        stage(1, ShaderStage::Fragment)?,
    ];
    // Names that the host or the other stage knows begin with an underscore or are these.
    let known: Vec<&String> = names.values().flatten().collect();
    let keeps = |name: &str| {
        let is_outside = ["_vs2fs", "_p2vs", "_fs2p", "_group", "gl_", "naga_"];
        is_outside.iter().any(|start| name.starts_with(start))
            || name == "main"
            || known.iter().any(|glsl| *glsl == name)
    };
    let [vertex, fragment] = stages.map(|text| {
        let short = shortened(&[text], Language::Glsl, keeps);
        short.into_iter().next().unwrap_or_default()
    });
    Ok(GlslProgram {
        vertex,
        fragment,
        names,
    })
}

fn stage_text(
    module: &Module,
    info: &ModuleInfo,
    stage: ShaderStage,
    entry: &str,
    names: &mut BTreeMap<String, Vec<String>>,
) -> Result<String, naga::back::glsl::Error> {
    let mut out = String::new();
    let options = Options {
        version: Version::new_gles(300),
        // Depths as they are in WGSL: the host turns them.
        writer_flags: WriterFlags::empty(),
        ..Options::default()
    };
    let pipeline = PipelineOptions {
        shader_stage: stage,
        entry_point: entry.to_owned(),
        multiview: None,
    };
    let policies = naga::proc::BoundsCheckPolicies::default();
    let mut writer = Writer::new(&mut out, module, info, &options, &pipeline, policies)?;
    let reflection = writer.write()?;
    let name_of = |handle: Handle<GlobalVariable>| {
        module.global_variables[handle]
            .name
            .clone()
            .unwrap_or_default()
    };
    for (handle, glsl) in &reflection.uniforms {
        debug_assert!(module.global_variables[*handle].space == AddressSpace::Uniform);
        names
            .entry(name_of(*handle))
            .or_default()
            .push(glsl.clone());
    }
    for (glsl, mapping) in &reflection.texture_mapping {
        let all = names.entry(name_of(mapping.texture)).or_default();
        if !all.contains(glsl) {
            all.push(glsl.clone());
        }
    }
    Ok(minified::glsl(&out))
}
