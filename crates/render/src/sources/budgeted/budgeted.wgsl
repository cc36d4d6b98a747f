// What the shaders of exploration mode share: structs, placements of instances, and the steps of
// detail that chunks request.
//
// Imported by select.wgsl and visible_chunks.wgsl. Rust twins: layout.rs for the structs and
// constants, lod_requests.rs for `offers`.

struct Eye {
    planes: array<vec4<f32>, 5>,
    cell: vec3<i32>,
    slope: f32,
    offset: vec3<f32>,
    near: f32,
    forward: vec3<f32>,
    error: f32,
    budget: u32,
    instances: u32,
    flat: f32,
    pad: u32,
}

struct Chunk {
    center: vec3<f32>,
    reach: f32,
    low: vec3<f32>,
    step: f32,
    counts: vec2<u32>,
    errors: vec2<u32>,
    first: u32,
    color_keys: u32,
    flags: u32,
    radius: f32,
    length: f32,
    carried: f32,
    start: u32,
    end: u32,
}

struct GpuInstance {
    rotation: vec4<f32>,
    offset: vec3<f32>,
    scale: f32,
    cell: vec3<i32>,
    shape: u32,
    flags: u32,
    state: u32,
    pad: vec2<u32>,
}

struct VisibleChunk {
    instance: u32,
    chunk: u32,
    lod: u32,
    first: u32,
}

@group(0) @binding(0) var<uniform> eye: Eye;
@group(0) @binding(1) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(3) var<storage, read> gpu_instances: array<GpuInstance>;
// Points of chunks, two u32s each: x, y | z, radius; then their lists of kept points, a byte each.
// Of somata: vertices, x, y | z, normal; then quads.
@group(0) @binding(5) var<storage, read> packed: array<u32>;

