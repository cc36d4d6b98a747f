//! The shaders' text is valid in every language, and its structs are ours.
use neurotess_refine::assert_layout;
use neurotess_refine::gpu::{self, GpuLodCriterion, GpuLodView};
use neurotess_refine::testing;
use neurotess_refine::wgsl::{Shader, ShaderParts, WgslFile, compose};

/// Uses every twin, so that no function escapes translation.
const ENTRY: &str = "#import plan.wgsl
#import corner_source.wgsl
struct Asked { view: LodView, levels: LodCriterion, base: Base }
@group(0) @binding(1) var<storage, read> asked: Asked;
@group(0) @binding(2) var<storage, read_write> out: array<SurfacePoint>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let p = patch_at(asked.base, id.x);
    let levels = side_levels(asked.base, p, asked.levels, asked.view);
    let grid = patch_grid(p.kind, asked.levels.caps, levels);
    out[id.x] = grid_vertex(asked.base, p, asked.levels, levels, grid, id.y, id.z);
}
";

fn twins() -> Shader {
    let entry = WgslFile {
        name: "entry.wgsl",
        text: ENTRY,
    };
    let mut parts = ShaderParts::new(&[entry]);
    parts.constants = gpu::constants();
    compose("twins", &parts, &[&gpu::FILES])
}

#[neurotess_testing::test]
fn twins_are_valid_in_every_language() {
    testing::check(&twins());
}

#[neurotess_testing::test]
fn structs_have_one_layout() {
    let (module, _) = testing::check(&twins());
    assert_layout!(
        &module,
        "LodCriterion",
        GpuLodCriterion,
        [kind, level, amount, path, caps]
    );
    let (fields, size) = testing::fields(&module, "LodView");
    let names: Vec<&str> = fields.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["eye", "slope", "forward", "flat", "near"]);
    assert_eq!(size, size_of::<GpuLodView>());
    let offsets: Vec<usize> = fields.iter().map(|&(_, offset, _)| offset).collect();
    let ours = [
        std::mem::offset_of!(GpuLodView, eye),
        std::mem::offset_of!(GpuLodView, slope),
        std::mem::offset_of!(GpuLodView, forward),
        std::mem::offset_of!(GpuLodView, flat),
        std::mem::offset_of!(GpuLodView, near),
    ];
    assert_eq!(offsets, ours);
}
