// The picking id of a mesh's vertex. Called by ids.wgsl; mod.rs beside it reads the ids.

#import meshes.wgsl

fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    return vec2<u32>(MESH_BIT, mesh_frame.number);
}
