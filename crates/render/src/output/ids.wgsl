// Draws picking ids: first the batch and the first component of `surface_id`, plus 1; second the
// other component; zeros where nothing is drawn. A source's file must define `surface_id`. Called
// by ids.rs.

#import shade.wgsl

struct PickHit {
    @invariant @builtin(position) position: vec4<f32>,
    // Position relative to the eye, coverage.
    @location(0) relative: vec4<f32>,
    @location(1) @interpolate(flat) id: vec2<u32>,
}

@vertex
fn vertex_id(
    @builtin(vertex_index) vertex_index: u32,
    @builtin(instance_index) instance_index: u32,
) -> PickHit {
    let v = shaded_vertex(vertex_index, instance_index);
    let id = surface_id(vertex_index, instance_index);
    let first = 1u + (shade.batch << BATCH_SHIFT) + id.x;
    return PickHit(v.position, vec4(v.relative, v.coverage), vec2<u32>(first, id.y));
}

@fragment
fn fragment_id(in: PickHit) -> @location(0) vec2<u32> {
    if left_by_clip(in.relative.xyz, in.relative.w) <= 0.0 {
        discard;
    }
#ifdef SHEETS
    // What lies behind something translucent is meant.
    if is_translucent() { discard; }
#endif
    return in.id;
}
