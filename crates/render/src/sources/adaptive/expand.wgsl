// Stores the vertices that a draw would compute, with the functions of its vertex shader.
//
// Called by expand.rs.

#import vertices.wgsl

struct GridPoint {
    // A patch, column and row.
    slot: u32,
    decided: u32,
    i: u32,
    j: u32,
}

@group(1) @binding(0) var<storage, read> wanted: array<GridPoint>;
@group(1) @binding(1) var<storage, read_write> made: array<SurfaceVertex>;

@compute @workgroup_size(64)
fn expand(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x + id.y * 64u * EXPAND_ROW;
    if (index < arrayLength(&wanted)) {
        let w = wanted[index];
        made[index] = listed_vertex(vec2<u32>(w.slot, w.decided), w.i, w.j);
    }
}
