// Vertices of a surface that was refined beforehand and is stored in buffers. Called by shade.wgsl.
// Rust twin: stored.rs. BARYCENTRIC says whether no two triangles share corners.

#import surface_vertex.wgsl
#import octahedral.wgsl

struct StoredVertex {
    x: f32,
    y: f32,
    z: f32,
    radius: f32,
    normal: u32,
    color_key: u32,
}

struct Placement {
    relative_from_mesh: vec3<f32>,
    instance: u32,
}

@group(0) @binding(0) var<storage, read> stored: array<StoredVertex>;
@group(0) @binding(1) var<storage, read> corners: array<u32>;
@group(0) @binding(2) var<uniform> placement: Placement;

fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    var index = vertex_index;
    var grid = vec2(0.5);
    if BARYCENTRIC {
        index = corners[vertex_index];
        let corner = vertex_index % 3u;
        grid = vec2(f32(corner == 1u), f32(corner == 2u));
    }
    let v = stored[index];
    let position = vec3(v.x, v.y, v.z) + placement.relative_from_mesh;
    let normal = unpack_normal(v.normal);
    return SurfaceVertex(
        position,
        normal,
        position - normal * v.radius,
        v.radius,
        v.color_key,
        placement.instance,
        grid,
    );
}
