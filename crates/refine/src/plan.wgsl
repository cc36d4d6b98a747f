// The grid of a patch and its vertices.
//
// Imported by all shaders that evaluate patches. Rust twin: plan.rs; that numbers the vertices of
// the whole surface, while this evaluates one vertex of one patch's grid, which is the same point.
// Corners come from a CornerSource: the packed mesh (corner_source.wgsl), or corners that a
// renderer has computed.

#import level.wgsl
#import template.wgsl

// A side of a patch as an edge in its own direction.
struct Side {
    start: u32,
    end: u32,
    kind: u32,
    reversed: bool,
}

struct Grid {
    nx: u32,
    ny: u32,
}

struct SurfacePoint {
    position: vec3<f32>,
    normal: vec3<f32>,
    // Point of the tube's center line and the radius there; a radius of 0 on somata.
    axis: vec3<f32>,
    radius: f32,
    // The vertex whose attributes it has.
    shown: u32,
}

fn patch_side(base: Base, p: Patch, index: u32) -> Side {
    var start = p.corners.x;
    var end = p.corners.y;
    if (index == 1u) {
        start = p.corners.y;
        end = p.corners.z;
    } else if (index == 2u) {
        start = p.corners.w;
        end = p.corners.z;
    } else if (index == 3u) {
        start = p.corners.x;
        end = p.corners.w;
    }
    if (p.kind == PATCH_LATERAL && (index & 1u) == 1u) {
        return Side(start, end, EDGE_ALONG, false);
    }
    if (p.kind == PATCH_LOFT && (index & 1u) == 1u) {
        return Side(start, end, EDGE_LOFT, false);
    }
    var kind = EDGE_RING;
    if (p.kind == PATCH_SOMA || p.kind == PATCH_LOFT) {
        let around = tracing_of(base, start) == tracing_of(base, end);
        let role = role_of(base, start);
        if (!around || role == ROLE_SOMA) {
            // The side of a trunk's quad is as in the tube beside it.
            let tube = p.kind == PATCH_LOFT && role == ROLE_ORDINARY
                && role_of(base, end) == ROLE_ORDINARY;
            kind = select(EDGE_SOMA, EDGE_ALONG, tube);
        }
    }
    if (start < end) {
        return Side(start, end, kind, false);
    }
    return Side(end, start, kind, true);
}

// Levels of the four sides. A loop, so that the same code decides for both patches beside an edge.
fn side_levels(base: Base, p: Patch, levels: LodCriterion, view: LodView) -> vec4<u32> {
    var found = vec4<u32>(1u);
    for (var index = 0u; index < 4u; index += 1u) {
        let s = patch_side(base, p, index);
        let a = corner(base, s.start);
        let b = corner(base, s.end);
        found[index] = edge_level(
            levels, view, s.kind, a, value_of(base, s.start), b, value_of(base, s.end));
    }
    return found;
}

fn finer(n: u32) -> u32 {
    if (n > 1u) {
        return min(2u * n, HIGHEST_LEVEL);
    }
    return 1u;
}

fn patch_grid(kind: u32, caps: u32, levels: vec4<u32>) -> Grid {
    let nx = max(levels.x, levels.z);
    let ny = max(levels.y, levels.w);
    if (kind == PATCH_CAP && caps == CAPS_ROUND) {
        // A half sphere turns by 180 degrees where the ring's side turns by 90.
        let n = finer(max(nx, ny));
        return Grid(n, n);
    }
    return Grid(nx, ny);
}

// The vertex of an edge of `level` parts that is nearest to vertex i of n parts. If level <= n,
// every vertex of the edge is the nearest of some i.
fn snap(i: u32, n: u32, level: u32) -> u32 {
    return (2u * i * level + n) / (2u * n);
}

