// The last pass of a progressive picture: adds this step's samples to those of the steps before,
// and computes the bytes of their mean. Called by progressive/draw.rs.

#import finish.wgsl
#import occlusion.wgsl

// Linear, premultiplied.
@group(0) @binding(8) var<storage, read_write> sums: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn accumulate(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= finish.kept) {
        return;
    }
    let p = vec2<i32>(id.xy);
    let at = id.y * finish.kept.x + id.x;
    var sum = textureLoad(colors, p, 0);
    if finish.radius > 0.0 && sum.a > 0.0 {
        sum = vec4(sum.rgb * occlusion_at(p), sum.a);
    }
    // `spare` counts the steps before.
    if finish.spare > 0u {
        sum += sums[at];
    }
    // A picture of a single step needs no sums.
    if finish.clear == 0u {
        sums[at] = sum;
    }
    if sum.a == 0.0 {
        pixels[at] = finish.empty;
        return;
    }
    sum /= f32(finish.spare + 1u);
    pixels[at] = screen_bytes(vec4(sum.rgb + finish.background.rgb * (1.0 - sum.a), 1.0));
}
