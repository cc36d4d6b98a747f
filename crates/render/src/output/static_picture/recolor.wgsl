// From weights and colors to the bytes of a picture: a product of a sparse matrix with the colors
// that show. Called by recolor.rs; collect.wgsl says what the weights are.

#import srgb.wgsl

struct Recolor {
    background: vec4<f32>,
    // Linear color of edges.
    edge: vec4<f32>,
    pixels: u32,
    // Pixels in a row of workgroups.
    row: u32,
    transparent: u32,
    // Bytes of a pixel where nothing is.
    empty: u32,
}

struct Weight {
    // Index of the color.
    color: u32,
    low: u32,
    high: u32,
}

@group(0) @binding(0) var<uniform> recolor: Recolor;
// By pixel: its first weight, and what does not depend on colors: white and coverage.
@group(0) @binding(1) var<storage, read> rows: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> weights: array<Weight>;
// Linear colors; the last component says how much of an edge they have.
@group(0) @binding(3) var<storage, read> colors: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> pixels: array<u32>;

@compute @workgroup_size(64)
fn recolor_pixels(@builtin(global_invocation_id) id: vec3<u32>) {
    let at = id.y * recolor.row + id.x;
    if at >= recolor.pixels || id.x >= recolor.row {
        return;
    }
    let row = rows[at];
    let fixed = 2.0 * unpack2x16unorm(row.y);
    let coverage = fixed.y;
    if coverage == 0.0 {
        pixels[at] = recolor.empty;
        return;
    }
    var sum = vec3(fixed.x);
    for (var k = row.x; k < rows[at + 1u].x; k++) {
        let weight = weights[k];
        let color = colors[weight.color];
        let low = 2.0 * unpack2x16unorm(weight.low);
        let high = 2.0 * unpack2x16unorm(weight.high);
        sum += color.rgb * (low.x - color.a * low.y) + color.a * (recolor.edge.rgb * high.y - high.x);
    }
    var out = vec4(sum + recolor.background.rgb * (1.0 - coverage), 1.0);
    if recolor.transparent == 1u {
        out = vec4(sum / coverage, coverage);
    }
    pixels[at] = screen_bytes(out);
}
