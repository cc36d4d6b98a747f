// Vertices of meshes that are no cells. Called by shade.wgsl. Rust twins: mod.rs and geometry.rs beside it.

#import surface_vertex.wgsl
#import octahedral.wgsl

struct MeshVertex {
    x: f32,
    y: f32,
    z: f32,
    normal: u32,
}

struct MeshFrame {
    relative_from_mesh: vec3<f32>,
    // Share of what lies behind that each layer hides.
    opacity: f32,
    color_key: u32,
    // Of the mesh among all.
    number: u32,
    // 1: only edges are drawn.
    edges: u32,
    // Index of the first triangle that is half of a quad.
    first_half: u32,
    // Micrometers of a unit of the mesh's coordinates.
    scale: f32,
    // 1: each vertex has a color key of its own.
    keyed: u32,
}

@group(0) @binding(0) var<storage, read> stored: array<MeshVertex>;
@group(0) @binding(1) var<storage, read> corners: array<u32>;
@group(0) @binding(2) var<uniform> mesh_frame: MeshFrame;
// Color keys of the vertices, if they have any.
@group(0) @binding(3) var<storage, read> own_keys: array<u32>;

// With edges triangles are drawn corner by corner, else by the index buffer.
fn mesh_index(vertex_index: u32) -> u32 {
    if mesh_frame.edges != 0u {
        return corners[vertex_index];
    }
    return vertex_index;
}

fn mesh_key(index: u32) -> u32 {
    if mesh_frame.keyed != 0u {
        return own_keys[index];
    }
    return mesh_frame.color_key;
}

fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex {
    let index = mesh_index(vertex_index);
    var grid = vec2(0.5);
    if mesh_frame.edges != 0u {
        let corner = vertex_index % 3u;
        // The diagonal of a quad lies where x + y is a half: no edge.
        let side = select(1.0, 0.5, vertex_index / 3u >= mesh_frame.first_half);
        grid = side * vec2(f32(corner == 1u), f32(corner == 2u));
    }
    let v = stored[index];
    let position = mesh_frame.scale * vec3(v.x, v.y, v.z) + mesh_frame.relative_from_mesh;
    return SurfaceVertex(
        position,
        unpack_normal(v.normal),
        position,
        0.0,
        mesh_key(index),
        NO_INSTANCE,
        grid,
    );
}
