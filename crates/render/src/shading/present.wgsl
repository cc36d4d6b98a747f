// From the bytes of a picture to a texture, with outlines around the things in a mask. Called by
// present.rs.
//
// One pixel is left free between a selected thing and its outline. Without it, neurites of a
// pixel's width would seem to have the outline's color.

struct Present {
    size: vec2<u32>,
    // Width (pixels) of outlines; 0: none.
    width: u32,
    // Opacity of outlines around whole things.
    opacity: f32,
    // sRGB, not linear: these colors are mixed with the screen's bytes.
    selected: vec4<f32>,
    hovered: vec4<f32>,
}

@group(0) @binding(0) var<uniform> present: Present;
@group(0) @binding(1) var<storage, read> pixels: array<u32>;
// 1: selected, 2: under the cursor, 4: the part that was clicked.
@group(0) @binding(2) var mask: texture_2d<u32>;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let place = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(place * 2.0 - 1.0, 0.0, 1.0);
}

fn mask_at(p: vec2<i32>) -> u32 {
    if any(p < vec2(0)) || any(p >= vec2<i32>(textureDimensions(mask))) {
        return 0u;
    }
    return textureLoad(mask, p, 0).r;
}

// Bits of the mask: at a pixel, within a pixel of it, and within the reach of outlines.
fn bits_near(p: vec2<i32>) -> vec3<u32> {
    var bits = vec3(mask_at(p));
    let reach = i32(present.width) + 1;
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            let square = x * x + y * y;
            if square > reach * reach + 1 {
                continue;
            }
            let here = mask_at(p + vec2(x, y));
            bits.z |= here;
            if square <= 2 {
                bits.y |= here;
            }
        }
    }
    return bits;
}

@fragment
fn show(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let p = vec2<u32>(position.xy);
    var color = unpack4x8unorm(pixels[p.y * present.size.x + p.x]);
    if present.width == 0u {
        return color;
    }
    let bits = bits_near(vec2<i32>(p));
    // Whole neurons have a free pixel between them and their outline, parts of them have none.
    let around = (bits.z & ~bits.y & 3u) | (bits.y & ~bits.x & 6u);
    if (around & 5u) != 0u {
        let opacity = select(present.opacity, present.selected.a, (around & 4u) != 0u);
        color = vec4(mix(color.rgb, present.selected.rgb, opacity), 1.0);
    }
    if (around & 2u) != 0u {
        color = vec4(mix(color.rgb, present.hovered.rgb, present.hovered.a), 1.0);
    }
    return color;
}
