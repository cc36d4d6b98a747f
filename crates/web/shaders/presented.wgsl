// Shows the picture that accumulate.wgsl has written, enlarged if it is a smaller draft. Host: webgpu.js.

struct Presented {
    // Of the picture (pixels).
    size: vec2<u32>,
    // Of the canvas.
    canvas: vec2<f32>,
}

@group(0) @binding(0) var<uniform> presented: Presented;
@group(0) @binding(1) var<storage, read> pixels: array<u32>;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let place = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(place * 2.0 - 1.0, 0.0, 1.0);
}

fn pixel(p: vec2<i32>) -> vec4<f32> {
    let q = vec2<u32>(clamp(p, vec2(0), vec2<i32>(presented.size) - 1));
    return unpack4x8unorm(pixels[q.y * presented.size.x + q.x]);
}

@fragment
fn show(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if all(vec2<f32>(presented.size) == presented.canvas) {
        return pixel(vec2<i32>(position.xy));
    }
    let place = position.xy / presented.canvas * vec2<f32>(presented.size) - 0.5;
    let low = vec2<i32>(floor(place));
    let share = place - floor(place);
    let top = mix(pixel(low), pixel(low + vec2(1, 0)), share.x);
    let bottom = mix(pixel(low + vec2(0, 1)), pixel(low + vec2(1)), share.x);
    return mix(top, bottom, share.y);
}
