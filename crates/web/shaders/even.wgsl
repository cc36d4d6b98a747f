// Vertices of the refined surface at one level everywhere, from the packed mesh alone: what is saved as a mesh, and
// what WebGL draws, which has no passes that select levels. Rust twin: Refinement with LodCriterion::Homogeneous.
//
// The vertices of a range of slots are numbered patch by patch, row by row. Host: saving.js, webgl.js.

#import plan.wgsl
#import corner_source.wgsl

struct Even {
    // Number of subdivisions of a coarse edge.
    level: u32,
    // Columns and rows of vertices of a patch in this range, which are as many.
    columns: u32,
    // First slot of the range.
    first_slot: u32,
    // Slots of the part.
    slots: u32,
    // Vertices to be made.
    vertices: u32,
    @align(16) base: Base,
}

@group(0) @binding(1) var<uniform> even: Even;

// A vertex in eight numbers: position and radius; normal, and 1 + color key + KIND_STEP × kind of the patch, or 0
// where there is no patch.
struct EvenVertex {
    place: vec4<f32>,
    around: vec4<f32>,
}

// Color keys are below: f32 holds four times as many whole numbers.
const KIND_STEP: u32 = 1u << 21u;

fn even_vertex(index: u32) -> EvenVertex {
    let of_patch = even.columns * even.columns;
    let slot = even.first_slot + index / of_patch;
    let place = index % of_patch;
    if slot >= even.slots || !patch_exists(even.base, slot) {
        return EvenVertex(vec4(0.0), vec4(0.0));
    }
    let p = patch_at(even.base, slot);
    let levels = LodCriterion(LEVELS_HOMOGENEOUS, even.level, 0.0, PATH_HERMITE, CAPS_ROUND);
    let sides = vec4<u32>(even.level);
    let grid = patch_grid(p.kind, CAPS_ROUND, sides);
    let v = grid_vertex(even.base, p, levels, sides, grid, place % even.columns, place / even.columns);
    let key = color_key_of(even.base, v.shown) & ~CATEGORY_BIT;
    return EvenVertex(vec4(v.position, v.radius), vec4(v.normal, f32(1u + key + KIND_STEP * p.kind)));
}
