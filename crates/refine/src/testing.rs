//! For tests of shaders: parses and validates them, and translates them into all languages that
//! wgpu may need.

use naga::back::{glsl, hlsl, msl, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, TypeInner};

use crate::wgsl::Shader;

pub use naga;

/// Parses a shader and translates it into SPIR-V (Vulkan), MSL (Metal), HLSL (DirectX 12) and GLSL
/// ES 3.2. Returns the module and the validator's information about it.
///
/// # Panics
/// With file and line, if the shader is not valid in one of these languages.
pub fn check(shader: &Shader) -> (Module, ModuleInfo) {
    let Shader { name, text, .. } = shader;
    let module = match naga::front::wgsl::parse_str(text) {
        Ok(module) => module,
        Err(error) => panic!("{name}: {}", shader.explain(&error.emit_to_string(text))),
    };
    let info = Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{name}: {}", shader.explain(&e.emit_to_string(text))));
    let spirv = spv::write_vec(&module, &info, &spv::Options::default(), None);
    assert!(!spirv.expect("SPIR-V").is_empty(), "{name}");
    let options = msl::Options {
        lang_version: (2, 4),
        fake_missing_bindings: true,
        ..msl::Options::default()
    };
    let written = msl::write_string(&module, &info, &options, &msl::PipelineOptions::default());
    assert!(!written.expect("MSL").0.is_empty(), "{name}");
    let mut out = String::new();
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        fake_missing_bindings: true,
        ..hlsl::Options::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    hlsl::Writer::new(&mut out, &options, &pipeline)
        .write(&module, &info, None)
        .expect("HLSL");
    assert!(!out.is_empty(), "{name}");
    for entry in &module.entry_points {
        let mut out = String::new();
        let options = glsl::Options {
            version: glsl::Version::new_gles(320),
            ..glsl::Options::default()
        };
        let pipeline = glsl::PipelineOptions {
            shader_stage: entry.stage,
            entry_point: entry.name.clone(),
            multiview: None,
        };
        let policies = naga::proc::BoundsCheckPolicies::default();
        glsl::Writer::new(&mut out, &module, &info, &options, &pipeline, policies)
            .and_then(|mut writer| writer.write())
            .unwrap_or_else(|error| panic!("{name}, {}: GLSL: {error}", entry.name));
        assert!(!out.is_empty(), "{name}");
    }
    (module, info)
}

/// Name, offset and size of each field of a struct, and the size of the whole.
///
/// # Panics
/// If the shader has no such struct.
pub fn fields(module: &Module, name: &str) -> (Vec<(String, usize, usize)>, usize) {
    let found = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some((_, ty)) = found else {
        panic!("no struct {name} in the shader");
    };
    let TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct");
    };
    let fields = members.iter().map(|member| {
        let size = module.types[member.ty].inner.size(module.to_ctx());
        (
            member.name.clone().unwrap_or_default(),
            member.offset as usize,
            size as usize,
        )
    });
    (fields.collect(), *span as usize)
}

/// Asserts that a Rust struct and the WGSL struct of a given name have the same fields at the same
/// offsets. Rust fields named `pad…` fill what WGSL leaves empty.
#[macro_export]
macro_rules! assert_layout {
    ($module:expr, $wgsl:literal, $rust:ty, [$($field:ident),+ $(,)?]) => {{
        let value = <$rust as Default>::default();
        let ours = vec![$((
            stringify!($field).to_string(),
            std::mem::offset_of!($rust, $field),
            size_of_val(&value.$field),
        )),+];
        let (theirs, size) = $crate::testing::fields($module, $wgsl);
        assert_eq!(ours, theirs, "fields of {}", $wgsl);
        assert_eq!(size_of::<$rust>(), size, "size of {}", $wgsl);
    }};
}
