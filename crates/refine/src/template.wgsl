// Reads a packed coarse mesh: patches, their corners, and their attributes.
//
// Imported by all shaders that evaluate patches. This is the only WGSL file that knows the layout:
// for another layout, write another file with the same functions. Rust twin: decode.rs; packed.rs
// writes it.

#import evaluate.wgsl

// Where the arrays of a part begin in the packed buffer, in u32s.
struct Base {
    // Four u32s each; PATCHES_OF_POINT lateral patches from each to the next. After them TAPER_LOW_BITS of each.
    points: u32,
    point_count: u32,
    // A sphere for every POINTS_OF_SPHERE points, SPHERE_U32S each.
    spheres: u32,
    // Three u32s each.
    explicit_vertices: u32,
    // Eight u32s each.
    anchors: u32,
    // Shaped rings, SHAPED_U32S each.
    shaped: u32,
    // Somata's patches, three u32s for two.
    soma: u32,
    soma_count: u32,
    // Two u32s each, up to the caps.
    quads: u32,
    // One u32 each.
    caps: u32,
    color_keys: u32,
}

// A patch by its kind and the vertices at its corners. A vertex is four times the index of a point
// plus the corner of its implicit ring; or, with the bit EXPLICIT, the index of an explicit vertex or,
// after all of these, of a shaped ring's corner.
struct Patch {
    kind: u32,
    corners: vec4<u32>,
}

@group(0) @binding(0) var<storage, read> packed: array<u32>;

fn packed_point(base: Base, point: u32) -> vec4<u32> {
    let at = base.points + 4u * point;
    return vec4<u32>(packed[at], packed[at + 1u], packed[at + 2u], packed[at + 3u]);
}

fn explicit_count(base: Base) -> u32 {
    return (base.anchors - base.explicit_vertices) / 3u;
}

// Whether the ring at a point is implicit.
fn is_implicit(point_bits: vec4<u32>) -> bool {
    return (point_bits.y >> POINT_KIND_SHIFT) < POINT_EXPLICIT;
}

// The four vertices of the ring at a point.
fn ring_of(base: Base, point: u32, point_bits: vec4<u32>) -> vec4<u32> {
    let kind = point_bits.y >> POINT_KIND_SHIFT;
    if (kind == POINT_EXPLICIT) {
        return vec4<u32>(point_bits.x & 0xffffu, point_bits.x >> 16u, point_bits.z & 0xffffu, point_bits.z >> 16u)
            | vec4<u32>(EXPLICIT);
    }
    let corners = vec4<u32>(0u, 1u, 2u, 3u);
    if (kind == POINT_SHAPED) {
        let first = explicit_count(base) + 4u * (point_bits.z >> 16u);
        return (vec4<u32>(first) + corners) | vec4<u32>(EXPLICIT);
    }
    return vec4<u32>(4u * point) + corners;
}

// Bits of the four sides from a point to the next where branches leave.
fn open_sides(base: Base, point_bits: vec4<u32>) -> u32 {
    let kind = point_bits.y >> POINT_KIND_SHIFT;
    if (kind == POINT_EXPLICIT) {
        return point_bits.y & 0xfu;
    }
    if (kind == POINT_SHAPED) {
        return packed[base.shaped + SHAPED_U32S * (point_bits.z >> 16u)] >> SHAPED_OPEN_SHIFT;
    }
    return 0u;
}

// Whether a patch is part of a tube between two points with implicit rings.
fn patch_is_tube(base: Base, index: u32) -> bool {
    let point = index / 4u;
    if (point >= base.point_count) {
        return false;
    }
    let at = base.points + 4u * point + 1u;
    return (packed[at] >> POINT_KIND_SHIFT) < POINT_EXPLICIT
        && (packed[at + 4u] >> POINT_KIND_SHIFT) < POINT_EXPLICIT;
}

// Whether there are lateral patches from a point to the next: after the last point of a run there are
// none.
fn goes_on(base: Base, point: u32) -> bool {
    return (packed[base.points + 4u * point + 1u] & POINT_GOES_ON) != 0u;
}

