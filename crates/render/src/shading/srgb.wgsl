// From linear light to the bytes of a picture. Imported by finish.wgsl and recolor.wgsl.

// IEC 61966-2-1.
fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3(0.0), vec3(1.0));
    return select(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, c * 12.92, c <= vec3(0.0031308));
}

// Straight alpha. Not by pack4x8unorm, whose rounding depends on the driver.
fn screen_bytes(linear: vec4<f32>) -> u32 {
    let bytes = vec4<u32>(floor(vec4(encoded(linear.rgb), linear.a) * 255.0 + 0.5));
    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u);
}
