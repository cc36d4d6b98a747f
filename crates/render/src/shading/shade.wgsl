// From a source's vertices to lit samples: projection, widening of thin tubes, color, light,
// wireframe. Called by tiles/pass.rs, with a vertex source. Rust twin of the uniform: shade.rs. SAMPLES
// is the number of samples of a sub-pixel.

#import surface_vertex.wgsl
#import lighting.wgsl

struct Shade {
    clip_from_relative: mat4x4<f32>,
    right: vec3<f32>,
    near: f32,
    up: vec3<f32>,
    // What each µm of depth adds to the size (µm) of a sub-pixel.
    slope: f32,
    backward: vec3<f32>,
    // Half the width (sub-pixels) of the thinnest line drawn.
    half_width: f32,
    // Unit direction to the key light in the view: right, up, backward.
    key: vec3<f32>,
    // Half the width (sub-pixels) of the wireframe's lines; 0: no wireframe.
    wire: f32,
    size: vec2<f32>,
    tile_origin: vec2<f32>,
    // Of the viewport, which reaches beyond the tile (sub-pixels of the whole picture).
    viewport_origin: vec2<f32>,
    viewport_size: vec2<f32>,
    // 1: lit, 0: the bare color.
    lit: f32,
    // Number of scale entries at the start of the table; categories follow.
    scale_entries: u32,
    // Number of all colors, and of instances whose values follow them in the table.
    colors: u32,
    valued: u32,
    // Added to the source's positions to make them relative to the eye: 0 unless the source has
    // selected for another eye.
    shift: vec3<f32>,
    // Coverage of ghosted instances.
    ghosted: f32,
    // Everything behind this plane, relative to the eye, is cut away; all 0: nothing.
    clip: vec4<f32>,
    // Linear color of highlighted instances, and its share.
    highlighted: vec4<f32>,
    // Offset (sub-pixels) of the whole picture.
    jitter: vec2<f32>,
    // Index of the batch that is drawn: for picking ids.
    batch: u32,
    // Half the least width (sub-pixels) that neurites are widened to; 0: none.
    least_half_width: f32,
    // Linear color of edges, and luminance of the background, against which they make colors of the
    // scale stand out.
    edge: vec4<f32>,
    // Size (µm) of a sub-pixel at every depth: 0 with perspective.
    flat: f32,
    // Number of steps of a progressive picture; else 1.
    steps: f32,
    // For a step of a progressive picture: what the dither pattern is offset by (sub-pixels).
    turn: vec2<f32>,
}

@group(1) @binding(0) var<uniform> shade: Shade;
// Linear colors, then values of instances: see ColorTable::entries.
@group(1) @binding(1) var<storage, read> table: array<vec4<f32>>;
// State of each instance; instances beyond the end have 0.
@group(1) @binding(2) var<storage, read> states: array<u32>;

// What a fragment needs to know of a vertex.
struct ShadedVertex {
    position: vec4<f32>,
    normal: vec3<f32>,
    relative: vec3<f32>,
    color: vec3<f32>,
    // Share of the edge's color at edges, and before it the color times that share: so what is
    // interpolated is what corners would look like, and linear in their colors.
    edge: vec4<f32>,
    grid: vec2<f32>,
    coverage: f32,
    // From 0 for tubes at least two pixels wide to 1 for width 0.
    thin: f32,
    // 1: the instance has an outline.
    outline: f32,
}

// The same, packed: software prepares four numbers of a triangle in the time of one, and the triangles
// here are small.
struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    // Normal, coverage.
    @location(0) normal: vec4<f32>,
    // Position relative to the eye, thinness.
    @location(1) relative: vec4<f32>,
    // Grid, outline.
    @location(2) grid: vec3<f32>,
    // Where a pixel is covered in part, colors are those of the part: not extrapolated. The last component is 1, and
    // what is interpolated is divided by it. Software divides by the depth at the pixel's center instead of the part's:
    // where a triangle is nearly seen from its edge, colors came out up to 3 times as bright, and so does the 1.
    @location(3) @interpolate(perspective, centroid) color: vec4<f32>,
#ifdef EDGED
    @location(4) @interpolate(perspective, centroid) edge: vec4<f32>,
#endif
}

