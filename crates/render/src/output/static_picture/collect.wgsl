// From the samples of keyed.wgsl to the weights of each pixel's color keys. Called by collect.rs.
//
// Linear light of a pixel is a sum over its samples of
//     occlusion * ((a * color + b) * (1 - e * s) + e * s * edge)
// where a, b and s are the sample's weights, color and e those of its color key. So what a color key
// adds to a pixel is given by four sums: of a, a * s, b * s and s, each times occlusion; and the sum
// of b is the same whatever the colors are.

#import finish.wgsl

struct Weighed {
    color_key: u32,
    instance: u32,
    // a and a * s, then b * s and s: see packed.
    low: u32,
    high: u32,
}

struct Span {
    first: u32,
    count: u32,
    // Sum of b, and coverage.
    white: f32,
    coverage: f32,
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
@group(1) @binding(3) var<storage, read_write> spans: array<Span>;
@group(1) @binding(4) var<storage, read_write> weighed: array<Weighed>;
@group(1) @binding(5) var<storage, read_write> cursor: atomic<u32>;

// Sums reach 2.
fn packed(sums: vec2<f32>) -> u32 {
    return pack2x16unorm(0.5 * sums);
}

// Three for each sample.
var<private> named: array<vec2<u32>, MOST_NAMED>;
var<private> sums: array<vec4<f32>, MOST_NAMED>;
var<private> names: u32;

fn add(name: vec2<u32>, sum: vec4<f32>) {
    for (var k = 0u; k < names; k++) {
        if all(named[k] == name) {
            sums[k] += sum;
            return;
        }
    }
    named[names] = name;
    sums[names] = sum;
    names += 1u;
}

@compute @workgroup_size(8, 8)
fn collect(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= finish.kept) {
        return;
    }
    let share = 1.0 / f32(finish.scale * finish.scale * SAMPLES);
    names = 0u;
    var white = 0.0;
    var coverage = 0.0;
    for (var y = 0u; y < finish.scale; y++) {
        for (var x = 0u; x < finish.scale; x++) {
            let p = vec2<i32>(id.xy * finish.scale + vec2(x, y) + finish.margin);
            var light = -1.0;
            for (var k = 0; k < i32(SAMPLES); k++) {
                let packed_weights = textureLoad(weights, p, k);
                if packed_weights.w == 0u {
                    continue;
                }
                if light < 0.0 {
                    light = 1.0;
                    if finish.radius > 0.0 {
                        light = occlusion_at(p);
                    }
                }
                let w = vec3<f32>(packed_weights.xyz) / 65535.0 * vec3(2.0, 2.0, 1.0);
                let key = textureLoad(keys, p, k);
                let owner = textureLoad(owners, p, k);
                let instance = owner.z | (owner.w << 16u);
                let sum = vec4(w.x, w.x * w.z, w.y * w.z, w.z) * light * share;
                let bytes = vec2(packed_weights.w & 0xffu, packed_weights.w >> 8u);
                add(vec2(key.x | (key.y << 16u), instance), sum * f32(bytes.x) / 255.0);
                if bytes.y > 0u {
                    add(vec2(key.z | (key.w << 16u), instance), sum * f32(bytes.y) / 255.0);
                }
                let rest = 255u - min(bytes.x + bytes.y, 255u);
                if rest > 1u {
                    add(vec2(owner.x | (owner.y << 16u), instance), sum * f32(rest) / 255.0);
                }
                white += w.y * light * share;
                coverage += share;
            }
        }
    }
    let first = atomicAdd(&cursor, names);
    spans[id.y * finish.kept.x + id.x] = Span(first, names, white, coverage);
    // With too little room the host makes more and asks again.
    if first + names <= arrayLength(&weighed) {
        for (var k = 0u; k < names; k++) {
            weighed[first + k] = Weighed(named[k].x, named[k].y, packed(sums[k].xy), packed(sums[k].zw));
        }
    }
}
