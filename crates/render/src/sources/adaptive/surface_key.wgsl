// The color key of a vertex as its picking id, for scenes in which each tracing point has a key of its own.
// Called by ids.wgsl, in place of surface_id.wgsl.

#import vertices.wgsl

fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    return vec2<u32>(0u, surface_vertex(vertex_index, instance_index).color_key);
}