fn category_entry(category: u32) -> u32 {
    return min(shade.scale_entries + category, shade.colors - 1u);
}

// An instance's value for a color key, or -1: see InstanceValues.
fn value_of_instance(color_key: u32, instance: u32) -> f32 {
    if instance >= shade.valued {
        return -1.0;
    }
    let first = u32(table[shade.colors + instance / 4u][instance % 4u]);
    return table[min(first + color_key / 4u, arrayLength(&table) - 1u)][color_key % 4u];
}

// A color key is a category, whose color comes after those of the scale; or a fraction of the
// scale; or the index of one of the instance's values. The last component is 1 for colors of the
// scale.
fn color_of(color_key: u32, instance: u32) -> vec4<f32> {
    var share = f32(color_key) / f32(CATEGORY_BIT);
    var category = (color_key & CATEGORY_BIT) != 0u;
    var named = color_key & ~CATEGORY_BIT;
    if VALUED && !category {
        share = value_of_instance(color_key, instance);
        category = share < 0.0;
        named = 0u;
    }
    let last = max(shade.scale_entries, 1u) - 1u;
    let place = select(share * f32(last), 0.0, category);
    let low = select(u32(place), category_entry(named), category);
    let high = select(min(u32(place) + 1u, last), low, category);
    let color = mix(table[low].rgb, table[high].rgb, fract(place));
    return vec4(color, select(1.0, 0.0, category));
}

