// Ambient occlusion where there are no compute passes: each of its steps draws the whole picture. The last one darkens
// what is drawn already. Translated to GLSL ES 3.00; host: shadows.js.

#import obscurance.wgsl

struct Shadows {
    size: vec2<f32>,
    // What each µm of depth adds to the size (µm) of a pixel, and what it is at every depth.
    slope: f32,
    flat: f32,
    // Radius of occlusion (µm), at most `most` pixels.
    radius: f32,
    most: f32,
    tile_origin: vec2<i32>,
}

@group(0) @binding(0) var<uniform> finish: Shadows;
// Normals in the view, mapped to 0..1, and depths (µm) as the bytes of an f32: what kept.wgsl draws.
@group(0) @binding(1) var normals: texture_2d<f32>;
@group(0) @binding(2) var depths: texture_2d<f32>;
// What the step before made.
@group(0) @binding(3) var shares: texture_2d<f32>;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let place = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(place * 2.0 - 1.0, 0.0, 1.0);
}

fn depth_at(p: vec2<i32>) -> f32 {
    if any(p < vec2(0)) || any(p >= vec2<i32>(finish.size)) {
        return 0.0;
    }
    let bytes = vec4<u32>(textureLoad(depths, p, 0) * 255.0 + 0.5);
    return bitcast<f32>(bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u));
}

// Position in the view (µm). Rows count upwards here.
fn view_at(p: vec2<i32>, depth: f32) -> vec3<f32> {
    let place = vec2<f32>(p) + 0.5 - 0.5 * finish.size;
    return vec3(place * (finish.slope * depth + finish.flat), -depth);
}

fn share_at(p: vec2<i32>, columns: bool) -> f32 {
    return textureLoad(shares, p, 0).x;
}

@fragment
fn occlude(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let p = vec2<i32>(position.xy);
    let depth = depth_at(p);
    if depth == 0.0 {
        return vec4(1.0);
    }
    let n = normalize(textureLoad(normals, p, 0).xyz * 2.0 - 1.0);
    return vec4(vec3(light_reaching(p, depth, n)), 1.0);
}

@fragment
fn blur_rows(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let p = vec2<i32>(position.xy);
    let depth = depth_at(p);
    if depth == 0.0 {
        return vec4(1.0);
    }
    return vec4(vec3(blur(p, depth, vec2(1, 0), false)), 1.0);
}

// What is drawn is multiplied with it, in the screen's colors: to a power as light is encoded in them, nearly.
@fragment
fn darken(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let p = vec2<i32>(position.xy);
    let depth = depth_at(p);
    if depth == 0.0 {
        return vec4(1.0);
    }
    let share = blur(p, depth, vec2(0, 1), true);
    return vec4(vec3(pow(clamp(share, 0.0, 1.0), 1.0 / 2.2)), 1.0);
}
