// The refined surface as a function: edges, patches, normals.
//
// Called by the shaders that draw and by the one that expands patches for the parity test.
// Rust twin: evaluate.rs, with the theory. Constants are defined in gpu.rs.

#import profile.wgsl

struct Jet {
    position: vec3<f32>,
    derivative: vec3<f32>,
}

struct Corner {
    position: vec3<f32>,
    normal: vec3<f32>,
    center: vec3<f32>,
    offset: vec3<f32>,
    radial: vec3<f32>,
    tangent: vec3<f32>,
    radius: f32,
    role: u32,
    // Of an inset's corner: length of a loft's last leg along the tangent. Of any other: its point's border.
    collar: f32,
    // Of an ordinary tracing point or an end: change of the radius along the path.
    taper: f32,
}

fn normalize_or(v: vec3<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    let size = length(v);
    if (size > 1e-30) {
        return v * (1.0 / size);
    }
    return otherwise;
}

// Normal that the cubics of somata and lofts leave a corner across.
fn cubic_normal(corner: Corner) -> vec3<f32> {
    if (corner.role == ROLE_SOMA) {
        return corner.normal;
    }
    return corner.radial;
}

// Center line between two tracing points, y in [0, 1].
fn center_line(a: Corner, b: Corner, path: u32, y: f32) -> Jet {
    let way = b.center - a.center;
    if (path == PATH_LINEAR) {
        return Jet(a.center * (1.0 - y) + b.center * y, way);
    }
    let m0 = hermite_tangent(a, a, b);
    let m1 = hermite_tangent(b, a, b);
    let y2 = y * y;
    let y3 = y * y * y;
    let position = a.center * (2.0 * y3 - 3.0 * y2 + 1.0)
        + m0 * (y3 - 2.0 * y2 + y)
        + b.center * (3.0 * y2 - 2.0 * y3)
        + m1 * (y3 - y2);
    let derivative =
        way * (6.0 * y - 6.0 * y2) + m0 * (3.0 * y2 - 4.0 * y + 1.0) + m1 * (3.0 * y2 - 2.0 * y);
    return Jet(position, derivative);
}

// Tangent of the center line from a to b at one of its ends.
fn hermite_tangent(end: Corner, a: Corner, b: Corner) -> vec3<f32> {
    let way = b.center - a.center;
    let span = length(way);
    let direction = way / max(span, 1e-37);
    let most = MAX_SWAY * min(a.radius, b.radius) * (27.0 / 4.0);
    if (end.role == ROLE_JOINT) {
        return way;
    }
    let across = end.tangent - direction * dot(end.tangent, direction);
    let sway = length(across) * span;
    return end.tangent * (span * (most / max(max(sway, most), 1e-37)));
}

// a / |b| and its derivative.
fn over_length(a: vec3<f32>, a_dot: vec3<f32>, b: vec3<f32>, b_dot: vec3<f32>) -> Jet {
    let inverse = 1.0 / max(length(b), 1e-3);
    let derivative = a_dot * inverse - a * (dot(b, b_dot) * inverse * inverse * inverse);
    return Jet(a * inverse, derivative);
}

// With its position shortened to a length where it is longer, by the square of that.
fn within(jet: Jet, most_squared: f32) -> Jet {
    let squared = dot(jet.position, jet.position);
    if (squared <= most_squared) {
        return jet;
    }
    let along = jet.position * (dot(jet.position, jet.derivative) / squared);
    let share = sqrt(most_squared / squared);
    return Jet(jet.position * share, (jet.derivative - along) * share);
}

// The longer of the offsets of two corners of a ring.
fn longer(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return sqrt(max(dot(a, a), dot(b, b)));
}