// Whether there is a patch with this index: where branches leave there is none.
fn patch_exists(base: Base, index: u32) -> bool {
    let point = index / 4u;
    if (point >= base.point_count) {
        return true;
    }
    let open = open_sides(base, packed_point(base, point));
    return goes_on(base, point) && (open & (1u << (index & 3u))) == 0u;
}

fn patch_at(base: Base, index: u32) -> Patch {
    if (index < 4u * base.point_count) {
        let point = index / 4u;
        let k = index & 3u;
        let ring = ring_of(base, point, packed_point(base, point));
        let next = ring_of(base, point + 1u, packed_point(base, point + 1u));
        let after = (k + 1u) & 3u;
        return Patch(PATCH_LATERAL, vec4<u32>(ring[k], ring[after], next[after], next[k]));
    }
    let soma = index - 4u * base.point_count;
    if (soma < base.soma_count) {
        // 48 bits: four explicit vertices of 12.
        let at = base.soma + 3u * soma / 2u;
        let odd = (soma & 1u) * 16u;
        let x = packed[at];
        let y = packed[at + 1u];
        let low = select(x, (x >> 16u) | (y << 16u), odd != 0u);
        let high = (y >> odd) & 0xffffu;
        let corners = vec4<u32>(
            low & 0xfffu, (low >> 12u) & 0xfffu, (low >> 24u) | ((high & 0xfu) << 8u), high >> 4u);
        return Patch(PATCH_SOMA, corners | vec4<u32>(EXPLICIT));
    }
    let quad = soma - base.soma_count;
    let quad_count = (base.caps - base.quads) / 2u;
    if (quad < quad_count) {
        let x = packed[base.quads + 2u * quad];
        let y = packed[base.quads + 2u * quad + 1u];
        let corners = vec4<u32>(x & 0xffffu, x >> 16u, y & 0xffffu, y >> 16u);
        let kind = (corners.x >> 15u) | ((corners.y >> 15u) << 1u);
        return Patch(kind, (corners & vec4<u32>(0x7fffu)) | vec4<u32>(EXPLICIT));
    }
    let packed = packed[base.caps + quad - quad_count];
    let first = 4u * (packed >> 1u);
    if ((packed & 1u) != 0u) {
        return Patch(PATCH_CAP, vec4<u32>(first) + vec4<u32>(3u, 2u, 1u, 0u));
    }
    return Patch(PATCH_CAP, vec4<u32>(first) + vec4<u32>(0u, 1u, 2u, 3u));
}

// Unit vector from octahedral coordinates (Meyer et al., On floating-point normal vectors, 2010),
// each of which is one of `most` + 1 steps from -1 to 1.
fn octahedral(x: u32, y: u32, most: f32) -> vec3<f32> {
    let px = f32(x) * (2.0 / most) - 1.0;
    let py = f32(y) * (2.0 / most) - 1.0;
    let z = 1.0 - abs(px) - abs(py);
    let fold = max(-z, 0.0);
    let v = vec3<f32>(
        px + select(fold, -fold, px >= 0.0),
        py + select(fold, -fold, py >= 0.0),
        z,
    );
    return normalize_or(v, vec3<f32>(0.0, 0.0, 1.0));
}

fn point_center(base: Base, point: u32, point_bits: vec4<u32>) -> vec3<f32> {
    let at = base.spheres + SPHERE_U32S * (point / POINTS_OF_SPHERE);
    let radius = bitcast<f32>(packed[at + 3u]);
    let step = radius * (2.0 / POSITION_STEPS);
    let x = point_bits.x & 0xfffffu;
    let y = (point_bits.x >> 20u) | ((point_bits.y & 0xffu) << 12u);
    let z = (point_bits.y >> 8u) & 0xfffffu;
    let from_sphere = vec3<f32>(f32(x), f32(y), f32(z)) * step - vec3<f32>(radius);
    let sphere = vec3<f32>(
        bitcast<f32>(packed[at]),
        bitcast<f32>(packed[at + 1u]),
        bitcast<f32>(packed[at + 2u]),
    );
    return sphere + from_sphere;
}

