// Which samples a translucent surface covers. Called by shade.wgsl for sources with the flag SHEETS.
//
// Theory: Enderton, Sintorn, Shirley & Luebke, Stochastic transparency, 2010. A layer of opacity a covers a share a of
// the samples, and which ones is independent of the layers before and behind it. So the mean over the samples is what
// blending all layers from back to front gives, in whatever order they are drawn.
//
// Practice: 16 samples, those of a block of two by two sub-pixels, are put in an order; a layer covers those whose place in
// it is below 16 a. So a single layer has no grain. There are five kinds of orders. Each begins with all samples of one of
// its four groups, and a group of one kind has one sample in common with each group of another (an orthogonal array of
// strength 2: Hedayat, Sloane & Stufken, Orthogonal arrays, 1999): so two layers of different kinds have no grain
// either, if their opacities are quarters, and little else. Front and back sides have different kinds.
//
// An order is the same for neighboring triangles of one layer, and another for other layers: it depends on the block, the
// mesh, the side that is seen, and the depth, in steps of SHEET_DEPTH sub-pixels. The steps begin elsewhere in each block,
// so that they do not show.

// Depth of what does not stand for its sub-pixel in ambient occlusion, which looks for a sample behind it.
const NO_DEPTH = vec4<f32>(1.0);

fn is_translucent() -> bool {
    return mesh_frame.edges != 0u || mesh_frame.opacity < 1.0;
}

// Coverage of a fragment.
fn sheet_coverage(grid: vec2<f32>) -> f32 {
    if mesh_frame.edges != 0u {
        return mesh_frame.opacity * lines(grid, shade.half_width);
    }
    return mesh_frame.opacity;
}

// O'Neill, PCG: a family of simple fast space-efficient statistically good algorithms for random number generation,
// 2014.
fn scrambled(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A product in the field of four elements: their tables, by the first factor, have two bits for each second one.
fn product(a: u32, b: u32) -> u32 {
    let tables = vec4<u32>(0u, 0xe4u, 0x78u, 0x9cu);
    return (tables[a] >> (2u * b)) & 3u;
}

// Place of a sample, from 0 to 15, in an order of this kind.
fn place_of(index: u32, kind: u32, seed: u32) -> u32 {
    let row = index >> 2u;
    let column = index & 3u;
    // Lines in the plane over that field: of each kind four, which are parallel.
    let group = select(row ^ product(kind & 3u, column), column, kind == 4u);
    let other = select(column, row, kind == 4u);
    // Which group is first, and which sample in each, is random.
    let first = product(1u + (seed >> 2u) % 3u, group) ^ (seed & 3u);
    let bits = seed >> (16u + 4u * first);
    let second = product(1u + ((seed >> 8u) + first) % 3u, other) ^ (bits & 3u);
    return 4u * first + second;
}

// Steps of depth, of which each holds what counts as one layer.
fn steps_of_depth(depth: f32) -> f32 {
    if shade.flat > 0.0 {
        return depth / (SHEET_DEPTH * shade.flat);
    }
    return log(max(depth, shade.near)) / (SHEET_DEPTH * shade.slope);
}

fn sheet_mask(coverage: f32, position: vec4<f32>, relative: vec3<f32>, front: bool) -> u32 {
    if coverage >= 1.0 {
        return (1u << SAMPLES) - 1u;
    }
    let turned = vec2<u32>(position.xy + shade.tile_origin + 4096.0);
    let turn = vec2<u32>(shade.turn);
    // Each step of a progressive picture draws another sub-pixel of its blocks, which are pixels; and each stage of four
    // steps draws all.
    let block = select((turned - turn) >> vec2(1u), turned - turn, shade.steps > 1.0);
    let in_block = turned & vec2(1u);
    let stage = turn >> vec2(1u);
    let sheet = scrambled(2u * mesh_frame.number + select(0u, 1u, front));
    let of_block = scrambled(block.x + scrambled(block.y + scrambled(stage.x + 2u * stage.y + sheet)));
    let begin = f32(of_block >> 8u) / 16777216.0;
    let depth = -dot(relative, shade.backward);
    let layer = u32(i32(floor(steps_of_depth(depth) + begin)) + (1 << 20u));
    let seed = scrambled(of_block + layer);
    let kind = (2u * mesh_frame.number + select(3u + layer % 2u, layer % 3u, front)) % 5u;
    // Below a sixteenth, neighboring blocks differ.
    let x = block.x & 3u;
    let y = block.y & 3u;
    let fine = (bayer(vec2(x, y)) + 0.25 * bayer(vec2(x, y) >> vec2(1u)) - 0.125 + 0.25 * f32(stage.x + 2u * stage.y)) % 1.0;
    var mask = 0u;
    for (var k = 0u; k < SAMPLES; k++) {
        let place = place_of(4u * (in_block.x + 2u * in_block.y) + k, kind, seed);
        if f32(place) + fine < 16.0 * coverage {
            mask |= 1u << k;
        }
    }
    return mask;
}
