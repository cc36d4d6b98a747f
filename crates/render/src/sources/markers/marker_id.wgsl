// The picking id of a marker's vertex. Called by ids.wgsl; mod.rs beside it reads the ids.

#import markers.wgsl

fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    return vec2<u32>(MARKER_BIT, marker_frame.first + instance_index);
}
