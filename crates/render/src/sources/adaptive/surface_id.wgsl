// The picking id of a vertex; indices are those of `surface_vertex` in vertices.wgsl. Called by
// ids.wgsl; resolver.rs reads the ids.

#import vertices.wgsl

// First: the corner's number in its flat patch, or FINE. Second: the corner's index (coarse_place),
// or the patch's slot.
#ifdef DRAWS_FLAT
fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    let place = vertex_index & ((1u << FLAT_CORNER_SHIFT) - 1u);
    return vec2<u32>(vertex_index >> FLAT_CORNER_SHIFT, place);
}
#else
fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    let bucket = buckets[vertex_index >> INDEX_BUCKET_SHIFT];
    let k = (vertex_index >> INDEX_PATCH_SHIFT) & INDEX_PATCH_MASK;
    let place = instance_index * bucket.together + k;
    return vec2<u32>(FINE, list[bucket.start + min(place, max(bucket.count, 1u) - 1u)].x);
}
#endif