// Vertex at column i and row j of a patch's grid. On a side it is that of the side's edge.
fn grid_vertex(
    source: CornerSource,
    p: Patch,
    options: LodCriterion,
    levels: vec4<u32>,
    grid: Grid,
    i: u32,
    j: u32,
) -> SurfacePoint {
    var index = 4u;
    var place = i;
    var count = grid.nx;
    var level = 1u;
    if (j == 0u) {
        index = 0u;
        level = levels.x;
    } else if (j == grid.ny) {
        index = 2u;
        level = levels.z;
    } else if (i == 0u) {
        index = 3u;
        level = levels.w;
    } else if (i == grid.nx) {
        index = 1u;
        level = levels.y;
    }
    if (index == 4u) {
        return inner_vertex(source, p, options, grid, i, j);
    }
    if ((index & 1u) == 1u) {
        place = j;
        count = grid.ny;
    }
    place = snap(place, count, level);
    let s = patch_side(base_of(source), p, index);
    if (s.reversed) {
        place = level - place;
    }
    return edge_vertex(source, options, s, place, level);
}

// Vertex k of an edge of `level` parts, both ends included.
fn edge_vertex(source: CornerSource, options: LodCriterion, s: Side, k: u32, level: u32) -> SurfacePoint {
    if (k == 0u || k == level) {
        return coarse_vertex(source, select(s.end, s.start, k == 0u));
    }
    let a = corner_of(source, s.start);
    let b = corner_of(source, s.end);
    let t = f32(k) / f32(level);
    let jet = edge(s.kind, a, b, options.path, t);
    let normal = edge_normal(s.kind, a, b, jet.derivative, t);
    var shown = select(s.start, s.end, t >= border_of(s.kind, a, a, b, b, 0.0, level));
    if (s.kind == EDGE_SOMA) {
        // A soma's edges belong to the soma up to the neurite's ring.
        if (a.role == ROLE_SOMA) {
            shown = s.start;
        } else if (b.role == ROLE_SOMA) {
            shown = s.end;
        }
        return SurfacePoint(jet.position, normal, jet.position, 0.0, shown);
    }
    if (s.kind == EDGE_LOFT) {
        let ends = vec2<f32>(1.0 - t, t);
        let axis = axis_of(a) * ends.x + axis_of(b) * ends.y;
        return SurfacePoint(jet.position, normal, axis, dot(vec2(width_of(a), width_of(b)), ends), shown);
    }
    if (s.kind == EDGE_RING) {
        return SurfacePoint(jet.position, normal, a.center, a.radius, shown);
    }
    let axis = center_line(a, b, options.path, t).position;
    let radius = profile_radius(profile_between(a, b, options.path), t);
    return SurfacePoint(jet.position, normal, axis, radius, shown);
}

// How far along the way to a corner, of so many parts, the corner shows. Rust twin: border.rs.
fn along_border(before: Corner, to: Corner, parts: u32) -> f32 {
    // What leads from a joint to a branch is the branch's.
    if (before.role == ROLE_JOINT) {
        return 0.0;
    }
    let border = abs(to.collar) + (0.5 * sign(to.collar) - CLEAR_OF_ROWS) / f32(parts);
    return select(border, 0.5, to.role == ROLE_INSET || to.collar == 0.0);
}

// The y from which on vertices of an edge or a patch of so many rows show its second side: of a loft the branch, at x between
// the trunk's corners a and b and the inset's d and c. Rust twin: border.rs, with the theory.
fn border_of(kind: u32, a: Corner, b: Corner, c: Corner, d: Corner, x: f32, rows: u32) -> f32 {
    if (kind != EDGE_LOFT) {
        return along_border(a, d, rows);
    }
    let offset = blend(a.offset, b.offset, x);
    let size = length(a.offset) * (1.0 - x) + length(b.offset) * x;
    let near = blend(a.center, b.center, x) + normalize_or(offset, a.radial) * size;
    let far = max(length(cross(near - c.center, c.tangent)) - c.radius, c.radius * 1e-3);
    let height = inset_height(a, d) * (1.0 - x) + inset_height(b, c) * x;
    var left = 2.0 / 3.0;
    if (a.role == ROLE_SOMA) {
        left = min(SOMA_FILLET * c.radius / far, left);
    }
    let lifted = max(height, c.radius * LEAST_LIFT);
    let border = 1.0 / (1.0 + sqrt(BORDER_CUBIC / 3.0 * lifted / (far * left)));
    let half = 0.5 / f32(rows);
    return border + select(half, -half, a.role == ROLE_SOMA || c.collar < 0.0);
}

