// Rings and explicit vertices where an instance puts them: computed once a frame, whatever the
// level. All patches that meet in a corner compute it by the same expression from the same u32s, so
// that they agree to the bit.
//
// Packed into few u32s, since vertex shaders load little else. Written by coarse.wgsl, read by
// vertices.wgsl. Rust twin of the struct: work.rs.

#import placed.wgsl

// Rings come first, at a quarter of the index of their first corner; then two entries for each
// explicit vertex. Positions are relative to the eye (micrometers), directions are the world's.
struct CoarsePoint {
    // Of a ring: its center. Of an explicit vertex: its position; in its second entry its center.
    x: f32,
    y: f32,
    z: f32,
    // In an explicit vertex's second entry: its collar or border.
    radius: f32,
    // Of a ring: see pack_turn. Of an explicit vertex: normal and tangent; in its second entry its
    // role and taper.
    low: u32,
    high: u32,
    color_key: u32,
    instance: u32,
}

// Index of the entry of a corner, from the index that coarse_place gives.
fn coarse_index(place: u32) -> u32 {
    let at_explicit = frame.first_explicit / 4u + 2u * (place - frame.first_explicit);
    return select(place / 4u, at_explicit, place >= frame.first_explicit);
}

fn center_of(point: CoarsePoint) -> vec3<f32> {
    return vec3<f32>(point.x, point.y, point.z);
}

// Meyer et al., On floating-point normal vectors, 2010.
fn pack_direction(v: vec3<f32>) -> u32 {
    let p = v.xy / max(abs(v.x) + abs(v.y) + abs(v.z), 1e-30);
    let folded = (1.0 - abs(p.yx)) * select(vec2(-1.0), vec2(1.0), p >= vec2(0.0));
    return pack2x16snorm(select(p, folded, v.z < 0.0));
}

fn unpack_direction(packed: u32) -> vec3<f32> {
    let p = unpack2x16snorm(packed);
    let z = 1.0 - abs(p.x) - abs(p.y);
    let fold = max(-z, 0.0);
    let folded = p - select(vec2(-fold), vec2(fold), p >= vec2(0.0));
    return normalize(vec3(folded, z));
}

// The orientation of a ring: directions of its first and second corner, and the tangent, all at
// right angles. Packed as a quaternion without its largest component, 17 bits for each of the
// others, with nine bits of the taper.
fn pack_turn(first: vec3<f32>, second: vec3<f32>, tangent: vec3<f32>, taper: u32) -> vec2<u32> {
    // Squares of the components, each times four.
    let squares = vec4<f32>(
        1.0 + first.x - second.y - tangent.z,
        1.0 - first.x + second.y - tangent.z,
        1.0 - first.x - second.y + tangent.z,
        1.0 + first.x + second.y + tangent.z,
    );
    var largest = 0u;
    for (var k = 1u; k < 4u; k += 1u) {
        largest = select(largest, k, squares[k] > squares[largest]);
    }
    let xy = second.x + first.y;
    let xz = tangent.x + first.z;
    let yz = tangent.y + second.z;
    let wx = second.z - tangent.y;
    let wy = tangent.x - first.z;
    let wz = first.y - second.x;
    var others = vec3<f32>(wx, wy, wz);
    if (largest == 0u) {
        others = vec3<f32>(xy, xz, wx);
    } else if (largest == 1u) {
        others = vec3<f32>(xy, yz, wy);
    } else if (largest == 2u) {
        others = vec3<f32>(xz, yz, wz);
    }
    others /= 2.0 * sqrt(squares[largest]);
    let steps = vec3<u32>((others * (SQRT_2 * 0.5) + 0.5) * 131071.0 + 0.5) & vec3<u32>(0x1ffffu);
    return vec2<u32>(
        steps.x | (steps.y << 17u),
        (steps.y >> 15u) | (steps.z << 2u) | (largest << 19u) | (taper << 21u),
    );
}

struct Turn {
    first: vec3<f32>,
    second: vec3<f32>,
    tangent: vec3<f32>,
}

fn unpack_turn(low: u32, high: u32) -> Turn {
    let steps = vec3<u32>(low, (low >> 17u) | (high << 15u), high >> 2u) & vec3<u32>(0x1ffffu);
    let o = (vec3<f32>(steps) / 131071.0 - 0.5) * SQRT_2;
    let most = sqrt(max(1.0 - dot(o, o), 0.0));
    let largest = (high >> 19u) & 3u;
    var q = vec4<f32>(o, most);
    q = select(q, vec4<f32>(most, o), largest == 0u);
    q = select(q, vec4<f32>(o.x, most, o.y, o.z), largest == 1u);
    q = select(q, vec4<f32>(o.x, o.y, most, o.z), largest == 2u);
    let p = q * 2.0;
    return Turn(
        vec3<f32>(1.0 - p.y * q.y - p.z * q.z, p.x * q.y + p.w * q.z, p.x * q.z - p.w * q.y),
        vec3<f32>(p.x * q.y - p.w * q.z, 1.0 - p.x * q.x - p.z * q.z, p.y * q.z + p.w * q.x),
        vec3<f32>(p.x * q.z + p.w * q.y, p.y * q.z - p.w * q.x, 1.0 - p.x * q.x - p.y * q.y),
    );
}

// A ring, unpacked.
struct DrawnRing {
    center: vec3<f32>,
    radius: f32,
    turn: Turn,
    taper: f32,
    color_key: u32,
    instance: u32,
}

fn drawn_ring(point: CoarsePoint) -> DrawnRing {
    return DrawnRing(
        center_of(point),
        point.radius,
        unpack_turn(point.low, point.high),
        taper_of_bits(point.high >> 21u),
        point.color_key,
        point.instance,
    );
}

// Corner k of a ring.
fn corner_of_ring(ring: DrawnRing, k: u32) -> Corner {
    var direction = select(ring.turn.first, ring.turn.second, (k & 1u) == 1u);
    direction = select(direction, -direction, k >= 2u);
    let offset = direction * ring.radius;
    return Corner(
        ring.center + offset,
        normalize(direction - ring.turn.tangent * ring.taper),
        ring.center,
        offset,
        direction,
        ring.turn.tangent,
        ring.radius,
        ROLE_ORDINARY,
        0.0,
        ring.taper,
    );
}

fn corner_of_explicit(vertex: CoarsePoint, more: CoarsePoint) -> Corner {
    let position = center_of(vertex);
    let center = center_of(more);
    let normal = unpack_direction(vertex.low);
    let offset = position - center;
    return Corner(
        position,
        normal,
        center,
        offset,
        radial_of(more.low, offset, normal),
        unpack_direction(vertex.high),
        vertex.radius,
        more.low,
        more.radius,
        bitcast<f32>(more.high),
    );
}
