// The last pass of a tile: from samples to the bytes of a picture. Called by tiles/mod.rs, for blocks of pixels
// in which anything shows; the others are 0.

#import finish.wgsl
#import blocks.wgsl

@compute @workgroup_size(8, 8)
fn gather(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let id = within_block(GATHERED, workgroup, local);
    if any(id >= finish.kept) {
        return;
    }
    var sum = vec4(0.0);
    for (var y = 0u; y < finish.scale; y++) {
        for (var x = 0u; x < finish.scale; x++) {
            let p = vec2<i32>(id * finish.scale + vec2(x, y) + finish.inset);
            var color = textureLoad(colors, p, 0);
            if finish.radius > 0.0 && color.a > 0.0 {
                color = vec4(color.rgb * occlusion_at(p), color.a);
            }
            sum += color;
        }
    }
    let at = id.y * finish.kept.x + id.x;
    if sum.a == 0.0 {
        pixels[at] = finish.empty;
        return;
    }
    sum /= f32(finish.scale * finish.scale);
    var out = vec4(sum.rgb + finish.background.rgb * (1.0 - sum.a), 1.0);
    if finish.clear == 1u {
        out = vec4(sum.rgb / sum.a, sum.a);
    }
    pixels[at] = screen_bytes(out);
}