// How far an inset's corner is off the cone of the trunk's corner.
fn inset_height(trunk: Corner, inset: Corner) -> f32 {
    let from_center = inset.position - trunk.center;
    if (trunk.role == ROLE_SOMA) {
        return length(from_center) - length(trunk.offset);
    }
    return length(cross(from_center, trunk.tangent)) - trunk.radius;
}

// Point of the center line at a corner, and the radius there: somata have none.
fn axis_of(k: Corner) -> vec3<f32> {
    return select(k.center, k.position, k.role == ROLE_SOMA);
}

fn width_of(k: Corner) -> f32 {
    return select(k.radius, 0.0, k.role == ROLE_SOMA);
}

fn coarse_vertex(source: CornerSource, vertex: u32) -> SurfacePoint {
    let k = corner_of(source, vertex);
    return SurfacePoint(k.position, k.normal, axis_of(k), width_of(k), vertex);
}

fn inner_vertex(
    source: CornerSource,
    p: Patch,
    options: LodCriterion,
    grid: Grid,
    i: u32,
    j: u32,
) -> SurfacePoint {
    let x = f32(i) / f32(grid.nx);
    let y = f32(j) / f32(grid.ny);
    let shape = patch_shape(source, p);
    let inside = interior(shape, options.path, options.caps, x, y);
    // Where a loft's trunk changes, as the tube beside it does. Of others both corners show the same.
    var middle = along_border(shape.a, shape.b, grid.nx);
    if (p.corners.x > p.corners.y) {
        middle = 1.0 - along_border(shape.b, shape.a, grid.nx);
    }
    let column = select(p.corners.xw, p.corners.yz, x >= middle);
    let border = border_of(p.kind, shape.a, shape.b, shape.c, shape.d, x, grid.ny);
    var shown = select(column.x, column.y, y >= border);
    if (p.kind == PATCH_SOMA) {
        shown = first_of_soma(shape, p, shown);
        return SurfacePoint(inside.position, inside.normal, inside.position, 0.0, shown);
    }
    var radius = (width_of(shape.a) * (1.0 - x) + width_of(shape.b) * x) * (1.0 - y)
        + (shape.d.radius * (1.0 - x) + shape.c.radius * x) * y;
    var axis = shape.a.center;
    if (p.kind == PATCH_LOFT) {
        let near = blend(axis_of(shape.a), axis_of(shape.b), x);
        axis = blend(near, shape.c.center, y);
    }
    if (p.kind == PATCH_LATERAL) {
        axis = center_line(shape.a, shape.d, options.path, y).position;
        radius = profile_radius(profile_between(shape.a, shape.d, options.path), y);
    }
    return SurfacePoint(inside.position, inside.normal, axis, radius, shown);
}

fn first_of_soma(shape: PatchShape, p: Patch, otherwise: u32) -> u32 {
    if (shape.a.role == ROLE_SOMA) {
        return p.corners.x;
    }
    if (shape.b.role == ROLE_SOMA) {
        return p.corners.y;
    }
    if (shape.c.role == ROLE_SOMA) {
        return p.corners.z;
    }
    if (shape.d.role == ROLE_SOMA) {
        return p.corners.w;
    }
    return otherwise;
}

fn patch_shape(source: CornerSource, p: Patch) -> PatchShape {
    return PatchShape(
        p.kind,
        corner_of(source, p.corners.x),
        corner_of(source, p.corners.y),
        corner_of(source, p.corners.z),
        corner_of(source, p.corners.w),
        vec4<u32>(
            side_bits(patch_side(base_of(source), p, 0u)),
            side_bits(patch_side(base_of(source), p, 1u)),
            side_bits(patch_side(base_of(source), p, 2u)),
            side_bits(patch_side(base_of(source), p, 3u)),
        ),
    );
}

fn side_bits(s: Side) -> u32 {
    return select(s.kind, s.kind | SIDE_REVERSED, s.reversed);
}
