// Vertices of even.wgsl as WebGL keeps them, by transform feedback. Translated to GLSL ES 3.00; host: webgl.js.

#import even.wgsl

struct Captured {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec4<f32>,
    @location(1) around: vec4<f32>,
}

@vertex
fn capture(@builtin(vertex_index) index: u32) -> Captured {
    let v = even_vertex(index);
    return Captured(vec4(0.0, 0.0, 0.0, 1.0), v.place, v.around);
}