fn turn(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

// From a template's coordinates to those relative to the eye. Cells cancel as whole numbers, so
// that far from the origin of the world no digit is lost.
fn relative(place: GpuInstance, p: vec3<f32>) -> vec3<f32> {
    let cells = vec3<f32>(place.cell - eye.cell) * CELL;
    return cells + (place.offset - eye.offset) + place.scale * turn(place.rotation, p);
}

// Size (micrometers) of a pixel at a depth.
fn pixel_at(depth: f32) -> f32 {
    return eye.slope * depth + eye.flat;
}

// Whether a sphere, relative to the eye, reaches into the frustum. It may reach a pixel further,
// since thin tubes are drawn a pixel wide.
fn in_sight(p: vec3<f32>, reach: f32) -> bool {
    let depth = max(dot(eye.forward, p) + reach, eye.near);
    let most = reach + pixel_at(depth);
    for (var k = 0u; k < 5u; k += 1u) {
        // Written so that a position that is not a number is outside.
        if (!(dot(eye.planes[k].xyz, p) + eye.planes[k].w >= -most)) {
            return false;
        }
    }
    return true;
}

// Whether all of a sphere is between the planes.
fn enclosed(p: vec3<f32>, reach: f32) -> bool {
    for (var k = 0u; k < 5u; k += 1u) {
        if (!(dot(eye.planes[k].xyz, p) + eye.planes[k].w >= reach)) {
            return false;
        }
    }
    return true;
}

fn byte_of(bytes: vec2<u32>, k: u32) -> u32 {
    return (select(bytes.x, bytes.y, k >= 4u) >> (8u * (k & 3u))) & 0xffu;
}

// Number of segments of a chunk's polyline; 0 if the chunk does not have it.
fn segments(chunk: Chunk, level: u32) -> u32 {
    return byte_of(chunk.counts, level);
}

// Whether a chunk is without its finest polylines (streaming/reduced.rs): its polyline 0 is then not its path.
fn is_reduced(chunk: Chunk) -> bool {
    return byte_of(chunk.errors, LEVELS) != NO_LOD;
}

// Greatest distance (µm) of a polyline from the curved path; polyline 0 always exists.
fn lod_error(chunk: Chunk, level: u32) -> f32 {
    let byte = byte_of(chunk.errors, level);
    if (byte == 0u) {
        return 0.0;
    }
    return exp2(f32(byte) / ERROR_STEPS - ERROR_OFFSET);
}

// The coarsest polyline within an error.
fn lod_within(chunk: Chunk, error: f32) -> u32 {
    for (var level = LEVELS - 1u; level > 0u; level -= 1u) {
        if (segments(chunk, level) > 0u && lod_error(chunk, level) <= error) {
            return level;
        }
    }
    return 0u;
}

struct Stored {
    position: vec3<f32>,
    radius: f32,
    point: u32,
}

fn stored_position(chunk: Chunk, low: u32, high: u32) -> vec3<f32> {
    let steps = vec3<f32>(f32(low & 0xffffu), f32(low >> 16u), f32(high & 0xffffu));
    return chunk.low + chunk.step * steps;
}

// A point of a chunk's polyline.
fn stored(chunk: Chunk, level: u32, index: u32) -> Stored {
    var point = index;
    if (level > 0u) {
        var at = index;
        for (var k = 1u; k < level; k += 1u) {
            let there = segments(chunk, k);
            at += select(0u, there + 1u, there > 0u);
        }
        let lists = chunk.first + 2u * (segments(chunk, 0u) + 1u);
        point = (packed[lists + at / 4u] >> (8u * (at & 3u))) & 0xffu;
    }
    let low = packed[chunk.first + 2u * point];
    let high = packed[chunk.first + 2u * point + 1u];
    let radius = chunk.radius * (f32(high >> 16u) / 65535.0);
    return Stored(stored_position(chunk, low, high), radius, point);
}

// The visible part of a chunk: its least depth and its mean depth (µm), and its share of the chunk.
struct Seen {
    nearest: f32,
    middle: f32,
    share: f32,
}

// Most segments of the polyline that seen_part looks at.
const LOOKED_AT: u32 = 8u;

// The visible part of a chunk that is near, or partly outside the picture: segment by segment, each
// cut by the planes. Going by its bounding sphere alone, a chunk that merely passes beside the eye
// would seem to be at depth 0, and would get the finest detail.
fn seen_part(chunk: Chunk, place: GpuInstance) -> Seen {
    var level = 0u;
    for (var k = 1u; k < LEVELS; k += 1u) {
        if (segments(chunk, level) > LOOKED_AT && segments(chunk, k) > 0u) {
            level = k;
        }
    }
    let margin = (lod_error(chunk, level) + chunk.radius) * place.scale;
    var seen = Seen(1e30, 0.0, 0.0);
    var all = 0.0;
    var a = relative(place, stored(chunk, level, 0u).position);
    for (var i = 1u; i <= segments(chunk, level); i += 1u) {
        let b = relative(place, stored(chunk, level, i).position);
        let depths = vec2<f32>(dot(eye.forward, a), dot(eye.forward, b));
        let reach = margin + pixel_at(max(max(depths.x, depths.y), eye.near));
        var from_a = 0.0;
        var to_b = 1.0;
        for (var k = 0u; k < 5u; k += 1u) {
            let plane = eye.planes[k];
            let off_a = dot(plane.xyz, a) + plane.w + reach;
            let off_b = dot(plane.xyz, b) + plane.w + reach;
            let cut = off_a / (off_a - off_b);
            if (off_a < 0.0 && off_b < 0.0) {
                to_b = -1.0;
            } else if (off_a < 0.0) {
                from_a = max(from_a, cut);
            } else if (off_b < 0.0) {
                to_b = min(to_b, cut);
            }
        }
        let span = length(b - a);
        if (from_a <= to_b) {
            let there = mix(depths.xx, depths.yy, vec2<f32>(from_a, to_b));
            let part = (to_b - from_a) * span + 1e-6;
            seen.nearest = min(seen.nearest, min(there.x, there.y) - margin);
            seen.middle += part * 0.5 * (there.x + there.y);
            seen.share += part;
        }
        all += span;
        a = b;
    }
    seen.middle /= max(seen.share, 1e-30);
    seen.share /= max(all, 1e-6);
    return seen;
}

// How a visible chunk is drawn, in one u32: see the constants in layout.rs.

fn packed_lod(what: u32, level: u32, halvings: u32, strips: u32, width: u32) -> u32 {
    return what
        | (level << LOD_LEVEL_SHIFT)
        | (halvings << LOD_HALVINGS_SHIFT)
        | (strips << LOD_STRIPS_SHIFT)
        | (width << LOD_WIDTH_SHIFT);
}

fn lod_what(lod: u32) -> u32 {
    return lod & ((1u << LOD_LEVEL_SHIFT) - 1u);
}

fn lod_level(lod: u32) -> u32 {
    return (lod >> LOD_LEVEL_SHIFT) & ((1u << (LOD_HALVINGS_SHIFT - LOD_LEVEL_SHIFT)) - 1u);
}

fn lod_halvings(lod: u32) -> u32 {
    return (lod >> LOD_HALVINGS_SHIFT) & ((1u << (LOD_STRIPS_SHIFT - LOD_HALVINGS_SHIFT)) - 1u);
}

fn lod_strips(lod: u32) -> u32 {
    return (lod >> LOD_STRIPS_SHIFT) & ((1u << (LOD_WIDTH_SHIFT - LOD_STRIPS_SHIFT)) - 1u);
}

// Share of the chunk's width that is drawn.
fn lod_width(lod: u32) -> f32 {
    return f32(lod >> LOD_WIDTH_SHIFT) / f32(FULL_WIDTH);
}

// Number of quads of a sphere seen from the front. A disc is a fan of quads that cover two sectors
// each; a dome has six such quads and a ring of twelve around them.
const DISC_QUADS: u32 = 4u;
const DOME_QUADS: u32 = 18u;

// Half the width (pixels) of the thinnest line that the shading draws.
const HALF_PIXEL: f32 = 0.5;

// The same function as in shade.wgsl.
fn ink_share(share: f32) -> f32 {
    let rest = 1.0 - sqrt(min(share, 1.0));
    return 1.0 - rest * rest * rest;
}

// Up to four steps in which a chunk can be drawn better. For each: the bin of its worth, the quads
// that it takes in addition to the steps before, and the level of detail that it leads to. Worth
// falls from step to step.
struct Offers {
    bins: vec4<u32>,
    quads: vec4<u32>,
    lods: vec4<u32>,
    // Share of the width that is drawn, before the budget's; of a soma, the root of its area (pixels).
    width: f32,
}

// Bin of the histogram for a worth (square pixels per quad). 0: worth nothing.
fn bin_of(worth: f32) -> u32 {
    if (!(worth > 0.0)) {
        return 0u;
    }
    let bin = (log2(worth) - LOWEST_OCTAVE) * BINS_OF_OCTAVE;
    return u32(clamp(bin, 1.0, f32(BINS - 1u)));
}

// The least worth of a bin.
fn worth_of(bin: u32) -> f32 {
    return exp2(f32(bin) / BINS_OF_OCTAVE + LOWEST_OCTAVE);
}

// A random factor for each instance, the same in every frame, from 1 / MAX_CHANCE to MAX_CHANCE:
// it keeps equal chunks of different instances from appearing and vanishing all at once.
const MAX_CHANCE: f32 = 1.1892071;

fn chance_factor(instance: u32) -> f32 {
    return exp2(0.5 * chance(instance) - 0.25);
}

// A random number from 0 to 1 for each instance, the same in every frame.
fn chance(instance: u32) -> f32 {
    var h = instance * 747796405u + 277803737u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    h = (h >> 22u) ^ h;
    return f32(h >> 8u) / 16777216.0;
}

fn no_offers() -> Offers {
    return Offers(vec4<u32>(0u), vec4<u32>(0u), vec4<u32>(0u), 1.0);
}

// How much of twigs of a length (pixels) shows: nothing of the shortest.
fn twig_share(length: f32) -> f32 {
    return clamp((length - TWIG_FADES_FROM) / (TWIG_FADES_TO - TWIG_FADES_FROM), 0.0, 1.0);
}

// How much wider a chunk is drawn where its twigs are left out. `pixel`: its size in the template's coordinates.
fn wider_without_twigs(chunk: Chunk, pixel: f32) -> f32 {
    let long = (chunk.flags >> CHUNK_TWIGS_SHIFT) & ((1u << TWIGS_BITS) - 1u);
    if (long == 0u) {
        return 1.0;
    }
    let wider = (chunk.flags >> CHUNK_WIDER_SHIFT) & ((1u << WIDER_BITS) - 1u);
    let length = exp2(f32(long) / TWIG_STEPS - TWIG_OFFSET);
    return mix(exp2(f32(wider) / TWIG_STEPS), 1.0, twig_share(length / pixel));
}

// Number of strips around the visible half of a tube of this radius (pixels): enough to be within
// half a pixel of the circle.
fn strips_of(radius: f32) -> u32 {
    if (radius < 3.0) {
        return 1u;
    }
    if (radius < 7.0) {
        return 5u;
    }
    return select(20u, 10u, radius < 27.0);
}

fn offers(instance: u32, place: GpuInstance, chunk_index: u32) -> Offers {
    let chunk = chunks[chunk_index];
    let center = relative(place, chunk.center);
    let reach = chunk.reach * place.scale;
    if (!in_sight(center, reach)) {
        return no_offers();
    }
    let depth = dot(eye.forward, center);
    if ((chunk.flags & CHUNK_SOMA) != 0u) {
        let near = max(depth - reach, eye.near);
        let radius = chunk.radius * place.scale / pixel_at(max(depth, near));
        return soma_offers(chunk, radius, instance);
    }
    var seen = Seen(depth - reach, depth, 1.0);
    let distant = eye.flat > 0.0 || depth > 4.0 * reach;
    if (!distant || !enclosed(center, reach)) {
        seen = seen_part(chunk, place);
        if (!(seen.share > 0.0)) {
            return no_offers();
        }
    }
    let nearest = pixel_at(max(seen.nearest, eye.near));
    let pixel = max(pixel_at(seen.middle), nearest);
    // Size of a pixel in the template's coordinates: errors and lengths are given in those.
    let near_pixel = nearest / place.scale;
    let far_pixel = pixel / place.scale;
    var shown = 1.0;
    if ((chunk.flags & CHUNK_TWIG) != 0u) {
        shown = twig_share(chunk.length / far_pixel);
        if (shown == 0.0) {
            return no_offers();
        }
    }
    let mean = chunk.radius * (f32(chunk.flags >> 16u) / 65535.0) / far_pixel;
    var width = 2.0 * mean;
    if (mean < HALF_PIXEL) {
        width = ink_share(mean / HALF_PIXEL);
    }
    let length = min(chunk.length, 2.0 * chunk.reach) * min(seen.share, 1.0);
    let area = max(length / far_pixel, 0.25) * width;

    let coarse = lod_within(chunk, 4.0 * eye.error * near_pixel);
    let fine = lod_within(chunk, eye.error * near_pixel);
    var halvings = 0u;
    if (fine == 0u && !is_reduced(chunk)) {
        let off = lod_error(chunk, 0u) / (eye.error * near_pixel);
        halvings = u32(clamp(ceil(0.5 * log2(max(off, 1.0))), 0.0, 3.0));
    }
    let strips = strips_of(chunk.radius / near_pixel);
    var caps = 0u;
    if (strips > 1u) {
        caps = DOME_QUADS * countOneBits(chunk.flags & (CHUNK_FREE_START | CHUNK_FREE_END));
    }
    let first = segments(chunk, coarse);
    let second = segments(chunk, fine) << halvings;
    let third = second * strips + caps;
    // Worth goes by projected size. A chunk is worth as much as the largest one behind it, so that
    // no chunk is drawn without those that lead to it.
    let worth = 2.0 * chunk.carried / (far_pixel * sqrt(far_pixel)) * chance_factor(instance);
    var all = no_offers();
    all.width = shown;
    all.bins.x = max(bin_of(worth), 1u);
    all.quads.x = first;
    all.lods.x = packed_lod(WHAT_TUBE, coarse, 0u, 1u, 0u);
    if (second > first) {
        all.bins.y = min(bin_of(0.25 * area / f32(second - first)), all.bins.x);
        all.quads.y = second - first;
        all.lods.y = packed_lod(WHAT_TUBE, fine, halvings, 1u, 0u);
    }
    if (third > max(first, second)) {
        let before = select(all.bins.x, all.bins.y, second > first);
        let quads = third - max(first, second);
        all.bins.z = min(bin_of(0.25 * area / f32(quads)), before);
        all.quads.z = quads;
        all.lods.z = packed_lod(WHAT_TUBE, fine, halvings, strips, 0u);
    }
    return all;
}

// Worth of a soma of a pixel.
const SOMA_WORTH: f32 = 256.0;

// How strongly the worth of a soma depends on chance: of one of five pixels not at all, of one below a pixel most. `side`:
// root of its area (pixels).
fn thinning(side: f32) -> f32 {
    return 6.0 * clamp(0.25 * (5.0 - side), 0.0, 1.0);
}

// Worth of a soma. That of a small one depends on chance: where there are too many, a share of them is drawn, of far ones
// a smaller one, so that a dense crowd still looks like one (Cook et al., Stochastic simplification of aggregate detail,
// 2007).
fn soma_worth(side: f32, instance: u32) -> f32 {
    let size = select(side, side * side, side > 1.0);
    let luck = log2(max(chance(instance), 1e-6));
    return SOMA_WORTH * size * chance_factor(instance) * exp2(thinning(side) * luck);
}

// How much larger a soma's dot is drawn, since it stands for those of its size that are left out: at most with a radius of
// a pixel. `least`: the least worth that is drawn.
fn dot_width(side: f32, least: f32) -> f32 {
    let size = select(side, side * side, side > 1.0);
    let rest = pow(min(least / (SOMA_WORTH * size), 1.0), 1.0 / max(thinning(side), 1e-3));
    return clamp(inverseSqrt(max(1.0 - rest, 1e-6)), 1.0, max(1.7725 / max(side, 1e-6), 1.0));
}

// Somata are worth more than neurites of their size: they show where the neurons of a circuit are.
fn soma_offers(chunk: Chunk, radius: f32, instance: u32) -> Offers {
    let area = 3.1416 * radius * radius;
    var all = no_offers();
    all.width = sqrt(area);
    all.bins.x = max(bin_of(soma_worth(all.width, instance)), 1u);
    all.quads.x = 1u;
    all.lods.x = packed_lod(WHAT_DOT, 0u, 0u, 1u, 0u);
    if (radius <= 1.0) {
        return all;
    }
    let dome = radius > 3.0;
    let sphere = select(DISC_QUADS, DOME_QUADS, dome);
    all.bins.y = min(bin_of(16.0 * area / f32(sphere)), all.bins.x);
    all.quads.y = sphere - 1u;
    all.lods.y = packed_lod(select(WHAT_DISC, WHAT_DOME, dome), 0u, 0u, 1u, FULL_WIDTH);
    let own = chunk.counts.x;
    if (radius <= 6.0 || own <= sphere) {
        return all;
    }
    all.bins.z = min(bin_of(8.0 * area / f32(own)), all.bins.y);
    all.quads.z = own - sphere;
    all.lods.z = packed_lod(WHAT_SOMA, 0u, 0u, 1u, FULL_WIDTH);
    // Within half a pixel also where the soma bends four times as sharply as a sphere of its size.
    let off = 4.0 * (3.1416 / 2.0) * radius / f32(own) / eye.error;
    let halvings = u32(clamp(ceil(0.5 * log2(max(off, 1.0))), 0.0, 3.0));
    if (halvings > 0u) {
        let quads = (own << (2u * halvings)) - own;
        all.bins.w = min(bin_of(area / f32(quads)), all.bins.z);
        all.quads.w = quads;
        all.lods.w = packed_lod(WHAT_SOMA, 0u, halvings, 1u, FULL_WIDTH);
    }
    return all;
}