fn point_radius(point_bits: vec4<u32>) -> f32 {
    return bitcast<f32>(((point_bits.z & 0xffffu) + RADIUS_BASE) << 12u);
}

// Unit direction from a ring's center to its corner k: corners are a quarter turn about the tangent
// apart.
fn ring_direction(tangent: vec3<f32>, turn: u32, k: u32) -> vec3<f32> {
    // Duff et al., Building an orthonormal basis, revisited, 2017.
    let sign = select(-1.0, 1.0, tangent.z >= 0.0);
    let a = -1.0 / (sign + tangent.z);
    let b = tangent.x * tangent.y * a;
    let u = vec3<f32>(1.0 + sign * tangent.x * tangent.x * a, sign * b, -sign * tangent.x);
    let v = vec3<f32>(b, sign + tangent.y * tangent.y * a, -tangent.y);
    // The upper bits of `turn` count quarter turns; the lower eight are the tangent of half the
    // remaining angle, from which its cosine and sine follow.
    let t = f32(turn & 0xffu) / 256.0;
    let scale = 1.0 / (1.0 + t * t);
    let c = (1.0 - t * t) * scale;
    let s = 2.0 * t * scale;
    switch ((k + (turn >> 8u)) & 3u) {
        case 0u: {
            return u * c + v * s;
        }
        case 1u: {
            return v * c - u * s;
        }
        case 2u: {
            return -(u * c) - v * s;
        }
        default: {
            return u * s - v * c;
        }
    }
}

// A point with an implicit ring.
struct ImplicitRing {
    center: vec3<f32>,
    radius: f32,
    tangent: vec3<f32>,
    taper: f32,
    turn: u32,
    role: u32,
}

// The change of the radius along the path at a point with an implicit or shaped ring, as nine bits: the
// square root of its absolute value, and whether the tube narrows.
fn taper_bits(base: Base, point: u32, point_bits: vec4<u32>) -> u32 {
    let low_bits = packed[base.points + 4u * base.point_count + point / (32u / TAPER_LOW_BITS)];
    let low = (low_bits >> (TAPER_LOW_BITS * (point % (32u / TAPER_LOW_BITS)))) & ((1u << TAPER_LOW_BITS) - 1u);
    let high = ((point_bits.w >> 18u) & 0xfu) << TAPER_LOW_BITS;
    return low | high | select(0u, TAPER_NARROWS, (point_bits.y & POINT_NARROWS) != 0u);
}

fn taper_of_bits(bits: u32) -> f32 {
    let root = f32(bits & 0xffu) / 255.0;
    return select(root * root, -(root * root), (bits & TAPER_NARROWS) != 0u);
}

fn implicit_ring(base: Base, point: u32, point_bits: vec4<u32>) -> ImplicitRing {
    return ImplicitRing(
        point_center(base, point, point_bits),
        point_radius(point_bits),
        octahedral(point_bits.w & 0x1ffu, (point_bits.w >> 9u) & 0x1ffu, 511.0),
        taper_of_bits(taper_bits(base, point, point_bits)),
        (point_bits.z >> 16u) & 0x3ffu,
        select(ROLE_ORDINARY, ROLE_END, (point_bits.y >> POINT_KIND_SHIFT) == POINT_END),
    );
}

fn ring_corner(ring: ImplicitRing, k: u32) -> Corner {
    let direction = ring_direction(ring.tangent, ring.turn, k);
    let position = ring.center + direction * ring.radius;
    let offset = position - ring.center;
    let normal = normalize_or(direction - ring.tangent * ring.taper, direction);
    return Corner(
        position,
        normal,
        ring.center,
        offset,
        normalize_or(offset, normal),
        ring.tangent,
        ring.radius,
        ring.role,
        0.0,
        ring.taper,
    );
}

// Whether a vertex with the bit EXPLICIT is a corner of a shaped ring.
fn is_shaped(base: Base, vertex: u32) -> bool {
    return (vertex & ~EXPLICIT) >= explicit_count(base);
}

