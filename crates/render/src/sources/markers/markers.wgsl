// Vertices of markers: spheres of triangles, or squares that face the viewer where they are small; of contacts, discs
// that lie on the membrane, too.
// Called by shade.wgsl. Rust twins: mod.rs beside it.

#import octahedral.wgsl
#import surface_vertex.wgsl

struct StoredMarker {
    x: f32,
    y: f32,
    z: f32,
    color_key: u32,
    // Direction away from the center line that it lies around, in octahedral coordinates, or NO_OUTWARDS.
    outwards: u32,
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
    // Size (µm) of a sub-pixel: what each µm of depth adds, and what it is at every depth.
    pixel_slope: f32,
    pixel_flat: f32,
}

@group(0) @binding(0) var<storage, read> markers: array<StoredMarker>;
// Corners of the shapes, one after the other: vectors in the world, with 1 in the last component along the
// view's axes, with 2 the same for something flat. With 3 vectors in the world of a sphere that lies on a disc; with
// 4, 5 and 6 of the top, the edge and the bottom of that disc, whose third axis is outwards.
@group(0) @binding(1) var<storage, read> shapes: array<vec4<f32>>;
@group(0) @binding(2) var<uniform> marker_frame: MarkerFrame;

fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let marker = markers[instance_index];
    let center = vec3(marker.x, marker.y, marker.z) + marker_frame.relative_from_block;
    let depth = max(-dot(center, marker_frame.backward), marker_frame.near);
    let radius = max(marker_frame.radius, marker_frame.least * depth);
    let corner = shapes[vertex_index];
    if corner.w > 2.0 {
        return contact_vertex(marker, center, radius, depth, corner);
    }
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

// A vertex of a sphere on a disc. Both grow out of the sphere around the marker's place while they get larger in the
// picture, so that none appears at once. A marker without a direction stays a sphere.
fn contact_vertex(
    marker: StoredMarker,
    center: vec3<f32>,
    radius: f32,
    depth: f32,
    corner: vec4<f32>,
) -> SurfaceVertex {
    let pixel = marker_frame.pixel_flat + marker_frame.pixel_slope * depth;
    let is_contact = marker.outwards != NO_OUTWARDS;
    let share = select(0.0, smoothstep(GROWS_FROM, GROWS_TO, radius / pixel), is_contact);
    let outwards = unpack_normal(select(0u, marker.outwards, is_contact));
    var offset = corner.xyz + share * LIFT * outwards;
    var normal = corner.xyz;
    if corner.w > 3.0 {
        // Any two axes across (Duff et al., Building an orthonormal basis, revisited, 2017).
        let sign = select(-1.0, 1.0, outwards.z >= 0.0);
        let a = -1.0 / (sign + outwards.z);
        let b = outwards.x * outwards.y * a;
        let right = vec3(1.0 + sign * outwards.x * outwards.x * a, sign * b, -sign * outwards.x);
        let up = vec3(b, sign + outwards.y * outwards.y * a, -outwards.y);
        let aside = corner.x * right + corner.y * up;
        // Within the sphere as long as it does not show.
        offset = mix(0.5, DISC, share) * aside + corner.z * outwards;
        normal = select(select(-outwards, aside, corner.w < 6.0), outwards, corner.w < 5.0);
    }
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
