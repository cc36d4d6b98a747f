// Corners of patches as they are drawn: made once a frame, whatever the level. Every patch that meets in
// a corner reads the same bits here.
//
// Written by coarse.wgsl, read by vertices.wgsl. The twin of the struct stands in work.rs.

// At coarse_place: corners of rings by slot, then loose vertices.
struct CoarseVertex {
    // Relative to the eye (micrometres).
    x: f32,
    y: f32,
    z: f32,
    radius: f32,
    // Unit directions on an octahedron: of the surface, and from the tube's centre.
    normal: u32,
    radial: u32,
    word: u32,
    instance: u32,
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
