// The quick way to a vertex of a tube between two points with rings of their own: most of all vertices.
//
// Called by what draws such patches; gives what grid_vertex of plan.wgsl gives, for a third of its work.

struct TubeVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    axis: vec3<f32>,
    radius: f32,
    // Words of the point whose attributes it has.
    words: vec4<u32>,
    // The coarse vertex that it is, or NO_VERTEX.
    coarse: u32,
}

fn tube_vertex(
    base: Base,
    index: u32,
    options: Criterion,
    levels: vec4<u32>,
    grid: Grid,
    i: u32,
    j: u32,
) -> TubeVertex {
    let near = j == 0u;
    let far = j == grid.ny;
    let on_ring = near || far;
    let on_side = !on_ring && (i == 0u || i == grid.nx);
    // Both rings of a ring's edge are the same, as are both columns of an edge along the path.
    let point = index / 4u;
    let first = select(point, point + 1u, far);
    let last = select(point + 1u, point, near);
    let first_words = point_words(base, first);
    let last_words = point_words(base, last);
    let k = index & 3u;
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
    let start = own_ring(base, first, first_words);
    let end = own_ring(base, last, last_words);
    let a = ring_corner(start, left);
    let b = ring_corner(start, right);
    let c = ring_corner(end, right);
    let d = ring_corner(end, left);
    let made = tube_point(a, b, c, d, options.path, x, y);
    var v = TubeVertex(
        made.position,
        tube_normal(made, a.normal),
        made.axis,
        start.radius * (1.0 - y) + end.radius * y,
        first_words,
        NO_VERTEX,
    );
    if (!on_ring && y >= 0.5) {
        v.words = last_words;
    }
    if (on_ring) {
        v.normal = edge_normal(a, b, made.by_x, x);
        v.axis = start.center;
        v.radius = start.radius;
        if (place == 0u) {
            v.position = a.position;
            v.normal = a.normal;
            v.coarse = 4u * first + left;
        } else if (place == level) {
            v.position = b.position;
            v.normal = b.normal;
            v.coarse = 4u * first + right;
        }
    } else if (on_side) {
        v.normal = edge_normal(a, d, made.by_y, y);
        if (place == 0u) {
            v.position = a.position;
            v.normal = a.normal;
            v.axis = start.center;
            v.coarse = 4u * first + left;
        } else if (place == level) {
            v.position = d.position;
            v.normal = d.normal;
            v.axis = end.center;
            v.coarse = 4u * last + left;
        }
    }
    return v;
}

// The renderer's word of a point.
fn tube_word(base: Base, words: vec4<u32>) -> u32 {
    return heap[base.words + (words.w >> 22u)];
}
