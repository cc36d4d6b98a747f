// Color keys of a marker's vertex: one. Called by keyed.wgsl.

#import markers.wgsl
#import surface_keys.wgsl

fn surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys {
    let key = markers[instance_index].color_key;
    return SurfaceKeys(vec4(key), 0u, NO_INSTANCE);
}
