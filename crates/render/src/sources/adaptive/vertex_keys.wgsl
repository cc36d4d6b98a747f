// The color keys of a vertex's patch; indices are those of `surface_vertex` in vertices.wgsl. Called
// by keyed.wgsl.

#import vertices.wgsl
#import surface_keys.wgsl

#ifdef DRAWS_FLAT
fn surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys {
    let slot = vertex_index & ((1u << FLAT_CORNER_SHIFT) - 1u);
    return keys_of_patch(slot, vertex_index >> FLAT_CORNER_SHIFT);
}
#else
fn surface_keys(vertex_index: u32, instance_index: u32) -> SurfaceKeys {
    let bucket = buckets[vertex_index >> INDEX_BUCKET_SHIFT];
    let k = (vertex_index >> INDEX_PATCH_SHIFT) & INDEX_PATCH_MASK;
    let place = instance_index * bucket.together + k;
    if (place >= bucket.count) {
        return SurfaceKeys(vec4<u32>(0u), 0u, 0u);
    }
    let listed = list[bucket.start + place];
    let i = vertex_index & INDEX_PLACE_MASK;
    let j = (vertex_index >> INDEX_ROW_SHIFT) & INDEX_PLACE_MASK;
    return keys_of_drawn(listed, i, j);
}
#endif

#ifdef DRAWS_TUBES
fn keys_of_drawn(listed: vec2<u32>, i: u32, j: u32) -> SurfaceKeys {
    let levels = decided_levels(listed.y);
    let grid = patch_grid(PATCH_LATERAL, frame.levels.caps, levels);
    return keys_of_tube(listed.x / 4u, levels, grid, min(i, grid.nx), min(j, grid.ny));
}
#else
fn keys_of_drawn(listed: vec2<u32>, i: u32, j: u32) -> SurfaceKeys {
    let part = placed[owners[listed.x / CLUSTER]];
    let levels = decided_levels(listed.y);
    let grid = patch_grid(decided_kind(listed.y), frame.levels.caps, levels);
    let p = patch_at(part.base, listed.x - part.first_slot);
    let v = grid_vertex(part, p, frame.levels, levels, grid, min(i, grid.nx), min(j, grid.ny));
    var corner = 0u;
    for (var c = 1u; c < 4u; c += 1u) {
        corner = select(corner, c, p.corners[c] == v.shown);
    }
    return keys_of_patch(listed.x, corner);
}
#endif

fn keys_of_patch(slot: u32, corner: u32) -> SurfaceKeys {
    let part = placed[owners[slot / CLUSTER]];
    let p = patch_at(part.base, slot - part.first_slot);
    var keys: vec4<u32>;
    for (var c = 0u; c < 4u; c += 1u) {
        keys[c] = coarse[coarse_index(coarse_place(part, p.corners[c]))].color_key;
    }
    return SurfaceKeys(keys, corner, part.instance);
}

// Of the tube after a ring: the same choice as in tube_vertex.
fn keys_of_tube(point: u32, levels: vec4<u32>, grid: Grid, i: u32, j: u32) -> SurfaceKeys {
    let start = coarse[point];
    let end = coarse[point + 1u].color_key;
    var y = f32(j) / f32(grid.ny);
    if (j > 0u && j < grid.ny && (i == 0u || i == grid.nx)) {
        let level = select(levels.y, levels.w, i == 0u);
        y = f32(snap(j, grid.ny, level)) / f32(level);
    }
    let corner = select(0u, 2u, y >= 0.5);
    return SurfaceKeys(vec4(start.color_key, start.color_key, end, end), corner, start.instance);
}