fn blend(a: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> {
    return a * (1.0 - t) + b * t;
}

// The radius along the tube between the rings of two corners.
fn profile_between(a: Corner, b: Corner, path: u32) -> Profile {
    var speeds = vec2(length(b.center - a.center));
    if (path != PATH_LINEAR) {
        speeds = vec2(length(hermite_tangent(a, a, b)), length(hermite_tangent(b, a, b)));
    }
    let own = vec2(has_taper(a), has_taper(b));
    return profile_of(a.radius, b.radius, vec2(a.taper, b.taper) * speeds, own);
}

// Whether both tubes beside a corner's ring have the slope of its taper.
fn has_taper(corner: Corner) -> bool {
    return corner.role == ROLE_ORDINARY || corner.role == ROLE_END;
}

// A point of the tube between corners a, b of one ring and d, c of the next, with its derivatives.
struct TubePoint {
    position: vec3<f32>,
    by_x: vec3<f32>,
    by_y: vec3<f32>,
    // Direction away from the center line, not of unit length.
    radial: vec3<f32>,
    // Point of the center line, and the radius there.
    axis: vec3<f32>,
    radius: f32,
}

// The same expression for tubes and their edges, so that different shaders compute the same bits: a
// ring's edge from a to b is tube_point(a, b, b, a, x, 0), an edge along the path tube_point(a, a,
// d, d, 0, y).
fn tube_point(a: Corner, b: Corner, c: Corner, d: Corner, path: u32, x: f32, y: f32) -> TubePoint {
    let offset_near = blend(a.offset, b.offset, x);
    let offset_far = blend(d.offset, c.offset, x);
    let offset = blend(offset_near, offset_far, y);
    let offset_x = blend(b.offset - a.offset, c.offset - d.offset, y);
    let offset_y = offset_far - offset_near;
    let radial_near = blend(a.radial, b.radial, x);
    let radial_far = blend(d.radial, c.radial, x);
    let radial = blend(radial_near, radial_far, y);
    let radial_x = blend(b.radial - a.radial, c.radial - d.radial, y);
    let radial_y = radial_far - radial_near;
    let center = center_line(a, d, path, y);
    let longest = vec2(longer(a.offset, b.offset), longer(d.offset, c.offset));
    let reach = MAX_OFFSET * (longest.x * (1.0 - y) + longest.y * y);
    let most = reach * reach;
    let around = within(over_length(offset, offset_x, radial, radial_x), most);
    let along = within(over_length(offset, offset_y, radial, radial_y), most);
    let profile = profile_between(a, d, path);
    let share = profile_share(profile, y);
    return TubePoint(
        center.position + around.position * share.x,
        around.derivative * share.x,
        center.derivative + along.derivative * share.x + along.position * share.y,
        radial,
        center.position,
        profile_radius(profile, y),
    );
}

// A point of an edge, t in [0, 1] from a to b.
fn edge(kind: u32, a: Corner, b: Corner, path: u32, t: f32) -> Jet {
    if (kind == EDGE_SOMA) {
        return cubic(soma_controls(a, b), t);
    }
    if (kind == EDGE_LOFT) {
        return cubic(loft_controls(a, b), t);
    }
    // One call for both, since compilers write out each: corners beside a and b, and where t runs.
    let around = kind == EDGE_RING;
    var beside_a = a;
    var beside_b = b;
    if (around) {
        beside_a = b;
        beside_b = a;
    }
    let place = select(vec2(0.0, t), vec2(t, 0.0), around);
    let point = tube_point(a, beside_a, b, beside_b, path, place.x, place.y);
    return Jet(point.position, select(point.by_y, point.by_x, around));
}

// Control points of a soma edge.
fn soma_controls(a: Corner, b: Corner) -> array<vec3<f32>, 4> {
    let way = b.position - a.position;
    let na = cubic_normal(a);
    let nb = cubic_normal(b);
    return array<vec3<f32>, 4>(
        a.position,
        a.position + (way - na * dot(way, na)) / 3.0,
        b.position - (way - nb * dot(way, nb)) / 3.0,
        b.position,
    );
}

// Control points of a loft's edge, from the trunk's corner a to the inset's corner b.
fn loft_controls(a: Corner, b: Corner) -> array<vec3<f32>, 4> {
    let way = b.position - a.position;
    let normal = cubic_normal(a);
    let over = way - normal * dot(way, normal);
    let third = length(way) / 3.0;
    return array<vec3<f32>, 4>(
        a.position,
        a.position + over * first_leg(a, b, over, vec3<f32>(0.0)).x,
        b.position - b.tangent * clamp(b.collar, -third, third),
        b.position,
    );
}

// Share of the way over the tangent plane that the first leg of a loft takes, and its derivative.
fn first_leg(a: Corner, b: Corner, over: vec3<f32>, over_x: vec3<f32>) -> vec2<f32> {
    let span = max(length(over), 1e-37);
    let left = SOMA_FILLET * b.radius / span;
    if (a.role == ROLE_SOMA && left < 2.0 / 3.0) {
        return vec2(1.0 - left, left * dot(over, over_x) / (span * span));
    }
    return vec2(1.0 / 3.0, 0.0);
}

fn cubic(p: array<vec3<f32>, 4>, t: f32) -> Jet {
    let s = 1.0 - t;
    let position =
        p[0] * (s * s * s) + p[1] * (3.0 * s * s * t) + p[2] * (3.0 * s * t * t) + p[3] * (t * t * t);
    let derivative = (p[1] - p[0]) * (3.0 * s * s)
        + (p[2] - p[1]) * (6.0 * s * t)
        + (p[3] - p[2]) * (3.0 * t * t);
    return Jet(position, derivative);
}

// Normal on an edge, at right angles to the edge's own direction, and along a tube to those around it.
fn edge_normal(kind: u32, a: Corner, b: Corner, derivative: vec3<f32>, t: f32) -> vec3<f32> {
    let mixed = blend(a.normal, b.normal, t);
    if (kind == EDGE_ALONG && on_ring(a) && on_ring(b)) {
        let around = blend(cross(a.tangent, a.radial), cross(b.tangent, b.radial), t);
        let normal = normalize_or(cross(around, derivative), vec3<f32>(0.0));
        if (any(normal != vec3<f32>(0.0)) && dot(normal, mixed) >= 0.0) {
            return normal;
        }
    }
    let along = normalize_or(derivative, vec3<f32>(0.0));
    let otherwise = normalize_or(mixed, vec3<f32>(0.0, 1.0, 0.0));
    return normalize_or(mixed - along * dot(mixed, along), otherwise);
}

// Whether a corner is of a circle around a path, across its tangent.
fn on_ring(corner: Corner) -> bool {
    return corner.role != ROLE_JOINT && corner.role != ROLE_SOMA;
}

struct Inside {
    position: vec3<f32>,
    normal: vec3<f32>,
}

// A patch ready to be evaluated inside. Sides: EDGE_ kind, plus SIDE_REVERSED where the edge runs
// against the patch's coordinate.
struct PatchShape {
    kind: u32,
    a: Corner,
    b: Corner,
    c: Corner,
    d: Corner,
    sides: vec4<u32>,
}

// A point inside with its normal, x and y in (0, 1).
fn interior(shape: PatchShape, path: u32, caps: u32, x: f32, y: f32) -> Inside {
    if (shape.kind == PATCH_LATERAL) {
        return lateral(shape, path, x, y);
    }
    if (shape.kind == PATCH_LOFT) {
        return loft(shape, path, x, y);
    }
    let flat = coons(shape, x, y);
    if (shape.kind == PATCH_SOMA) {
        return flat;
    }
    return cap(shape, caps, flat.position);
}

fn lateral(shape: PatchShape, path: u32, x: f32, y: f32) -> Inside {
    let point = tube_point(shape.a, shape.b, shape.c, shape.d, path, x, y);
    return Inside(point.position, tube_normal(point, shape.a.normal));
}

// Normal inside a tube's patch.
fn tube_normal(point: TubePoint, otherwise: vec3<f32>) -> vec3<f32> {
    let outwards = normalize_or(point.radial, otherwise);
    // Where a sharp bend folds the surface over, it gets the normal of a tube without the fold.
    let normal = normalize_or(cross(point.by_x, point.by_y), outwards);
    if (!(dot(normal, outwards) > 0.0)) {
        return outwards;
    }
    return normal;
}

// A point of a side, from `from_corner` to `to_corner` along the patch's coordinate.
fn side(shape: u32, from_corner: Corner, to_corner: Corner, path: u32, t: f32) -> Jet {
    let kind = shape & SIDE_KIND;
    // One call for both directions, since compilers write out each.
    let reversed = (shape & SIDE_REVERSED) != 0u;
    var first = from_corner;
    var last = to_corner;
    if (reversed) {
        first = to_corner;
        last = from_corner;
    }
    let jet = edge(kind, first, last, path, select(t, 1.0 - t, reversed));
    return Jet(jet.position, select(jet.derivative, -jet.derivative, reversed));
}

// Bilinearly blended Coons patch. Its normal is that of the sides, the nearer one more.
fn coons(shape: PatchShape, x: f32, y: f32) -> Inside {
    let near = side(shape.sides.x, shape.a, shape.b, PATH_HERMITE, x);
    let right = side(shape.sides.y, shape.b, shape.c, PATH_HERMITE, y);
    let far = side(shape.sides.z, shape.d, shape.c, PATH_HERMITE, x);
    let left = side(shape.sides.w, shape.a, shape.d, PATH_HERMITE, y);
    let a = shape.a.position;
    let b = shape.b.position;
    let c = shape.c.position;
    let d = shape.d.position;
    let position = blend(near.position, far.position, y) + blend(left.position, right.position, x)
        - blend(blend(a, b, x), blend(d, c, x), y);
    let along_near = edge_normal(shape.sides.x & SIDE_KIND, shape.a, shape.b, near.derivative, x);
    let along_right = edge_normal(shape.sides.y & SIDE_KIND, shape.b, shape.c, right.derivative, y);
    let along_far = edge_normal(shape.sides.z & SIDE_KIND, shape.d, shape.c, far.derivative, x);
    let along_left = edge_normal(shape.sides.w & SIDE_KIND, shape.a, shape.d, left.derivative, y);
    let normal = blend(along_near, along_far, y) * (x * (1.0 - x))
        + blend(along_left, along_right, x) * (y * (1.0 - y));
    return Inside(position, normalize_or(normal, mean_normal(shape)));
}

fn mean_normal(shape: PatchShape) -> vec3<f32> {
    return normalize_or(
        shape.a.normal + shape.b.normal + shape.c.normal + shape.d.normal,
        vec3<f32>(0.0, 1.0, 0.0),
    );
}

// At each x a cubic from the trunk's side to the inset's: loft_controls between points of the two sides,
// with its derivatives.
fn loft(shape: PatchShape, path: u32, x: f32, y: f32) -> Inside {
    let near = side(shape.sides.x, shape.a, shape.b, path, x);
    let far = side(shape.sides.z, shape.d, shape.c, path, x);
    let way = far.position - near.position;
    let way_x = far.derivative - near.derivative;
    let normal_a = cubic_normal(shape.a);
    let normal_b = cubic_normal(shape.b);
    let mixed = blend(normal_a, normal_b, x);
    let normal = over_length(mixed, normal_b - normal_a, mixed, normal_b - normal_a);
    let rise = dot(way, normal.position);
    let rise_x = dot(way_x, normal.position) + dot(way, normal.derivative);
    let over = way - normal.position * rise;
    let over_x = way_x - normal.derivative * rise - normal.position * rise_x;
    let leg = first_leg(shape.a, shape.c, over, over_x);
    let leave = over * leg.x;
    let leave_x = over_x * leg.x + over * leg.y;
    let third = length(way) / 3.0;
    let arrive = shape.c.tangent * clamp(shape.c.collar, -third, third);
    let third_x = dot(way, way_x) / max(9.0 * third, 1e-37);
    let arrive_x = shape.c.tangent * select(0.0, third_x * sign(shape.c.collar), third < abs(shape.c.collar));
    let across = cubic(
        array<vec3<f32>, 4>(
            near.position,
            near.position + leave,
            far.position - arrive,
            far.position,
        ),
        y,
    );
    let by_x = cubic(
        array<vec3<f32>, 4>(
            near.derivative,
            near.derivative + leave_x,
            far.derivative - arrive_x,
            far.derivative,
        ),
        y,
    );
    let facing = cross(by_x.position, across.derivative);
    return Inside(across.position, normalize_or(facing, mean_normal(shape)));
}

// The end of a tube: a disk, or the half sphere over it, whose polar angle grows with the distance
// from the disk's center. `flat`: the point of the disk.
fn cap(shape: PatchShape, caps: u32, flat: vec3<f32>) -> Inside {
    let a = shape.a;
    let outwards = cross(shape.b.offset - a.offset, shape.d.offset - a.offset);
    var axis = a.tangent;
    if (dot(outwards, a.tangent) < 0.0) {
        axis = -a.tangent;
    }
    if (caps == CAPS_FLAT) {
        return Inside(flat, axis);
    }
    let radius = length(a.offset);
    let across = flat - a.center;
    let share = min(length(across) / max(radius, 1e-37), 1.0);
    let angle = share * HALF_PI;
    var stretch = HALF_PI;
    if (share > 1e-4) {
        stretch = sin(angle) / share;
    }
    let dome = across * stretch + axis * (radius * cos(angle));
    return Inside(a.center + dome, normalize_or(dome, axis));
}
