// From the samples of keyed.wgsl to the weights of each pixel's color keys. Called by collect.rs.
//
// Linear light of a pixel is a sum over its samples of
//     occlusion * ((a * color + b) * (1 - e * s) + e * s * edge)
// where a, b and s are the sample's weights, color and e those of its color key. So what a color key
// adds to a pixel is given by four sums: of a, a * s, b * s and s, each times occlusion; and the sum
// of b is the same whatever the colors are.

#import finish.wgsl

struct Weighed {
    pixel: u32,
    color_key: u32,
    instance: u32,
    // a and a * s, then b * s and s: see packed.
    low: u32,
    high: u32,
}

#ifdef MULTISAMPLED
@group(1) @binding(0) var weights: texture_multisampled_2d<u32>;
@group(1) @binding(1) var keys: texture_multisampled_2d<u32>;
@group(1) @binding(2) var owners: texture_multisampled_2d<u32>;
#else
@group(1) @binding(0) var weights: texture_2d<u32>;
@group(1) @binding(1) var keys: texture_2d<u32>;
@group(1) @binding(2) var owners: texture_2d<u32>;
#endif
// By pixel: sum of b, and coverage.
@group(1) @binding(3) var<storage, read_write> fixed: array<vec2<f32>>;
@group(1) @binding(4) var<storage, read_write> weighed: array<Weighed>;
@group(1) @binding(5) var<storage, read_write> cursor: atomic<u32>;

// Sums reach 2.
fn packed(sums: vec2<f32>) -> u32 {
    return pack2x16unorm(0.5 * sums);
}

// The two color keys that came last, and their sums: neighboring samples mostly have the same. What
// drops out of them is written. So a pixel may have a color key more than once, and in any order; the
// host adds these up. A list of all color keys of a pixel took a processor ten times as long.
var<private> names: array<vec2<u32>, 2>;
var<private> sums: array<vec4<f32>, 2>;
var<private> filled: u32;

fn write(pixel: u32, name: vec2<u32>, sum: vec4<f32>) {
    let place = atomicAdd(&cursor, 1u);
    // With too little room the host makes more and asks again.
    if place < arrayLength(&weighed) {
        weighed[place] = Weighed(pixel, name.x, name.y, packed(sum.xy), packed(sum.zw));
    }
}

fn add(pixel: u32, name: vec2<u32>, sum: vec4<f32>) {
    if filled > 0u && all(names[0] == name) {
        sums[0] += sum;
        return;
    }
    if filled > 1u && all(names[1] == name) {
        sums[1] += sum;
        return;
    }
    if filled == 2u {
        write(pixel, names[1], sums[1]);
    }
    names[1] = names[0];
    sums[1] = sums[0];
    names[0] = name;
    sums[0] = sum;
    filled = min(filled + 1u, 2u);
}

@compute @workgroup_size(8, 8)
fn collect(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= finish.kept) {
        return;
    }
    let pixel = id.y * finish.kept.x + id.x;
    let share = 1.0 / f32(finish.scale * finish.scale * SAMPLES);
    var whole = vec2(0.0);
    filled = 0u;
    for (var y = 0u; y < finish.scale; y++) {
        for (var x = 0u; x < finish.scale; x++) {
            let p = vec2<i32>(id.xy * finish.scale + vec2(x, y) + finish.inset);
            // A band has targets of its own for keys, but not for what is finished.
            let finished = p + vec2(0, i32(finish.spare));
            if textureLoad(colors, finished, 0).a == 0.0 {
                continue;
            }
            var light = share;
            if finish.radius > 0.0 {
                light *= occlusion_at(finished);
            }
            for (var k = 0; k < i32(SAMPLES); k++) {
                let bits = textureLoad(weights, p, k);
                if bits.w == 0u {
                    continue;
                }
                let w = vec3<f32>(bits.xyz) / 65535.0 * vec3(2.0, 2.0, 1.0);
                whole += vec2(w.y * light, share);
                let sum = vec4(w.x, w.x * w.z, w.y * w.z, w.z) * light / 255.0;
                let key = textureLoad(keys, p, k);
                let owner = textureLoad(owners, p, k);
                let named = vec3(key.x, key.z, owner.x) | (vec3(key.y, key.w, owner.y) << vec3(16u));
                let instance = owner.z | (owner.w << 16u);
                let bytes = vec2(bits.w & 0xffu, bits.w >> 8u);
                let shares = vec3(bytes, 255u - min(bytes.x + bytes.y, 255u));
                for (var j = 0u; j < 3u && shares[j] > 0u; j++) {
                    add(pixel, vec2(named[j], instance), sum * f32(shares[j]));
                }
            }
        }
    }
    for (var k = 0u; k < filled; k++) {
        write(pixel, names[k], sums[k]);
    }
    fixed[pixel] = whole;
}
