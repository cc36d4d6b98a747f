// From the bytes of a picture to a texture, with outlines round what a mask says. Called by present.rs, which
// says what the mask is: bytes, or what a draft has drawn.

struct Present {
    size: vec2<u32>,
    // Width (pixels) of outlines; 0: none.
    width: u32,
    spare: u32,
    // sRGB, not linear: what is mixed here is bytes of the screen.
    selected: vec4<f32>,
    hovered: vec4<f32>,
}

@group(0) @binding(0) var<uniform> present: Present;
@group(0) @binding(1) var<storage, read> pixels: array<u32>;
// 1: selected, 2: under the cursor.
@group(0) @binding(2) var mask: MASK_TEXTURE;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let place = vec2(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4(place * 2.0 - 1.0, 0.0, 1.0);
}

fn mask_at(p: vec2<i32>) -> u32 {
    if any(p < vec2(0)) || any(p >= vec2<i32>(textureDimensions(mask))) {
        return 0u;
    }
    return MASK_BITS;
}

// Bits of the mask within the outline's width of a pixel.
fn bits_near(p: vec2<i32>) -> u32 {
    var bits = 0u;
    let width = i32(present.width);
    for (var y = -width; y <= width; y++) {
        for (var x = -width; x <= width; x++) {
            if x * x + y * y <= width * width + 1 {
                bits |= mask_at(p + vec2(x, y));
            }
        }
    }
    return bits;
}

@fragment
fn show(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let p = vec2<u32>(position.xy);
    var colour = unpack4x8unorm(pixels[p.y * present.size.x + p.x]);
    if present.width > 0u {
        let inside = mask_at(vec2<i32>(p));
        let outline = bits_near(vec2<i32>(p)) & ~inside;
        if (outline & 1u) != 0u {
            colour = vec4(mix(colour.rgb, present.selected.rgb, present.selected.a), 1.0);
        }
        if (outline & 2u) != 0u {
            colour = vec4(mix(colour.rgb, present.hovered.rgb, present.hovered.a), 1.0);
        } else if (inside & 2u) != 0u {
            colour = vec4(mix(colour.rgb, present.hovered.rgb, 0.18), 1.0);
        }
    }
    return colour;
}
