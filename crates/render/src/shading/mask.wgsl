// From the texture of normals, whose last component holds bits of outlines, to a mask: the bits of
// all samples of a pixel. For drafts. Called by present.rs.

#ifdef MULTISAMPLED
@group(0) @binding(0) var normals: texture_multisampled_2d<f32>;
#else
@group(0) @binding(0) var normals: texture_2d<f32>;
#endif

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let place = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(place * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn gather(@builtin(position) position: vec4<f32>) -> @location(0) u32 {
    var bits = 0u;
    for (var k = 0; k < SAMPLES; k++) {
        bits |= u32(textureLoad(normals, vec2<i32>(position.xy), k).a * 255.0 + 0.5);
    }
    return bits;
}
