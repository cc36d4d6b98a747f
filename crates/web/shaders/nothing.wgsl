// Nothing is drawn while vertices are captured, but a program has both stages. Host: webgl.js.

@fragment
fn nothing() -> @location(0) vec4<f32> {
    return vec4(0.0);
}
