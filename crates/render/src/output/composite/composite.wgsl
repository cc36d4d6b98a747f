// From our samples to the pass of another program: their color, and their depth as that program measures it. Called by
// composite/mod.rs. SAMPLES is the number of samples of a pixel of ours. With PER_SAMPLE the program's pass has as many,
// and each gets its own; else a pixel is covered as far as our samples cover it, at the nearest depth of them.

#import srgb.wgsl

struct Composite {
    // The program's clip position by our depth (µm), factor and sum: z, then w.
    z: vec2<f32>,
    w: vec2<f32>,
    // Upper left pixel of the viewport.
    origin: vec2<u32>,
    // 1: colors are encoded as screens want them; 0: they stay linear.
    encode: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> composite: Composite;
// Linear, premultiplied.
#ifdef PER_SAMPLE
@group(0) @binding(1) var colors: texture_multisampled_2d<f32>;
#else
@group(0) @binding(1) var colors: texture_2d<f32>;
#endif
// Depths (µm) as bytes; all 0: nothing is there.
#ifdef MULTISAMPLED
@group(0) @binding(2) var depths: texture_multisampled_2d<f32>;
#else
@group(0) @binding(2) var depths: texture_2d<f32>;
#endif

struct Shown {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let place = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(place * 2.0 - 1.0, 0.0, 1.0);
}

// Depth (µm) of a sample, as bits: 0 where nothing is.
fn depth_bits(p: vec2<u32>, number: u32) -> u32 {
    return pack4x8unorm(textureLoad(depths, p, number));
}

// What the program's pass gets. `color` is premultiplied.
fn shown(color: vec4<f32>, depth: f32) -> Shown {
    let clip = vec2(composite.z.x, composite.w.x) * depth + vec2(composite.z.y, composite.w.y);
    var out: Shown;
    out.depth = clip.x / clip.y;
    // As what the program draws itself, nothing shows before its near plane or behind its far one.
    if out.depth < 0.0 || out.depth > 1.0 {
        discard;
    }
    out.color = color;
    if composite.encode != 0u {
        let straight = color.rgb / max(color.a, 1e-4);
        out.color = vec4(encoded(straight) * color.a, color.a);
    }
    return out;
}

#ifdef PER_SAMPLE
@fragment
fn compose(@builtin(position) position: vec4<f32>, @builtin(sample_index) number: u32) -> Shown {
    let p = vec2<u32>(position.xy) - composite.origin;
    let bits = depth_bits(p, number);
    if bits == 0u {
        discard;
    }
    let color = textureLoad(colors, p, number);
    return shown(vec4(color.rgb, 1.0), bitcast<f32>(bits));
}
#else
@fragment
fn compose(@builtin(position) position: vec4<f32>) -> Shown {
    let p = vec2<u32>(position.xy) - composite.origin;
    var nearest = 0.0;
    var any = false;
    for (var k = 0u; k < SAMPLES; k++) {
        let bits = depth_bits(p, k);
        if bits != 0u && (!any || bitcast<f32>(bits) < nearest) {
            nearest = bitcast<f32>(bits);
            any = true;
        }
    }
    if !any {
        discard;
    }
    return shown(textureLoad(colors, p, 0), nearest);
}
#endif