fn luminance(color: vec3<f32>) -> f32 {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// How close a color is to the background's: 1 up to a contrast of 1.25, which the light end of
// viridis has against white, falling to 0 at 1.8. Contrast as WCAG 2.2 defines it.
fn lack_of_contrast(color: vec3<f32>) -> f32 {
    let own = luminance(color) + 0.05;
    let other = shade.edge.w + 0.05;
    return 1.0 - smoothstep(1.25, 1.8, max(own, other) / min(own, other));
}

// Rasterizers round positions to 1/256 of a pixel. Here they are rounded in the whole picture's
// coordinates, so that a triangle covers the same samples whatever tile it is drawn in. The quarter
// of a step keeps positions away from ties.
fn snapped(clip: vec4<f32>) -> vec4<f32> {
    let pixel = (clip.xy / clip.w * vec2(0.5, -0.5) + 0.5) * shade.size + shade.jitter;
    let local = floor(pixel * 256.0) / 256.0 - shade.viewport_origin + 0.25 / 256.0;
    let ndc = (local / shade.viewport_size * 2.0 - 1.0) * vec2(1.0, -1.0);
    return vec4(ndc * clip.w, clip.z, clip.w);
}

// The same without rounding, for vertices behind the near plane, where the division by w is not
// possible.
fn unsnapped(clip: vec4<f32>) -> vec4<f32> {
    let scale = shade.size / shade.viewport_size;
    let shift = (shade.size + 2.0 * (shade.jitter - shade.viewport_origin)) / shade.viewport_size - 1.0;
    return vec4(clip.xy * scale + vec2(shift.x, -shift.y) * clip.w, clip.z, clip.w);
}

fn state_of(instance: u32) -> u32 {
    let last = arrayLength(&states) - 1u;
    return select(0u, states[min(instance, last)], instance <= last);
}

// Coverage of a vertex if somata or neurites are left out. Vertices of somata have radius 0, but
// the soma's patches around a neurite have corners on its first ring, with the neurite's radius.
// Coverage is interpolated between them: values far outside 0 to 1 move the border to the ring
// itself.
fn shown_part(state: u32, radius: f32, coverage: f32) -> f32 {
    if (state & WITHOUT_NEURITES) != 0u {
        return select(0.0, 1000.0, radius == 0.0);
    }
    if (state & WITHOUT_SOMA) != 0u && radius == 0.0 {
        return -1000.0;
    }
    return coverage;
}

#ifdef HIDES
// Whether a category is left out: the last component of its color is 0.
fn is_hidden(color_key: u32) -> bool {
    return (color_key & CATEGORY_BIT) != 0u && table[category_entry(color_key & ~CATEGORY_BIT)].a == 0.0;
}
#endif

fn shaded_vertex(vertex_index: u32, instance_index: u32) -> ShadedVertex {
    var v = surface_vertex(vertex_index, instance_index);
    v.position += shade.shift;
    v.axis += shade.shift;
    let state = state_of(v.instance);
    let color = color_of(v.color_key, v.instance);
    var relative = v.position;
    var coverage = 1.0;
    var thin = 0.0;
    if v.radius > 0.0 {
        // A tube thinner than a pixel is widened to a pixel and made fainter.
        let depth = max(-dot(v.axis, shade.backward), shade.near);
        // The width does not depend on values, so that another frame of a recording changes colors
        // only.
        let narrowest = shade.half_width * shade.slope * depth + shade.half_width * shade.flat;
        thin = max(1.0 - 0.5 * v.radius / narrowest, 0.0);
        let least = shade.least_half_width * shade.slope * depth + shade.least_half_width * shade.flat;
        let widened = max(narrowest, least);
        if v.radius < widened {
            let offset = v.position - v.axis;
            let away = select(v.normal, normalize(offset), dot(offset, offset) > 0.0);
            relative += away * (widened - v.radius);
            coverage = select(ink_of(v.radius / narrowest), 1.0, least > 0.0);
        }
    }
    let clip = shade.clip_from_relative * vec4(relative, 1.0);
    var out: ShadedVertex;
    if clip.w > shade.near {
        out.position = snapped(clip);
    } else {
        out.position = unsnapped(clip);
    }
    if (state & GHOSTED) != 0u {
        coverage *= shade.ghosted;
    }
    coverage = shown_part(state, v.radius, coverage);
#ifdef HIDES
    // As in `shown_part`, far below 0.
    coverage = select(coverage, -1000.0, is_hidden(v.color_key));
#endif
    out.normal = v.normal;
    out.color = color.rgb;
    if (state & HIGHLIGHTED) != 0u {
        out.color = mix(out.color, shade.highlighted.rgb, shade.highlighted.a);
    }
#ifdef EDGED
    let edge = color.a * lack_of_contrast(color.rgb);
    out.edge = vec4(edge * out.color, edge);
#endif
    out.relative = relative;
    out.grid = v.grid;
    out.coverage = coverage;
    out.thin = thin;
    out.outline = select(0.0, 1.0, (state & OUTLINED) != 0u);
    return out;
}

@vertex
fn vertex(
    @builtin(vertex_index) vertex_index: u32,
    @builtin(instance_index) instance_index: u32,
) -> Varying {
    let v = shaded_vertex(vertex_index, instance_index);
    var out: Varying;
    out.position = v.position;
    out.normal = vec4(v.normal, v.coverage);
    out.relative = vec4(v.relative, v.thin);
    out.grid = vec3(v.grid, v.outline);
    out.color = vec4(v.color, 1.0);
#ifdef EDGED
    out.edge = v.edge;
#endif
    return out;
}

struct Sample {
    // Linear, premultiplied by coverage through the mask.
    @location(0) color: vec4<f32>,
    // Normal in the view, mapped from -1..1 to 0..1, and a byte with the bits of the outlines'
    // mask.
    @location(1) normal: vec4<f32>,
    // Depth (µm), not 0, as the bytes of an f32: OpenGL cannot load from depth textures, and cannot always
    // draw to floating-point ones. All bits are set where something translucent is.
    @location(2) depth: vec4<f32>,
#ifdef MULTISAMPLED
    @builtin(sample_mask) mask: u32,
#endif
}

// Coverage by lines, which run where x, y or x + y is a whole number; with half their width (sub-pixels).
fn lines(grid: vec2<f32>, half_width: f32) -> f32 {
    let g = vec3(grid, grid.x + grid.y);
    let width = max(fwidth(g), vec3(1e-6));
    let distance = abs(fract(g - 0.5) - 0.5) / width;
    let nearest = min(distance.x, min(distance.y, distance.z));
    // Where lines are so close that they would touch, they fade to a tint.
    let crowded = max(width.x, max(width.y, width.z)) * half_width * 4.0;
    return (1.0 - smoothstep(half_width - 0.5, half_width + 0.5, nearest)) * clamp(1.6 - crowded, 0.25, 1.0);
}

fn bayer(p: vec2<u32>) -> f32 {
    let q = p & vec2(1u);
    return (f32((q.x ^ q.y) * 2u + q.y) + 0.5) / 4.0;
}

// Mask of samples for a coverage, dithered over neighboring sub-pixels.
fn mask_of(coverage: f32, position: vec4<f32>) -> u32 {
    let p = vec2<u32>(position.xy + shade.tile_origin + 4096.0);
    let count = u32(clamp(coverage, 0.0, 1.0) * f32(SAMPLES) + bayer(p));
    let turn = (p.x + 2u * p.y) % SAMPLES;
    let bits = ((1u << count) - 1u) << turn;
    return (bits | (bits >> SAMPLES)) & ((1u << SAMPLES) - 1u);
}

// Coverage after the cut: 0 behind the plane.
fn left_by_clip(relative: vec3<f32>, coverage: f32) -> f32 {
    return select(coverage, 0.0, dot(shade.clip.xyz, relative) + shade.clip.w < 0.0);
}

// The surface at a fragment, in the view: right, up, backward.
struct Facet {
    normal: vec3<f32>,
    to_eye: vec3<f32>,
    // How strong an edge is: rises towards the outline.
    edge: f32,
    // Coverage after the cut.
    coverage: f32,
}

fn facet(world_normal: vec3<f32>, relative: vec3<f32>, coverage: f32, thin: f32, front: bool) -> Facet {
#ifdef SHEETS
    // A surface that may be open is lit alike from both sides.
    let world = select(-1.0, 1.0, front) * normalize(world_normal);
#else
    // Back faces show only where the surface is cut: with the plane's normal it looks as if it were
    // filled.
    let world = select(-shade.clip.xyz, normalize(world_normal), front);
#endif
    let axes = mat3x3(shade.right, shade.up, shade.backward);
    let to_eye = select(-normalize(relative) * axes, vec3(0.0, 0.0, 1.0), shade.flat > 0.0);
    // A thin line is lit like a surface that faces the viewer, so that it has the color of the
    // legend. With the mean over all its sides it was a third darker, and thin neurites looked
    // gray.
    let n = normalize(mix(world * axes, to_eye, thin));
    let facing = dot(world * axes, to_eye);
    let across = sqrt(max(1.0 - facing * facing, 0.0));
    return Facet(n, to_eye, smoothstep(0.5, 0.85, across), left_by_clip(relative, coverage));
}

@fragment
fn fragment(in: Varying, @builtin(front_facing) front: bool) -> Sample {
    let thin = in.relative.w;
    let f = facet(in.normal.xyz, in.relative.xyz, in.normal.w, thin, front);
    var color = in.color.rgb / in.color.w;
#ifdef EDGED
    var edged = in.edge / in.color.w;
#endif
#ifdef SHEETS
    let mask = sheet_mask(f.coverage * sheet_coverage(in.grid.xy), in.position, in.relative.xyz, front);
#else
    let mask = mask_of(f.coverage, in.position);
#endif
    if shade.wire > 0.0 {
        let line = select(vec3(0.22), color * 0.06, luminance(color) > 0.06);
        color = mix(color, line, lines(in.grid.xy, shade.wire) * (1.0 - thin));
#ifdef EDGED
        edged = vec4(color * edged.a, edged.a);
#endif
    }
    if shade.lit > 0.0 {
        let l = lights(f.normal, f.to_eye);
        color = light(color, 1.0, l);
#ifdef EDGED
        edged = vec4(light(edged.rgb, edged.a, l), edged.a);
#endif
    }
#ifdef EDGED
    color += 0.7 * f.edge * (shade.edge.rgb * edged.a - edged.rgb);
#endif
    var out: Sample;
    out.color = vec4(color, 1.0);
    out.normal = vec4(f.normal * 0.5 + 0.5, in.grid.z / 255.0);
    // Without perspective it may be negative, and 0 where the eye is.
    let depth = -dot(in.relative.xyz, shade.backward);
    out.depth = unpack4x8unorm(bitcast<u32>(select(depth, 1e-20, depth == 0.0)));
#ifdef SHEETS
    if is_translucent() && !ALL_DEPTHS { out.depth = NO_DEPTH; }
#endif
#ifdef MULTISAMPLED
    out.mask = mask;
#else
    // A mask of one sample: it is drawn or not.
    if mask == 0u { discard; }
#endif
    return out;
}
