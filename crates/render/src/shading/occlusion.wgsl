// Ambient occlusion from depth and normals. Called by tiles/mod.rs. Rust twin of the uniform:
// finish.rs.

#import finish.wgsl
#import blocks.wgsl
#import obscurance.wgsl

// The first sample of a sub-pixel that something solid covers, and the bytes of its depth; 0 if there is none.
// It stands for the sub-pixel: what is translucent neither is occluded nor occludes. Samples that nothing covers have
// bytes of 0, which no depth has.
fn solid_sample(p: vec2<i32>) -> vec2<u32> {
    for (var k = 0; k < i32(SAMPLES); k++) {
        let bytes = pack4x8unorm(textureLoad(depths, p, k));
        if bytes != 0u && bytes != 0xffffffffu {
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
    let solid = i32(solid_sample(p).x);
    let n = normalize(textureLoad(normals, p, solid).xyz * 2.0 - 1.0);
    raw[index_of(p)].x = light_reaching(p, depth, n);
}

// Of the shares that occlusion gave, or with `columns` of those that are blurred along rows already.
fn share_at(p: vec2<i32>, columns: bool) -> f32 {
    if columns {
        return blurred[index_of(p)];
    }
    return raw[index_of(p)].x;
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
