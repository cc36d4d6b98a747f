// What the program draws itself: boxes, with a floor of tiles.

struct Scene {
    clip_from_world: mat4x4<f32>,
    // Middle and half the height of the cells.
    center: vec3<f32>,
    reach: f32,
}

@group(0) @binding(0) var<uniform> scene: Scene;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec3<f32>,
    @location(1) floor: vec3<f32>,
}

@vertex
fn corner(@builtin(vertex_index) index: u32, @builtin(instance_index) which: u32) -> Corner {
    // A floor; a column before the cells; a wall behind them; a bar through one of them. Measured by their reach.
    let middle = array(vec3(0.1, -1.05, -0.1), vec3(-0.1, -0.25, 0.5), vec3(0.15, 0.0, -1.0), vec3(0.1, 0.45, 0.0))[which];
    let half = array(vec3(1.3, 0.03, 1.2), vec3(0.06, 0.77, 0.06), vec3(0.65, 1.02, 0.05), vec3(0.9, 0.03, 0.03))[which];
    let color = array(vec3(0.4), vec3(0.8, 0.4, 0.05), vec3(0.3, 0.42, 0.6), vec3(0.1, 0.4, 0.2))[which];
    // Six faces of two triangles: an axis, a side of it, and a corner.
    let face = index / 6u;
    let axis = face % 3u;
    let side = select(-1.0, 1.0, face >= 3u);
    let at = array(vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0))[index % 6u];
    var place = vec3(side, at);
    if axis == 1u { place = vec3(at.x, side, at.y); }
    if axis == 2u { place = vec3(at, side); }
    var normal = vec3(0.0);
    normal[axis] = side;
    let light = 0.55 + 0.45 * max(dot(normal, normalize(vec3(0.4, 0.8, 0.6))), 0.0);
    let in_box = middle + half * place;
    let position = scene.center + scene.reach * in_box;
    let is_tiled = select(0.0, 1.0, which == 0u);
    return Corner(scene.clip_from_world * vec4(position, 1.0), color * light, vec3(in_box.xz, is_tiled));
}

@fragment
fn paint(in: Corner) -> @location(0) vec4<f32> {
    let tile = floor(in.floor.xy * 5.0);
    let dark = select(1.0, 0.7, (i32(tile.x) + i32(tile.y)) % 2 != 0);
    return vec4(in.color * select(1.0, dark, in.floor.z > 0.5), 1.0);
}
