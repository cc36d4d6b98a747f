// The picking id of a vertex of visible_chunks.wgsl. Called by ids.wgsl; pick.rs reads the ids.

#import visible_chunks.wgsl

// First: the instance. Second: the chunk, and the point at the end of the segment.
fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    let place = quad_place(vertex_index, instance_index);
    if (place >= quads[0]) {
        return vec2<u32>(0u);
    }
    let visible_chunk = visible_chunks[quads[place + 1u]];
    return vec2<u32>(visible_chunk.instance, (visible_chunk.chunk << POINT_BITS) | leads_to(visible_chunk, place - visible_chunk.first));
}

fn leads_to(visible_chunk: VisibleChunk, index: u32) -> u32 {
    if (lod_what(visible_chunk.lod) != WHAT_TUBE) {
        return 0u;
    }
    let chunk = chunks[visible_chunk.chunk];
    let level = lod_level(visible_chunk.lod);
    let halvings = lod_halvings(visible_chunk.lod);
    let strips = max(lod_strips(visible_chunk.lod), 1u);
    let tube_quads = (segments(chunk, level) << halvings) * strips;
    if (index < tube_quads) {
        return stored(chunk, level, ((index / strips) >> halvings) + 1u).point;
    }
    return cap_point(chunk, index - tube_quads);
}
