// The color keys of a quad of visible_chunks.wgsl. Called by keyed.wgsl.

#import visible_chunks.wgsl
#import surface_keys.wgsl

fn surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys {
    let place = quad_place(vertex_index, instance_index);
    if (place >= quads[0]) {
        return SurfaceKeys(vec4<u32>(0u), 0u, 0u);
    }
    let visible_chunk = visible_chunks[quads[place + 1u]];
    let chunk = chunks[visible_chunk.chunk];
    let index = place - visible_chunk.first;
    let level = lod_level(visible_chunk.lod);
    let halvings = lod_halvings(visible_chunk.lod);
    let strips = max(lod_strips(visible_chunk.lod), 1u);
    let tube_quads = (segments(chunk, level) << halvings) * strips;
    if (lod_what(visible_chunk.lod) != WHAT_TUBE) {
        return SurfaceKeys(vec4(color_key_at(chunk, 0u)), 0u, visible_chunk.instance);
    }
    if (index >= tube_quads) {
        let end = stored(chunk, 0u, cap_point(chunk, index - tube_quads)).point;
        return SurfaceKeys(vec4(color_key_at(chunk, end)), 0u, visible_chunk.instance);
    }
    let segment = (index / strips) >> halvings;
    let part = index / strips + u32((vertex_index & 3u) >= 2u) - (segment << halvings);
    let start = color_key_at(chunk, stored(chunk, level, segment).point);
    let end = color_key_at(chunk, stored(chunk, level, segment + 1u).point);
    // As `station` chooses: the middle belongs to the start.
    let corner = select(0u, 2u, 2u * part > (1u << halvings));
    return SurfaceKeys(vec4(start, start, end, end), corner, visible_chunk.instance);
}
