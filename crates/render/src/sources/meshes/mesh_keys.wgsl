// Color keys of a mesh's vertex: one, which a triangle takes from its first. Called by keyed.wgsl.

#import meshes.wgsl
#import surface_keys.wgsl

fn surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys {
    return SurfaceKeys(vec4(mesh_key(mesh_index(vertex_index))), 0u, NO_INSTANCE);
}
