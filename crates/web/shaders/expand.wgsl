// Stores vertices of even.wgsl, for meshes that are saved. Host: saving.js.

#import even.wgsl

@group(0) @binding(2) var<storage, read_write> expanded: array<EvenVertex>;

@compute @workgroup_size(64)
fn expand(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index < even.vertices {
        expanded[index] = even_vertex(index);
    }
}
