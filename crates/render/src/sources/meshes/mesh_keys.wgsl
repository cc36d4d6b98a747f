// Color keys of a mesh's vertex: one. Called by keyed.wgsl.

#import meshes.wgsl
#import surface_keys.wgsl

fn surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys {
    return SurfaceKeys(vec4(mesh_frame.color_key), 0u, NO_INSTANCE);
}
