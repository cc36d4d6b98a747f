// Vertices of the chunks that exploration mode has selected: four for each quad.
//
// Shaders that shade call `surface_vertex` (see sources/mod.rs). A tube is drawn as the half of it
// that faces the eye: one strip as wide as the tube, or 5, 10 or 20 strips around it. A sphere is
// drawn as the cap that faces the eye.

#import surface_vertex.wgsl
#import evaluate.wgsl
#import budgeted.wgsl

@group(0) @binding(2) var<storage, read> visible_chunks: array<VisibleChunk>;
@group(0) @binding(4) var<storage, read> quads: array<u32>;
@group(0) @binding(6) var<storage, read> color_keys: array<u32>;

// Index of the quad that a vertex belongs to. The quads after the last full block are a draw of
// their own, with vertex indices from 4 * BLOCK on.
fn quad_place(vertex_index: u32, instance_index: u32) -> u32 {
    let rest = vertex_index >= 4u * BLOCK;
    let local = vertex_index % (4u * BLOCK);
    return select(instance_index, quads[0] / BLOCK, rest) * BLOCK + local / 4u;
}

fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let place = quad_place(vertex_index, instance_index);
    if (place >= quads[0]) {
        let nowhere = vec3<f32>(0.0);
        return SurfaceVertex(nowhere, nowhere, nowhere, 0.0, 0u, 0u, vec2<f32>(0.0));
    }
    let visible_chunk = visible_chunks[quads[place + 1u]];
    let index = place - visible_chunk.first;
    let corner = vertex_index & 3u;
    let what = lod_what(visible_chunk.lod);
    if (what == WHAT_TUBE) {
        return tube_vertex(visible_chunk, index, corner);
    }
    if (what == WHAT_SOMA) {
        return soma_vertex(visible_chunk, index, corner);
    }
    let chunk = chunks[visible_chunk.chunk];
    let instance_pose = gpu_instances[visible_chunk.instance];
    // A dot may stand for others, too.
    let width = select(1.0, lod_width(visible_chunk.lod), what == WHAT_DOT);
    let radius = chunk.radius * instance_pose.scale * width;
    var v = sphere_vertex(relative(instance_pose, chunk.center), radius, what, index, corner);
    // Radius 0: the shading does not widen somata, and a dot is a pixel wide already.
    v.radius = 0.0;
    v.color_key = color_key_at(chunk, 0u);
    v.instance = visible_chunk.instance;
    return v;
}

fn corner_grid(corner: u32) -> vec2<f32> {
    return vec2<f32>(f32(corner == 1u || corner == 2u), f32(corner >= 2u));
}

fn color_key_at(chunk: Chunk, point: u32) -> u32 {
    if ((chunk.flags & CHUNK_ONE_COLOR_KEY) != 0u) {
        return chunk.color_keys;
    }
    return color_keys[chunk.color_keys + point];
}

// Unit direction from a point, relative to the eye, to whoever looks.
fn towards_eye(p: vec3<f32>) -> vec3<f32> {
    if (eye.flat > 0.0) {
        return -eye.forward;
    }
    return normalize_or(-p, -eye.forward);
}

fn across(v: vec3<f32>) -> vec3<f32> {
    let axis = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(v.y) > 0.7);
    return normalize(cross(axis, v));
}

// Unit vector from octahedral coordinates, -1 to 1 (Meyer et al., On floating-point normal vectors,
// 2010).
fn from_octahedral(p: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(p.x) - abs(p.y);
    let fold = max(-z, 0.0);
    let folded = p - select(vec2<f32>(-fold), vec2<f32>(fold), p >= vec2<f32>(0.0));
    return normalize(vec3<f32>(folded, z));
}

// Direction of the path at a point of a polyline. At the ends of a chunk it is the stored one,
// which the next chunk shares, unless a coarse polyline starts off in quite another direction.
fn direction(chunk: Chunk, level: u32, index: u32, here: vec3<f32>) -> vec3<f32> {
    let last = segments(chunk, level);
    if (index > 0u && index < last) {
        let before = normalize_or(here - stored(chunk, level, index - 1u).position, vec3<f32>(0.0));
        let after = normalize_or(stored(chunk, level, index + 1u).position - here, vec3<f32>(0.0));
        return normalize_or(before + after, normalize_or(before, vec3<f32>(1.0, 0.0, 0.0)));
    }
    let kept = from_octahedral(unpack2x16snorm(select(chunk.end, chunk.start, index == 0u)));
    if (level == 0u && !is_reduced(chunk)) {
        return kept;
    }
    let other = stored(chunk, level, select(last - 1u, 1u, index == 0u)).position;
    let way = normalize_or(select(here - other, other - here, index == 0u), kept);
    return select(way, kept, dot(way, kept) > 0.8);
}

