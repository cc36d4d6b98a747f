// What a vertex source returns of a vertex for pictures that are colored anew: see mod.rs beside it.

struct SurfaceKeys {
    // Color keys of the corners of the vertex's patch: the same for all vertices of a triangle.
    keys: vec4<u32>,
    // The corner whose color key is the vertex's own.
    corner: u32,
    instance: u32,
}
