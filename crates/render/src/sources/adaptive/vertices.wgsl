// Computes vertices as they are drawn, from a resident patch and its decided levels.
//
// Shaders that shade call `surface_vertex` (see sources/mod.rs) with the builtin indices of a draw
// that refiner.rs sets up. A vertex index, from the index buffer of grids.rs, says which bucket,
// which patch of the instance, and which column and row of the patch's grid.

#import surface_vertex.wgsl
#import placed.wgsl
#import coarse_point.wgsl
#import tube.wgsl

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
@group(0) @binding(9) var<storage, read> coarse: array<CoarsePoint>;

// What is not drawn is left out of the shader: drivers compile both sides of a condition before they find out
// that it is constant.
#ifdef DRAWS_FLAT
fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let corner = vertex_index >> FLAT_CORNER_SHIFT;
    let named = vertex_index & ((1u << FLAT_CORNER_SHIFT) - 1u);
    return flat_vertex(named_place(named, corner), grid_of_corner(corner));
}
#else
fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let bucket = buckets[vertex_index >> INDEX_BUCKET_SHIFT];
    let k = (vertex_index >> INDEX_PATCH_SHIFT) & INDEX_PATCH_MASK;
    let place = instance_index * bucket.together + k;
    if (place >= bucket.count) {
        // The last instance has fewer patches: the rest are triangles without area.
        let nowhere = vec3<f32>(0.0);
        return SurfaceVertex(nowhere, nowhere, nowhere, 0.0, 0u, 0u, vec2<f32>(0.0));
    }
    let listed = list[bucket.start + place];
    let i = vertex_index & INDEX_PLACE_MASK;
    let j = (vertex_index >> INDEX_ROW_SHIFT) & INDEX_PLACE_MASK;
    return drawn_vertex(listed, i, j);
}
#endif

#ifdef KEYED
fn named_place(slot: u32, corner: u32) -> u32 {
    return place_of_corner(slot, corner);
}
#else
fn named_place(place: u32, corner: u32) -> u32 {
    return place;
}
#endif

#ifdef DRAWS_TUBES
fn drawn_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    return listed_tube_vertex(listed, i, j);
}
#else
fn drawn_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    return listed_other_vertex(listed, i, j);
}
#endif

// Vertex at column i and row j of a patch, given its slot and decision. Columns and rows beyond its
// grid are the last ones.
fn listed_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    if (is_flat(listed.y)) {
        return listed_flat_vertex(listed, i, j);
    }
    if (decided_kind(listed.y) == DECIDED_TUBE) {
        return listed_tube_vertex(listed, i, j);
    }
    return listed_other_vertex(listed, i, j);
}

// A patch at level 1 has no vertices but its corners.
fn listed_flat_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    let corner = select(min(i, 1u), 3u - min(i, 1u), j > 0u);
    return flat_vertex(place_of_corner(listed.x, corner), grid_of_corner(corner));
}

// Index of a corner of a patch among the corners of the batch.
fn place_of_corner(slot: u32, corner: u32) -> u32 {
    let part = placed[owners[slot / CLUSTER]];
    let p = patch_at(part.base, slot - part.first_slot);
    return coarse_place(part, p.corners[corner]);
}

fn grid_of_corner(corner: u32) -> vec2<f32> {
    return vec2<f32>(f32(corner == 1u || corner == 2u), -f32(corner >= 2u));
}

fn flat_vertex(place: u32, grid: vec2<f32>) -> SurfaceVertex {
    let point = coarse[coarse_index(place)];
    let v = corner_at(place);
    // Somata are never widened.
    let soma = v.role == ROLE_SOMA;
    return SurfaceVertex(
        v.position,
        v.normal,
        select(v.center, v.position, soma),
        select(v.radius, 0.0, soma),
        point.color_key,
        point.instance,
        grid,
    );
}

fn listed_tube_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    let levels = decided_levels(listed.y);
    let grid = patch_grid(PATCH_LATERAL, frame.levels.caps, levels);
    return tube_vertex(listed.x / 4u, listed.x & 3u, levels, grid, min(i, grid.nx), min(j, grid.ny));
}

fn listed_other_vertex(listed: vec2<u32>, i: u32, j: u32) -> SurfaceVertex {
    let part = placed[owners[listed.x / CLUSTER]];
    let levels = decided_levels(listed.y);
    let grid = patch_grid(decided_kind(listed.y), frame.levels.caps, levels);
    let p = patch_at(part.base, listed.x - part.first_slot);
    let column = min(i, grid.nx);
    let row = min(j, grid.ny);
    let v = grid_vertex(part, p, frame.levels, levels, grid, column, row);
    return SurfaceVertex(
        v.position,
        v.normal,
        v.axis,
        v.radius,
        coarse[coarse_index(coarse_place(part, v.shown))].color_key,
        part.instance,
        wire_grid(p.kind, grid, column, row),
    );
}

// What plan.wgsl takes corners from: here a placed part, with corners relative to the eye.
alias CornerSource = Placed;

fn base_of(source: CornerSource) -> Base {
    return source.base;
}

fn corner_of(source: CornerSource, vertex: u32) -> Corner {
    return corner_at(coarse_place(source, vertex));
}

fn corner_at(place: u32) -> Corner {
    let index = coarse_index(place);
    let point = coarse[index];
    if (place >= frame.first_explicit) {
        return corner_of_explicit(point, coarse[index + 1u]);
    }
    return corner_of_ring(drawn_ring(point), place & 3u);
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
