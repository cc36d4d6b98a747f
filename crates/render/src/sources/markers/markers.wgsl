// Vertices of markers: spheres of triangles, or squares that face the viewer where they are small.
// Called by shade.wgsl. Rust twins: mod.rs beside it.

#import surface_vertex.wgsl

struct StoredMarker {
    x: f32,
    y: f32,
    z: f32,
    color_key: u32,
}

struct MarkerFrame {
    relative_from_block: vec3<f32>,
    // Radius (µm), at least the least one without perspective.
    radius: f32,
    right: vec3<f32>,
    near: f32,
    up: vec3<f32>,
    // Least radius (µm) at unit depth; 0 without perspective.
    least: f32,
    backward: vec3<f32>,
    // Index of the block's first marker among all.
    first: u32,
}

@group(0) @binding(0) var<storage, read> markers: array<StoredMarker>;
// Corners of the shapes, one after the other: vectors in the world, with 1 in the last component along the
// view's axes, with 2 the same for something flat.
@group(0) @binding(1) var<storage, read> shapes: array<vec4<f32>>;
@group(0) @binding(2) var<uniform> marker_frame: MarkerFrame;

fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let marker = markers[instance_index];
    let center = vec3(marker.x, marker.y, marker.z) + marker_frame.relative_from_block;
    let depth = max(-dot(center, marker_frame.backward), marker_frame.near);
    let radius = max(marker_frame.radius, marker_frame.least * depth);
    let corner = shapes[vertex_index];
    let axes = mat3x3(marker_frame.right, marker_frame.up, marker_frame.backward);
    let offset = select(corner.xyz, axes * corner.xyz, corner.w > 0.0);
    // What is flat is as light as what faces the viewer.
    let normal = select(offset, marker_frame.backward, corner.w > 1.0);
    return SurfaceVertex(
        center + offset * radius,
        normal,
        center,
        0.0,
        marker.color_key,
        NO_INSTANCE,
        vec2(0.5),
    );
}
