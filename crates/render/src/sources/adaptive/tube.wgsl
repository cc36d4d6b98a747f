// A quick way to compute the vertices of tubes between two implicit rings, which are most of all
// vertices.
//
// Called by vertices.wgsl. Returns the same as grid_vertex of plan.wgsl.

#import surface_vertex.wgsl
#import placed.wgsl
#import coarse_point.wgsl

// Column i and row j of patch k of the tube after a ring.
fn tube_vertex(point: u32, k: u32, levels: vec4<u32>, grid: Grid, i: u32, j: u32) -> SurfaceVertex {
    let near = j == 0u;
    let far = j == grid.ny;
    let on_ring = near || far;
    let on_side = !on_ring && (i == 0u || i == grid.nx);
    // For a vertex on a ring, start and end are that ring; for one on an edge along the path, left
    // and right are the same column.
    let start = drawn_ring(coarse[select(point, point + 1u, far)]);
    let end = drawn_ring(coarse[select(point + 1u, point, near)]);
    var left = k;
    var right = (k + 1u) & 3u;
    var x = f32(i) / f32(grid.nx);
    var y = f32(j) / f32(grid.ny);
    var place = 1u;
    var level = 2u;
    if (on_ring) {
        level = select(levels.x, levels.z, far);
        place = snap(i, grid.nx, level);
        // From the lower vertex to the higher.
        if (k == 3u) {
            place = level - place;
            left = 0u;
            right = 3u;
        }
        x = f32(place) / f32(level);
        y = 0.0;
    } else if (on_side) {
        level = select(levels.y, levels.w, i == 0u);
        place = snap(j, grid.ny, level);
        left = select(right, left, i == 0u);
        right = left;
        x = 0.0;
        y = f32(place) / f32(level);
    }
    let a = corner_of_ring(start, left);
    let b = corner_of_ring(start, right);
    let c = corner_of_ring(end, right);
    let d = corner_of_ring(end, left);
    let made = tube_point(a, b, c, d, frame.levels.path, x, y);
    var v = SurfaceVertex(
        made.position,
        tube_normal(made, a.normal),
        made.axis,
        made.radius,
        select(start.color_key, end.color_key, !on_ring && y >= 0.5),
        start.instance,
        wire_grid(PATCH_LATERAL, grid, i, j),
    );
    if (on_ring) {
        v.normal = edge_normal(EDGE_RING, a, b, made.by_x, x);
        v.axis = start.center;
        v.radius = start.radius;
    } else if (on_side) {
        v.normal = edge_normal(EDGE_ALONG, a, d, made.by_y, y);
    }
    // Corners are taken as they are, so that all patches around them agree to the bit.
    let at_start = (on_ring || on_side) && place == 0u;
    let at_end = (on_ring || on_side) && place == level;
    if (at_start) {
        v.position = a.position;
        v.normal = a.normal;
        v.axis = a.center;
        v.radius = a.radius;
    } else if (at_end && on_ring) {
        v.position = b.position;
        v.normal = b.normal;
    } else if (at_end) {
        v.position = d.position;
        v.normal = d.normal;
        v.axis = d.center;
        v.radius = d.radius;
    }
    return v;
}
