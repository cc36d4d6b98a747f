// Draws vertices that captured.wgsl made: colors, light, widening of thin tubes; and picking ids. The steps are
// those of shade.wgsl, for one level everywhere and one sample. Translated to GLSL ES 3.00; host: webgl.js.

#import lighting.wgsl

struct Kept {
    clip_from_relative: mat4x4<f32>,
    right: vec3<f32>,
    near: f32,
    up: vec3<f32>,
    // What each µm of depth adds to the size (µm) of a pixel, and what it is at every depth.
    slope: f32,
    backward: vec3<f32>,
    flat: f32,
    // Unit direction to the key light in the view.
    key: vec3<f32>,
    // Half the least width (pixels) of neurites.
    least_half_width: f32,
    // Rows of the transform from the cell's coordinates to those relative to the eye.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    // Linear color of all that is drawn, if the last component is 1: for lines.
    ink: vec4<f32>,
}

@group(0) @binding(0) var<uniform> shade: Kept;
// Linear colors by key, 1,024 in a row; the last component is 0 for those that are hidden.
@group(0) @binding(1) var table: texture_2d<f32>;

struct Varying {
    @builtin(position) position: vec4<f32>,
    // Normal, coverage.
    @location(0) normal: vec4<f32>,
    // Position relative to the eye, thinness.
    @location(1) relative: vec4<f32>,
    @location(2) color: vec4<f32>,
}

const KIND_STEP: u32 = 1u << 21u;

fn key_of(number: f32) -> u32 {
    return (u32(number) - 1u) % KIND_STEP;
}

fn placed(p: vec4<f32>) -> vec3<f32> {
    return vec3(dot(shade.row_x, p), dot(shade.row_y, p), dot(shade.row_z, p));
}

@vertex
fn vertex(@location(0) place: vec4<f32>, @location(1) around: vec4<f32>) -> Varying {
    var out: Varying;
    let key = key_of(max(around.w, 1.0));
    let color = textureLoad(table, vec2<u32>(key & 1023u, key >> 10u), 0);
    let normal = normalize(placed(vec4(around.xyz, 0.0)) + vec3(1e-20, 0.0, 0.0));
    var relative = placed(vec4(place.xyz, 1.0));
    var thin = 0.0;
    if place.w > 0.0 {
        let depth = max(-dot(relative - normal * place.w, shade.backward), shade.near);
        let pixel = shade.slope * depth + shade.flat;
        let narrowest = 0.5 * pixel;
        thin = max(1.0 - 0.5 * place.w / narrowest, 0.0);
        let widened = max(narrowest, shade.least_half_width * pixel);
        relative += normal * max(widened - place.w, 0.0);
    }
    out.position = shade.clip_from_relative * vec4(relative, 1.0);
    if around.w == 0.0 {
        // There is no patch: beyond the far plane.
        out.position = vec4(0.0, 0.0, 2.0, 1.0);
    }
    // As in shade.wgsl: the border of what is hidden is at the last vertex that is not.
    out.normal = vec4(normal, select(-1000.0, 1.0, color.a > 0.0));
    out.relative = vec4(relative, thin);
    out.color = vec4(mix(color.rgb, shade.ink.rgb, shade.ink.a * (1.0 - thin)), f32(key));
    return out;
}

// A marker: a corner of a unit sphere; a center relative to the eye, and a radius; a linear color.
@vertex
fn marker(@location(0) corner: vec4<f32>, @location(1) center: vec4<f32>, @location(2) color: vec4<f32>) -> Varying {
    var out: Varying;
    let depth = max(-dot(center.xyz, shade.backward), shade.near);
    // At least three pixels wide, as in pictures.
    let radius = max(center.w, 1.5 * (shade.slope * depth + shade.flat));
    let relative = center.xyz + radius * corner.xyz;
    out.position = shade.clip_from_relative * vec4(relative, 1.0);
    out.normal = vec4(corner.xyz, 1.0);
    out.relative = vec4(relative, 0.0);
    out.color = vec4(color.rgb, 0.0);
    return out;
}

// IEC 61966-2-1.
fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3(0.0), vec3(1.0));
    return select(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, c * 12.92, c <= vec3(0.0031308));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    if in.normal.w <= 0.0 {
        discard;
    }
    if shade.ink.a > 0.0 {
        return vec4(encoded(in.color.rgb), 1.0);
    }
    let axes = mat3x3(shade.right, shade.up, shade.backward);
    let to_eye = select(-normalize(in.relative.xyz) * axes, vec3(0.0, 0.0, 1.0), shade.flat > 0.0);
    let n = normalize(mix(normalize(in.normal.xyz) * axes, to_eye, in.relative.w));
    return vec4(encoded(light(in.color.rgb, 1.0, lights(n, to_eye))), 1.0);
}

// The color key plus 1 in three bytes.
@fragment
fn fragment_id(in: Varying) -> @location(0) vec4<f32> {
    if in.normal.w <= 0.0 {
        discard;
    }
    let id = u32(in.color.w + 0.5) + 1u;
    return vec4(vec3<f32>(vec3(id, id >> 8u, id >> 16u) & vec3(0xffu)) / 255.0, 1.0);
}

struct Facing {
    // Normal in the view, mapped from -1..1 to 0..1.
    @location(0) normal: vec4<f32>,
    // Depth (µm), not 0, as the bytes of an f32.
    @location(1) depth: vec4<f32>,
}

// What shadows.wgsl needs to know.
@fragment
fn fragment_facing(in: Varying) -> Facing {
    if in.normal.w <= 0.0 {
        discard;
    }
    let axes = mat3x3(shade.right, shade.up, shade.backward);
    let n = normalize(in.normal.xyz) * axes;
    let depth = -dot(in.relative.xyz, shade.backward);
    let bits = bitcast<u32>(select(depth, 1e-20, depth == 0.0));
    let bytes = vec4(bits, bits >> 8u, bits >> 16u, bits >> 24u) & vec4(0xffu);
    return Facing(vec4(n * 0.5 + 0.5, 1.0), vec4<f32>(bytes) / 255.0);
}