// A cross-section of a tube, in the template.
struct Station {
    center: vec3<f32>,
    direction: vec3<f32>,
    radius: f32,
    point: u32,
    // From start to end of its segment.
    chord: vec3<f32>,
}

fn station(chunk: Chunk, level: u32, segment: u32, t: f32) -> Station {
    let a = stored(chunk, level, segment);
    let b = stored(chunk, level, segment + 1u);
    let chord = b.position - a.position;
    if (t == 0.0) {
        return Station(a.position, direction(chunk, level, segment, a.position), a.radius, a.point, chord);
    }
    let far = direction(chunk, level, segment + 1u, b.position);
    if (t == 1.0) {
        return Station(b.position, far, b.radius, select(a.point, b.point, t > 0.5), chord);
    }
    let near = direction(chunk, level, segment, a.position);
    let along = center_line(on_path(a, near), on_path(b, far), PATH_HERMITE, t);
    let radius = mix(a.radius, b.radius, t);
    return Station(along.position, normalize_or(along.derivative, near), radius, select(a.point, b.point, t > 0.5), chord);
}

// A point of a path, in the form that evaluate.wgsl takes.
fn on_path(p: Stored, tangent: vec3<f32>) -> Corner {
    let none = vec3<f32>(0.0);
    return Corner(p.position, none, p.position, none, none, tangent, p.radius, ROLE_ORDINARY, 0.0, 0.0);
}

// Angle (radians) by which a tube is drawn further around than the half that faces the eye, on each
// side.
const BEYOND: f32 = 0.35;

fn tube_vertex(visible_chunk: VisibleChunk, index: u32, corner: u32) -> SurfaceVertex {
    let chunk = chunks[visible_chunk.chunk];
    let instance_pose = gpu_instances[visible_chunk.instance];
    let level = lod_level(visible_chunk.lod);
    let halvings = lod_halvings(visible_chunk.lod);
    let strips = lod_strips(visible_chunk.lod);
    var width = lod_width(visible_chunk.lod);
    let tube_quads = (segments(chunk, level) << halvings) * strips;
    if (index >= tube_quads) {
        return cap_vertex(visible_chunk, chunk, instance_pose, index - tube_quads, corner);
    }
    let grid = corner_grid(corner);
    let part = index / strips + u32(grid.y);
    let visible_chunks_of_segment = 1u << halvings;
    let segment = (index / strips) >> halvings;
    let t = f32(part - (segment << halvings)) / f32(visible_chunks_of_segment);
    let there = station(chunk, level, segment, t);

    let axis = relative(instance_pose, there.center);
    let pixel = pixel_at(max(dot(eye.forward, axis), eye.near)) / instance_pose.scale;
    width *= wider_without_twigs(chunk, pixel);
    let way = turn(instance_pose.rotation, there.direction);
    let to_eye = towards_eye(axis);
    let side = cross(way, to_eye);
    let square = dot(side, side) > 1e-8;
    let plain = select(across(way), normalize(side), square);
    let up = cross(plain, way);
    // Keeps the strip from twisting where the path turns back on the screen.
    let chord_side = cross(turn(instance_pose.rotation, there.chord), to_eye);
    let sideways = plain * select(1.0, -1.0, dot(plain, chord_side) < 0.0);
    let share = (f32(index % strips) + grid.x) / f32(strips);
    var normal = sideways * (2.0 * share - 1.0);
    var offset = normal;
    if (strips == 1u) {
        // Normals at the strip's edges are tilted by 45°: interpolated between them, they are close
        // to those of a cylinder except near its outline.
        normal = normalize(normal + up);
    } else {
        // With exactly half a turn, gaps would show where paths bend sharply.
        let angle = share * (3.14159265 + 2.0 * BEYOND) - BEYOND;
        normal = up * sin(angle) - sideways * cos(angle);
        offset = normal;
    }
    let radius = there.radius * instance_pose.scale * width;
    return SurfaceVertex(
        axis + offset * radius,
        normal,
        axis,
        radius,
        color_key_at(chunk, there.point),
        visible_chunk.instance,
        grid,
    );
}

// The point that a cap's quad is around.
fn cap_point(chunk: Chunk, index: u32) -> u32 {
    let of_start = index < DOME_QUADS && (chunk.flags & CHUNK_FREE_START) != 0u;
    return select(segments(chunk, 0u), 0u, of_start);
}

