// Who makes vertices: on the fly, from the resident patch and its decided levels.
//
// `surface_vertex` is the seam to whatever shades (maker.rs); SurfaceVertex comes before. Called with
// the builtin indices of a draw that refiner.rs sets up. The index buffer (grids.rs) hands out vertex indices that say which bucket, which
// patch of the instance, and which column and row of its grid.

struct Bucket {
    start: u32,
    count: u32,
    together: u32,
    indices: u32,
    first_index: u32,
}

@group(0) @binding(4) var<uniform> frame: Frame;
@group(0) @binding(5) var<storage, read> placed: array<Placed>;
@group(0) @binding(6) var<storage, read> owners: array<u32>;
@group(0) @binding(7) var<storage, read> list: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read> buckets: array<Bucket>;

fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let bucket = buckets[vertex_index >> INDEX_BUCKET_SHIFT];
    let k = (vertex_index >> INDEX_PATCH_SHIFT) & INDEX_PATCH_MASK;
    let place = instance_index * bucket.together + k;
    if (place >= bucket.count) {
        // The last instance is not full: triangles without area.
        let nowhere = vec3<f32>(0.0);
        return SurfaceVertex(nowhere, nowhere, nowhere, 0.0, 0u, 0u, vec2<f32>(0.0));
    }
    let listed = list[bucket.start + place];
    let i = vertex_index & INDEX_PLACE_MASK;
    let j = (vertex_index >> INDEX_ROW_SHIFT) & INDEX_PLACE_MASK;
    if (DRAWS == DRAWS_BARE) {
        return listed_bare_vertex(listed, i, j);
    }
    if (DRAWS == DRAWS_TUBES) {
        return listed_tube_vertex(listed, i, j);
    }
    return listed_other_vertex(listed, i, j);
}

// Column i and row j of a listed patch. Those beyond its grid are the last ones.
fn listed_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    if (decided_kind(listed.y) == DECIDED_TUBE) {
        if (is_whole(listed.y)) {
            return listed_bare_vertex(listed, i, j);
        }
        return listed_tube_vertex(listed, i, j);
    }
    return listed_other_vertex(listed, i, j);
}

// A whole tube at level 1 has no vertices but those of its two rings.
fn listed_bare_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    let part = placed[owners[listed.x / CLUSTER]];
    let index = listed.x - part.first_slot;
    let point = index / 4u + min(j, 1u);
    let words = point_words(part.base, point);
    let v = ring_corner(own_ring(part.base, point, words), i & 3u);
    return SurfaceVertex(
        relative(part, v.position),
        turned(part, v.normal) / part.scale,
        relative(part, v.center),
        v.radius * part.scale,
        tube_word(part.base, words),
        part.instance,
        vec2<f32>(f32(i), -f32(j)),
    );
}

fn listed_tube_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    let part = placed[owners[listed.x / CLUSTER]];
    let levels = decided_levels(listed.y);
    let grid = patch_grid(PATCH_LATERAL, frame.levels.caps, levels);
    let column = min(i, grid.nx);
    let row = min(j, grid.ny);
    let index = listed.x - part.first_slot;
    let v = tube_vertex(part.base, index, frame.levels, levels, grid, column, row);
    return SurfaceVertex(
        relative(part, v.position),
        turned(part, v.normal) / part.scale,
        relative(part, v.axis),
        v.radius * part.scale,
        tube_word(part.base, v.words),
        part.instance,
        wire_grid(PATCH_LATERAL, grid, column, row),
    );
}

fn listed_other_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    let part = placed[owners[listed.x / CLUSTER]];
    let base = part.base;
    let levels = decided_levels(listed.y);
    let grid = patch_grid(decided_kind(listed.y), frame.levels.caps, levels);
    let p = patch_at(base, listed.x - part.first_slot);
    let column = min(i, grid.nx);
    let row = min(j, grid.ny);
    let v = grid_vertex(base, p, frame.levels, levels, grid, column, row);
    return SurfaceVertex(
        relative(part, v.position),
        turned(part, v.normal) / part.scale,
        relative(part, v.axis),
        v.radius * part.scale,
        word_of(base, v.nearest),
        part.instance,
        wire_grid(p.kind, grid, column, row),
    );
}

// Coordinates whose sum is whole on the diagonals that grids.rs draws: rising, or on round patches
// towards the corners.
fn wire_grid(kind: u32, grid: Grid, i: u32, j: u32) -> vec2<f32> {
    if (kind == PATCH_LATERAL || ((grid.nx | grid.ny) & 1u) == 1u) {
        return vec2<f32>(f32(i), -f32(j));
    }
    let middle = vec2<f32>(f32(grid.nx / 2u), f32(grid.ny / 2u));
    let from_middle = abs(vec2<f32>(f32(i), f32(j)) - middle);
    return vec2<f32>(from_middle.x, -from_middle.y);
}
