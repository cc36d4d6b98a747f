// What the passes after the drawing share. Rust twin: finish.rs.

#import srgb.wgsl

struct Finish {
    tile_size: vec2<u32>,
    tile_origin: vec2<i32>,
    // Half the whole picture (sub-pixels).
    half_size: vec2<f32>,
    // What each µm of depth adds to the size (µm) of a sub-pixel.
    slope: f32,
    // Sub-pixels per pixel, along one side.
    scale: u32,
    // Radius of occlusion (µm), at most `most` sub-pixels; 0: none.
    radius: f32,
    most: f32,
    // 1: a tile of a saved picture, which has occlusion for each of its sub-pixels.
    tiled: u32,
    // For gather: 1 if the background is transparent. For accumulate: 1 if there is a single step.
    clear: u32,
    // Size of the part that is kept (pixels).
    kept: vec2<u32>,
    // For accumulate: number of steps before this one. For collect: rows above the band.
    spare: u32,
    // Bytes of a pixel where nothing is.
    empty: u32,
    // Linear color of the background.
    background: vec4<f32>,
    // Size (µm) of a sub-pixel at every depth: 0 with perspective.
    flat: f32,
    // Upper left sub-pixel of the part that is kept.
    inset: vec2<u32>,
}

@group(0) @binding(0) var<uniform> finish: Finish;
@group(0) @binding(1) var colors: texture_2d<f32>;
#ifdef MULTISAMPLED
@group(0) @binding(2) var normals: texture_multisampled_2d<f32>;
@group(0) @binding(3) var depths: texture_multisampled_2d<f32>;
#else
@group(0) @binding(2) var normals: texture_2d<f32>;
@group(0) @binding(3) var depths: texture_2d<f32>;
#endif
// Of each sub-pixel: share of the light that reaches it, and depth (µm), 0 where nothing is. Depths are read many
// times: in software, a texture of samples costs twice as much.
@group(0) @binding(4) var<storage, read_write> raw: array<vec2<f32>>;
// The first share, blurred along rows.
@group(0) @binding(5) var<storage, read_write> blurred: array<f32>;
@group(0) @binding(6) var<storage, read_write> pixels: array<u32>;
// Blocks of 8 × 8 in which anything shows: see blocks.wgsl.
@group(0) @binding(7) var<storage, read_write> blocks: array<u32>;

// Index of a sub-pixel that is in the tile.
fn index_of(p: vec2<i32>) -> u32 {
    return u32(p.y) * finish.tile_size.x + u32(p.x);
}

// Depth (µm), 0 where nothing is.
fn depth_at(p: vec2<i32>) -> f32 {
    if any(p < vec2(0)) || any(p >= vec2<i32>(finish.tile_size)) {
        return 0.0;
    }
    return raw[index_of(p)].y;
}

// Position in the view (µm): right, up, backward.
fn view_at(p: vec2<i32>, depth: f32) -> vec3<f32> {
    let place = vec2<f32>(p + finish.tile_origin) + 0.5 - finish.half_size;
    let across = place * vec2(1.0, -1.0);
    return vec3(across * finish.slope * depth + across * finish.flat, -depth);
}

// Share of the light that reaches what is drawn at a sub-pixel.
fn occlusion_at(p: vec2<i32>) -> f32 {
    let here = raw[index_of(p)];
    // Progressive pictures have the occlusion of their first step, which may have seen nothing here: then it is as at
    // the neighbors.
    if here.y != 0.0 || finish.tiled == 1u {
        return here.x;
    }
    var sum = vec2(0.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let q = p + vec2(x, y);
            if depth_at(q) != 0.0 {
                sum += vec2(raw[index_of(q)].x, 1.0);
            }
        }
    }
    return select(1.0, sum.x / sum.y, sum.y > 0.0);
}
