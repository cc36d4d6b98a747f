// What is resident of a coarse mesh, and how a patch and its corners are found in it.
//
// Called by everything that evaluates patches. This is the only file that knows the layout: another
// layout is another file with the same functions. Rust twin: template.rs.

struct PackedVertex {
    position: vec3<f32>,
    tracing: u32,
    normal: vec3<f32>,
    word: u32,
}

struct PackedTracing {
    center: vec3<f32>,
    radius: f32,
    tangent: vec3<f32>,
    role_and_value: u32,
}

// Where a part of a mesh begins in the buffers.
struct Base {
    vertex: u32,
    tracing: u32,
    first_patch: u32,
}

// A patch by its kind and the vertices at its corners.
struct Patch {
    kind: u32,
    corners: vec4<u32>,
}

@group(0) @binding(0) var<storage, read> vertices: array<PackedVertex>;
@group(0) @binding(1) var<storage, read> tracing: array<PackedTracing>;
@group(0) @binding(2) var<storage, read> patches: array<vec4<u32>>;

fn patch_at(base: Base, index: u32) -> Patch {
    let packed = patches[base.first_patch + index];
    return Patch(packed.x >> PATCH_KIND_SHIFT, packed & vec4<u32>(PATCH_CORNER_MASK));
}

fn corner(base: Base, vertex: u32) -> Corner {
    let v = vertices[base.vertex + vertex];
    let t = tracing[base.tracing + v.tracing];
    let offset = v.position - t.center;
    return Corner(
        v.position,
        v.normal,
        t.center,
        offset,
        normalize_or(offset, v.normal),
        t.tangent,
        t.radius,
        t.role_and_value & 0xffu,
    );
}

fn position_of(base: Base, vertex: u32) -> vec3<f32> {
    return vertices[base.vertex + vertex].position;
}

// The tracing point of a vertex.
fn tracing_of(base: Base, vertex: u32) -> u32 {
    return vertices[base.vertex + vertex].tracing;
}

fn role_of(base: Base, vertex: u32) -> u32 {
    return tracing[base.tracing + tracing_of(base, vertex)].role_and_value & 0xffu;
}

// The user's level at a vertex.
fn value_of(base: Base, vertex: u32) -> u32 {
    return (tracing[base.tracing + tracing_of(base, vertex)].role_and_value >> 8u) & 0xffu;
}

// What the renderer put beside a vertex: its colour.
fn word_of(base: Base, vertex: u32) -> u32 {
    return vertices[base.vertex + vertex].word;
}
