// How surfaces are lit, and how dark thin lines are. Called by shade.wgsl, and by the shaders of pages (crates/web).
// The file that imports it has the uniform `shade`, with the direction `key` to the key light.

// Coverage of a line by the share of a pixel that it fills. With coverage equal to that share, the
// axons of a whole cell nearly vanish: 0.3 of a pixel in linear light can hardly be seen on white.
// This rises faster: it is 0.5 for a twentieth of a pixel and 0.9 for 0.3. Chosen by eye on the
// samples and on real cells of 1 to 3 mm.
fn ink_of(share: f32) -> f32 {
    let rest = 1.0 - sqrt(share);
    return 1.0 - rest * rest * rest;
}

// How a surface is lit, whatever its color.
struct Lights {
    // Share of its color that it returns.
    diffuse: f32,
    // White that is added.
    sheen: f32,
    // Light from behind along the outline: returned in its color, and a quarter of it white.
    rim: f32,
}

// A key light from the upper left, a weak fill light from the lower right, and a sky brighter than
// the ground. The weights were chosen by eye on real cells, so that a surface that faces the viewer
// has the color of the legend.
fn lights(n: vec3<f32>, to_eye: vec3<f32>) -> Lights {
    let key = max((dot(n, shade.key) + 0.3) / 1.3, 0.0);
    let fill = max(dot(n, normalize(vec3(0.7, -0.35, 0.6))), 0.0);
    let sky = 0.5 + 0.5 * n.y;
    let diffuse = 0.85 * key * key + 0.18 * fill + mix(0.22, 0.52, sky);
    // A broad highlight, so that the shape of black things shows.
    let half = normalize(shade.key + to_eye);
    let sheen = 0.045 * pow(max(dot(n, half), 0.0), 10.0) + 0.05 * pow(max(dot(n, half), 0.0), 60.0);
    // The rim makes a thing stand out from what is behind it.
    let grazing = 1.0 - max(dot(n, to_eye), 0.0);
    let rim = 0.16 * grazing * grazing * grazing * mix(0.4, 1.0, sky);
    return Lights(diffuse, sheen, rim);
}

// A color in these lights; `white`: how much of it there is, 0 to 1.
fn light(albedo: vec3<f32>, white: f32, l: Lights) -> vec3<f32> {
    return albedo * l.diffuse + l.sheen * white + l.rim * (0.25 * white + albedo);
}
