// Ambient occlusion from depth and normals, and its blur. Imported by occlusion.wgsl, and by the shaders of pages
// (crates/web). The file that imports it has the uniform `finish`, and `depth_at`, `view_at` and `share_at`. Constants:
// finish.rs.
//
// Theory: McGuire, Mara & Luebke, Scalable ambient obscurance, HPG 2012: samples on a spiral, each
// weighted by how far it rises above the tangent plane, less with greater distance. The blur is
// theirs too, along rows and then along columns; it stops where the depth jumps.

// Share of the light that reaches a sub-pixel at this depth (µm) and with this normal in the view.
fn light_reaching(p: vec2<i32>, depth: f32, n: vec3<f32>) -> f32 {
    let center = view_at(p, depth);
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
    return max(1.0 - STRENGTH * sum / f32(TAPS), 0.0);
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
            sum += weight * share_at(q, columns);
        }
    }
    return sum / weights;
}