// The round cap at a free end of a path.
fn cap_vertex(visible_chunk: VisibleChunk, chunk: Chunk, instance_pose: GpuInstance, index: u32, corner: u32) -> SurfaceVertex {
    let end = stored(chunk, 0u, cap_point(chunk, index));
    let width = lod_width(visible_chunk.lod);
    let radius = end.radius * instance_pose.scale * width;
    var v = sphere_vertex(relative(instance_pose, end.position), radius, WHAT_DOME, index % DOME_QUADS, corner);
    v.radius = radius;
    v.color_key = color_key_at(chunk, end.point);
    v.instance = visible_chunk.instance;
    return v;
}

// A sphere seen from the front.
fn sphere_vertex(center: vec3<f32>, radius: f32, what: u32, index: u32, corner: u32) -> SurfaceVertex {
    let front = towards_eye(center);
    let right = across(front);
    let up = cross(front, right);
    let grid = corner_grid(corner);
    var normal = front;
    var offset = vec3<f32>(0.0);
    if (what == WHAT_DOT) {
        // A square with the area of the sphere's disc, at least a pixel wide.
        let pixel = pixel_at(max(dot(eye.forward, center), eye.near));
        let half = max(0.886 * radius, HALF_PIXEL * pixel) / radius;
        offset = (right * (2.0 * grid.x - 1.0) + up * (2.0 * grid.y - 1.0)) * half;
    } else if (what == WHAT_DISC) {
        if (corner > 0u) {
            let angle = f32(2u * index + corner - 1u) * (6.2831853 / 8.0);
            offset = right * cos(angle) + up * sin(angle);
            normal = normalize(offset + 0.6 * front);
        }
    } else {
        var sector = 2u * index + corner - 1u;
        var polar = 0.7;
        if (corner == 0u) {
            polar = 0.0;
        }
        if (index >= 6u) {
            sector = index - 6u + u32(corner >= 2u);
            polar = select(0.7, 1.5707963, corner == 1u || corner == 2u);
        }
        let angle = f32(sector) * (6.2831853 / 12.0);
        normal = front * cos(polar) + (right * cos(angle) + up * sin(angle)) * sin(polar);
        offset = normal;
    }
    return SurfaceVertex(center + offset * radius, normal, center, radius, 0u, 0u, grid);
}

// A corner of a soma's quad in the template, in the form that evaluate.wgsl takes.
fn soma_corner(chunk: Chunk, vertex: u32) -> Corner {
    let low = packed[chunk.first + 2u * vertex];
    let high = packed[chunk.first + 2u * vertex + 1u];
    let bytes = vec2<i32>(i32(high << 8u) >> 24u, i32(high) >> 24u);
    let normal = from_octahedral(vec2<f32>(bytes) / 127.0);
    let position = stored_position(chunk, low, high);
    return Corner(position, normal, position, normal, normal, normal, 0.0, ROLE_SOMA, 0.0, 0.0);
}

// A vertex of a soma: of its own quads, or of the 4, 16 or 64 that each is refined into.
fn soma_vertex(visible_chunk: VisibleChunk, index: u32, corner: u32) -> SurfaceVertex {
    let chunk = chunks[visible_chunk.chunk];
    let instance_pose = gpu_instances[visible_chunk.instance];
    let halvings = lod_halvings(visible_chunk.lod);
    let own = chunk.first + 2u * chunk.counts.y + 2u * (index >> (2u * halvings));
    let vertices = vec4<u32>(packed[own], packed[own] >> 16u, packed[own + 1u], packed[own + 1u] >> 16u)
        & vec4<u32>(0xffffu);
    let grid = corner_grid(corner);
    var position: vec3<f32>;
    var normal: vec3<f32>;
    if (halvings == 0u) {
        let v = soma_corner(chunk, vertices[corner]);
        position = v.position;
        normal = v.normal;
    } else {
        let side = 1u << halvings;
        let x = (f32(index % side) + grid.x) / f32(side);
        let y = (f32((index / side) % side) + grid.y) / f32(side);
        // Evaluates every edge in the same direction for both its quads.
        let sides = vec4<u32>(EDGE_SOMA) | (SIDE_REVERSED * vec4<u32>(vertices.xywx > vertices.yzzw));
        let shape = PatchShape(
            PATCH_SOMA,
            soma_corner(chunk, vertices.x),
            soma_corner(chunk, vertices.y),
            soma_corner(chunk, vertices.z),
            soma_corner(chunk, vertices.w),
            sides,
        );
        let inside = coons(shape, x, y);
        position = inside.position;
        normal = inside.normal;
    }
    let there = relative(instance_pose, position);
    let facing = turn(instance_pose.rotation, normal);
    return SurfaceVertex(there, facing, there, 0.0, color_key_at(chunk, 0u), visible_chunk.instance, grid);
}