// The shaped ring of a vertex, which is one of its corners.
fn shaped_of(base: Base, vertex: u32) -> u32 {
    return base.shaped + SHAPED_U32S * (((vertex & ~EXPLICIT) - explicit_count(base)) / 4u);
}

fn shaped_point(base: Base, vertex: u32) -> u32 {
    return packed[shaped_of(base, vertex)] & ((1u << SHAPED_LEVEL_SHIFT) - 1u);
}

fn shaped_role(base: Base, vertex: u32) -> u32 {
    let inset = (packed[shaped_of(base, vertex) + 2u] & SHAPED_INSET) != 0u;
    return select(ROLE_ORDINARY, ROLE_INSET, inset);
}

fn shaped_corner(base: Base, vertex: u32) -> Corner {
    let at = shaped_of(base, vertex);
    let k = ((vertex & ~EXPLICIT) - explicit_count(base)) & 3u;
    let point = shaped_point(base, vertex);
    let last = packed[at + 2u];
    let turns = packed[at + 1u] >> (10u * k);
    var ring = implicit_ring(base, point, packed_point(base, point));
    ring.turn = select(turns, last, k == 3u) & 0x3ffu;
    let on_circle = ring_corner(ring, 0u);
    let height = signed16(packed[at + 3u + k / 2u] >> (16u * (k & 1u)));
    let role = shaped_role(base, vertex);
    let crease = (last >> SHAPED_CREASE_SHIFT) & 0xffffu;
    let reach = select(reach_of_corner(crease, k), 1.0, role == ROLE_INSET);
    let offset = on_circle.offset * reach + ring.tangent * (height * MAX_HEIGHT * ring.radius);
    return Corner(
        ring.center + offset,
        on_circle.normal,
        ring.center,
        offset,
        radial_of(role, offset, on_circle.normal),
        ring.tangent,
        ring.radius,
        role,
        collar_or_border(last, role),
        ring.taper,
    );
}

// How far (radii) corner k of a shaped ring is from the center: at a bend, one lies in the crease.
fn reach_of_corner(crease: u32, k: u32) -> f32 {
    let steps = crease & ((1u << CREASE_CORNER_SHIFT) - 1u);
    return select(1.0, f32(steps) * CREASE_STEP, steps > 0u && (crease >> CREASE_CORNER_SHIFT) == k);
}

fn own_corner(base: Base, vertex: u32) -> Corner {
    let point = vertex >> 2u;
    return ring_corner(implicit_ring(base, point, packed_point(base, point)), vertex & 3u);
}

fn anchor_of(base: Base, vertex: u32) -> u32 {
    return base.anchors + 8u * (packed[base.explicit_vertices + 3u * (vertex & ~EXPLICIT) + 1u] >> 16u);
}

// A number from -1 to 1, stored in 16 bits.
fn signed16(bits: u32) -> f32 {
    return f32(bits & 0xffffu) * (2.0 / 65535.0) - 1.0;
}

fn explicit_corner(base: Base, vertex: u32) -> Corner {
    let at = base.explicit_vertices + 3u * (vertex & ~EXPLICIT);
    let x = packed[at];
    let y = packed[at + 1u];
    let z = packed[at + 2u];
    let anchor = anchor_of(base, vertex);
    let center = vec3<f32>(
        bitcast<f32>(packed[anchor]),
        bitcast<f32>(packed[anchor + 1u]),
        bitcast<f32>(packed[anchor + 2u]),
    );
    let reach = bitcast<f32>(packed[anchor + 3u]);
    let position = center + vec3<f32>(signed16(x), signed16(x >> 16u), signed16(y)) * reach;
    let offset = position - center;
    let normal = octahedral(z & 0xfffu, (z >> 12u) & 0xfffu, 4095.0);
    let direction = packed[anchor + 5u];
    let tangent = octahedral(direction & 0xffffu, direction >> 16u, 65535.0);
    let role = packed[anchor + 6u];
    return Corner(
        position,
        normal,
        center,
        offset,
        radial_of(role_of_bits(role), offset, normal),
        tangent,
        bitcast<f32>(packed[anchor + 4u]),
        role_of_bits(role),
        collar_or_border(role, role_of_bits(role)),
        taper_of_bits((role >> ANCHOR_TAPER_SHIFT) & 0x1ffu),
    );
}

