// Ambient occlusion from depth and normals. Called by tiles/mod.rs. Rust twin of the uniform:
// finish.rs.
//
// Theory: McGuire, Mara & Luebke, Scalable ambient obscurance, HPG 2012: samples on a spiral, each
// weighted by how far it rises above the tangent plane, less with greater distance. The blur is
// theirs too, along rows and then along columns; it stops where the depth jumps.

#import finish.wgsl
#import blocks.wgsl

// The first sample of a sub-pixel that nothing translucent covers, and the bytes of its depth; 0 if all are covered.
// It stands for the sub-pixel: what is translucent neither is occluded nor occludes.
fn solid_sample(p: vec2<i32>) -> vec2<u32> {
    for (var k = 0; k < i32(SAMPLES); k++) {
        let bytes = pack4x8unorm(textureLoad(depths, p, k));
        if bytes != 0xffffffffu {
            return vec2(u32(k), bytes);
        }
    }
    return vec2(0u);
}

@compute @workgroup_size(8, 8)
fn copy_depths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let id = within_block(COVERED, workgroup, local);
    if any(id >= finish.tile_size) {
        return;
    }
    let p = vec2<i32>(id);
    // The bytes of an f32: see shade.wgsl.
    raw[index_of(p)] = vec2(1.0, bitcast<f32>(solid_sample(p).y));
}

@compute @workgroup_size(8, 8)
fn occlude(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let p = vec2<i32>(within_block(OCCLUDED, workgroup, local));
    let depth = depth_at(p);
    if depth == 0.0 {
        return;
    }
    let center = view_at(p, depth);
    let solid = i32(solid_sample(p).x);
    let n = normalize(textureLoad(normals, p, solid).xyz * 2.0 - 1.0);
    let pixel = finish.slope * depth + finish.flat;
    let reach = min(finish.radius / pixel, finish.most);
    let radius = reach * pixel;
    let whole = vec2<u32>(p + finish.tile_origin + 65536);
    // One of 16 turns of the spiral, so that neighboring sub-pixels, which the blur averages,
    // sample different directions.
    let turn = f32((whole.x & 3u) + 4u * ((whole.y & 3u) ^ ((whole.x & 1u) << 1u))) / 16.0;
    var sum = 0.0;
    for (var i = 0u; i < TAPS; i++) {
        let share = (f32(i) + 0.5 + turn * 0.5) / f32(TAPS);
        let angle = (f32(i) * 0.618034 + turn) * 6.2831853;
        let offset = vec2(cos(angle), sin(angle)) * reach * share;
        let q = p + vec2<i32>(round(offset));
        let other = depth_at(q);
        if other == 0.0 {
            continue;
        }
        let v = view_at(q, other) - center;
        let distance = length(v);
        let rise = max(dot(v, n) / max(distance, 1e-20) - 0.12, 0.0);
        // Up to twice the radius, since things that are closer to the eye also occlude.
        let far = min(distance / (2.0 * radius), 1.0);
        sum += rise * (1.0 - far * far);
    }
    raw[index_of(p)].x = max(1.0 - STRENGTH * sum / f32(TAPS), 0.0);
}

// Weight of a neighbor in the blur: 1 at the same depth, falling to 0 at 0.3 of the occlusion's
// radius.
fn alike(depth: f32, other: f32) -> f32 {
    if other == 0.0 {
        return 0.0;
    }
    let reach = min(finish.radius, finish.most * finish.slope * depth + finish.most * finish.flat);
    return max(1.0 - abs(other - depth) / (0.3 * reach), 0.0);
}

// What the blur makes of a sub-pixel and its neighbors in one direction: of the shares that occlusion gave, or
// with `columns` of those that are blurred along rows already.
fn blur(p: vec2<i32>, depth: f32, direction: vec2<i32>, columns: bool) -> f32 {
    var sum = 0.0;
    var weights = 0.0;
    for (var k = -BLUR; k <= BLUR; k++) {
        let q = p + k * direction;
        let weight = alike(depth, depth_at(q)) * f32(BLUR + 1 - abs(k));
        if weight > 0.0 {
            weights += weight;
            if columns {
                sum += weight * blurred[index_of(q)];
            } else {
                sum += weight * raw[index_of(q)].x;
            }
        }
    }
    return sum / weights;
}

@compute @workgroup_size(8, 8)
fn blur_rows(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let p = vec2<i32>(within_block(OCCLUDED, workgroup, local));
    let depth = depth_at(p);
    if depth != 0.0 {
        blurred[index_of(p)] = blur(p, depth, vec2(1, 0), false);
    }
}

@compute @workgroup_size(8, 8)
fn blur_columns(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let p = vec2<i32>(within_block(OCCLUDED, workgroup, local));
    let depth = depth_at(p);
    if depth != 0.0 {
        raw[index_of(p)].x = blur(p, depth, vec2(0, 1), true);
    }
}
