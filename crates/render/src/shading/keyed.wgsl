// From a source's vertices to samples that know whose color they have, and how it is lit: for
// static pictures, which are colored anew without being drawn anew. Called by keyed.rs.
//
// Within a triangle colors are interpolated between three corners, so a sample has up to three color
// keys, each with its share. Targets have whole numbers of 16 bits, since no wider ones can be
// multisampled everywhere.

#import shade.wgsl
#import surface_keys.wgsl

struct KeyedVarying {
    @invariant @builtin(position) position: vec4<f32>,
    // Normal, coverage.
    @location(0) normal: vec4<f32>,
    // Position relative to the eye, thinness.
    @location(1) relative: vec4<f32>,
    @location(2) @interpolate(flat) keys: vec4<u32>,
    @location(3) @interpolate(perspective, centroid) shares: vec4<f32>,
    @location(4) @interpolate(flat) instance: u32,
#ifdef SHEETS
    @location(5) grid: vec2<f32>,
#endif
}

struct KeyedSample {
    // Factor of the color, white that is added, and share of the edge's color: the first two reach
    // 2. Then a byte each for the shares of the first two color keys.
    @location(0) weights: vec4<u32>,
    // Two color keys, the lower halves first.
    @location(1) keys: vec4<u32>,
    // A third, and the instance.
    @location(2) owner: vec4<u32>,
#ifdef MULTISAMPLED
    @builtin(sample_mask) mask: u32,
#endif
}

@vertex
fn vertex_keyed(
    @builtin(vertex_index) vertex_index: u32,
    @builtin(instance_index) instance_index: u32,
) -> KeyedVarying {
    let v = shaded_vertex(vertex_index, instance_index);
    let k = surface_keys(vertex_index, instance_index);
    let shares = vec4<f32>(vec4(k.corner) == vec4(0u, 1u, 2u, 3u));
    var out: KeyedVarying;
    out.position = v.position;
    out.normal = vec4(v.normal, v.coverage);
    out.relative = vec4(v.relative, v.thin);
    out.keys = k.keys;
    out.shares = shares;
    out.instance = k.instance;
#ifdef SHEETS
    out.grid = v.grid;
#endif
    return out;
}

@fragment
fn fragment_keyed(in: KeyedVarying, @builtin(front_facing) front: bool) -> KeyedSample {
    let f = facet(in.normal.xyz, in.relative.xyz, in.normal.w, in.relative.w, front);
#ifdef SHEETS
    let mask = sheet_mask(f.coverage * sheet_coverage(in.grid), in.position, in.relative.xyz, front);
#else
    let mask = mask_of(f.coverage, in.position);
#endif
    var weights = vec3(0.5, 0.0, 0.0);
    if shade.lit > 0.0 {
        let l = lights(f.normal, f.to_eye);
        weights = vec3(0.5 * (l.diffuse + l.rim), 0.5 * (l.sheen + 0.25 * l.rim), 0.7 * f.edge);
    }
    // The corners' shares, those of equal color keys together, the largest first.
    var keys = in.keys;
    var shares = max(in.shares, vec4(0.0));
    for (var k = 0u; k < 3u; k++) {
        for (var other = k + 1u; other < 4u; other++) {
            if keys[other] == keys[k] {
                shares[k] += shares[other];
                shares[other] = 0.0;
            }
        }
    }
    for (var k = 0u; k < 3u; k++) {
        for (var other = k + 1u; other < 4u; other++) {
            if shares[other] > shares[k] {
                let key = keys[k];
                let share = shares[k];
                keys[k] = keys[other];
                shares[k] = shares[other];
                keys[other] = key;
                shares[other] = share;
            }
        }
    }
    shares /= max(shares.x + shares.y + shares.z, 1e-6);
    let bytes = vec2<u32>(floor(shares.xy * 255.0 + 0.5));
    let steps = vec3<u32>(floor(clamp(weights, vec3(0.0), vec3(1.0)) * 65535.0 + 0.5));
    var out: KeyedSample;
    out.weights = vec4(steps, max(bytes.x, 1u) | (bytes.y << 8u));
    out.keys = vec4(keys.x & 0xffffu, keys.x >> 16u, keys.y & 0xffffu, keys.y >> 16u);
    out.owner = vec4(keys.z & 0xffffu, keys.z >> 16u, in.instance & 0xffffu, in.instance >> 16u);
#ifdef MULTISAMPLED
    out.mask = mask;
#else
    if mask == 0u { discard; }
#endif
    return out;
}
