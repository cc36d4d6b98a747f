// Unit vectors in 32 bits. Rust twin: octahedral.rs.

// Unit vector from octahedral coordinates (Meyer et al., On floating-point normal vectors, 2010).
fn unpack_normal(packed: u32) -> vec3<f32> {
    let p = unpack2x16snorm(packed);
    let z = 1.0 - abs(p.x) - abs(p.y);
    let fold = max(-z, 0.0);
    let folded = p - select(vec2(-fold), vec2(fold), p >= vec2(0.0));
    return normalize(vec3(folded, z));
}
