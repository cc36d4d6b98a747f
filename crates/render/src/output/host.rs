//! The shaders of pictures for a host that is not this crate: a browser, whose own WebGPU runs them.
//!
//! Such a host makes the buffers and encodes the passes itself, in the order of `sources/adaptive/passes.rs` and
//! `output/progressive/draw.rs`. The scene has a color key of its own for each tracing point, a category, so that
//! colors are chosen, and things hidden, by the color table alone; and so that a picking id is that key.

use neurotess_refine::wgsl::{Shader, ShaderParts, WgslFile};

use crate::gpu::shader;
use crate::output::ids::ids_shader;
use crate::shading::finish::{Last, finish_shader, occlusion_constants};
use crate::shading::shade::{GUARD, PipelineKey, constants, shade_shader};
use crate::sources::adaptive::grids::{GRID_SIZE, VERTICES_TOGETHER};
use crate::sources::adaptive::passes::{ENTRIES, modules};
use crate::sources::adaptive::refiner::Refiner;
use crate::sources::adaptive::settings::{self, FlatIndices};
use crate::sources::adaptive::work::QUEUE_U32S;
use crate::sources::markers;
use neurotess_picture::{HALF_WIDTH, KEY};

/// Samples of a pixel in each step.
const SAMPLES: u32 = 4;

/// The modules of the selection.
pub fn selection_shaders() -> Vec<Shader> {
    modules().into()
}

/// Entry points of the selection, in the order in which they run: index of the module, name, and number of
/// buffers in group 2.
pub fn selection_entries() -> &'static [(usize, &'static str, u32)] {
    &ENTRIES
}

/// The shaders that draw: patches at level 1, tubes, all else. Entry points `vertex` and `fragment`.
pub fn drawing_shaders() -> Vec<Shader> {
    let key = PipelineKey {
        samples: SAMPLES,
        ..PipelineKey::default()
    };
    let hiding = |kind| {
        let mut parts = Refiner::vertex_shader(kind);
        parts.constants.flag("HIDES");
        shade_shader(&parts, key)
    };
    (0..Refiner::SHADERS).map(hiding).collect()
}

/// The shader that draws markers. Entry points as those of [`drawing_shaders`].
pub fn marker_shader() -> Shader {
    let key = PipelineKey {
        samples: SAMPLES,
        ..PipelineKey::default()
    };
    shade_shader(&markers::vertex_shader(), key)
}

/// The shaders that draw picking ids: second the color key. Entry points `vertex_id` and `fragment_id`.
pub fn id_shaders() -> Vec<Shader> {
    let of_kind = |kind| {
        let mut parts = Refiner::vertex_shader(kind);
        parts.constants.flag("HIDES");
        ids_shader(&parts, shader::file("surface_key.wgsl"))
    };
    (0..Refiner::SHADERS).map(of_kind).collect()
}

/// The passes after the drawing.
pub fn finishing_shader() -> Shader {
    finish_shader(SAMPLES, Last::Accumulate)
}

/// A host's own shader, which may import the files of this crate and of `refine`.
pub fn composed(name: &'static str, files: &[WgslFile]) -> Shader {
    let mut parts = ShaderParts::new(files);
    parts.constants = neurotess_refine::gpu::constants();
    parts.constants.extend(&constants(PipelineKey {
        samples: 1,
        ..PipelineKey::default()
    }));
    parts.constants.extend(&occlusion_constants());
    shader::shader(name, &parts)
}

/// Numbers that a host needs for buffers and uniforms, by name: all constants of the shaders, and a few of ours.
pub fn numbers() -> Vec<(String, f64)> {
    let key = PipelineKey {
        samples: SAMPLES,
        ..PipelineKey::default()
    };
    let mut numbers = settings::constants().numbers();
    numbers.extend(constants(key).numbers());
    numbers.extend(markers::vertex_shader().constants.numbers());
    numbers.extend(
        [
            ("QUEUE_U32S", QUEUE_U32S as f64),
            ("FLAT_CORNERS", f64::from(FlatIndices::Corners as u32)),
            ("VERTICES_TOGETHER", f64::from(VERTICES_TOGETHER)),
            ("GUARD", f64::from(GUARD)),
            ("HALF_WIDTH", f64::from(HALF_WIDTH)),
        ]
        .map(|(name, value)| (name.to_owned(), value)),
    );
    numbers
}

/// Sizes of the grids' axes.
pub fn grid_sizes() -> &'static [u32] {
    &GRID_SIZE
}

/// Direction of the key light, not of unit length.
pub fn key_light() -> [f32; 3] {
    KEY.to_array()
}
