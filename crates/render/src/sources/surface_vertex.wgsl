// What vertex sources return and the shading takes. See mod.rs beside it.

struct SurfaceVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    axis: vec3<f32>,
    radius: f32,
    color_key: u32,
    instance: u32,
    grid: vec2<f32>,
}