// An anchor's role, above it the nine bits of its taper, and above them its collar: a sign and 16 bits as
// radii are, 0 for none; or if it is no inset in the upper bits its border.
fn role_of_bits(bits: u32) -> u32 {
    return bits & ((1u << ANCHOR_TAPER_SHIFT) - 1u);
}

// What an anchor or a shaped ring has in its upper bits: the collar of an inset, the border of any other.
fn collar_or_border(bits: u32, role: u32) -> f32 {
    if (role != ROLE_INSET) {
        return f32(bitcast<i32>(bits) >> BORDER_SHIFT) / 16.0;
    }
    let code = bits >> COLLAR_SHIFT;
    let length = bitcast<f32>(((code & ~COLLAR_AGAINST) + RADIUS_BASE) << 12u);
    let along = select(length, -length, (code & COLLAR_AGAINST) != 0u);
    return select(0.0, along, code != 0u);
}

// An inset follows the trunk's surface, so its corners' offsets lean; its tube must not.
fn radial_of(role: u32, offset: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    if (role == ROLE_INSET) {
        return normal;
    }
    return normalize_or(offset, normal);
}

// A corner of a vertex with the bit EXPLICIT.
fn named_corner(base: Base, vertex: u32) -> Corner {
    if (is_shaped(base, vertex)) {
        return shaped_corner(base, vertex);
    }
    return explicit_corner(base, vertex);
}

fn corner(base: Base, vertex: u32) -> Corner {
    if ((vertex & EXPLICIT) != 0u) {
        return named_corner(base, vertex);
    }
    return own_corner(base, vertex);
}

// A number that is different for different tracing points.
fn tracing_of(base: Base, vertex: u32) -> u32 {
    if ((vertex & EXPLICIT) != 0u) {
        if (is_shaped(base, vertex)) {
            return shaped_of(base, vertex) | EXPLICIT;
        }
        return anchor_of(base, vertex) | EXPLICIT;
    }
    return vertex >> 2u;
}

fn role_of(base: Base, vertex: u32) -> u32 {
    if ((vertex & EXPLICIT) != 0u) {
        if (is_shaped(base, vertex)) {
            return shaped_role(base, vertex);
        }
        return role_of_bits(packed[anchor_of(base, vertex) + 6u]);
    }
    let kind = packed[base.points + 4u * (vertex >> 2u) + 1u] >> POINT_KIND_SHIFT;
    return select(ROLE_ORDINARY, ROLE_END, kind == POINT_END);
}

// The level at a vertex, for LEVELS_PER_POINT.
fn value_of(base: Base, vertex: u32) -> u32 {
    if ((vertex & EXPLICIT) != 0u) {
        if (is_shaped(base, vertex)) {
            return ((packed[shaped_of(base, vertex)] >> SHAPED_LEVEL_SHIFT) & 0x3fu) + 1u;
        }
        return packed[base.explicit_vertices + 3u * (vertex & ~EXPLICIT) + 2u] >> 24u;
    }
    return (packed[base.points + 4u * (vertex >> 2u) + 2u] >> 26u) + 1u;
}

// The color key of a point with an implicit ring.
fn point_color_key(base: Base, point_bits: vec4<u32>) -> u32 {
    return packed[base.color_keys + (point_bits.w >> 22u)];
}

// The color key of a vertex's tracing point.
fn color_key_of(base: Base, vertex: u32) -> u32 {
    var point = vertex >> 2u;
    if ((vertex & EXPLICIT) != 0u) {
        if (!is_shaped(base, vertex)) {
            return packed[anchor_of(base, vertex) + 7u];
        }
        point = shaped_point(base, vertex);
    }
    return packed[base.color_keys + (packed[base.points + 4u * point + 3u] >> 22u)];
}
