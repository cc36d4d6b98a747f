// The level of an edge, 1 to 64, from the edge alone.
//
// Called by the shader that decides levels and by the one of the parity test.
// Rust twin: level.rs. Constants are defined in gpu.rs.

#import evaluate.wgsl

struct LodView {
    eye: vec3<f32>,
    slope: f32,
    forward: vec3<f32>,
    flat: f32,
    near: f32,
}

// What decides on levels: `kind` is a LEVELS_ constant, `amount` its length or number of pixels.
// Twin of GpuLodCriterion in gpu.rs.
struct LodCriterion {
    kind: u32,
    level: u32,
    amount: f32,
    path: u32,
    caps: u32,
}

// Level of an edge; `value_a` and `value_b` are the levels given for its two tracing points.
fn edge_level(
    levels: LodCriterion,
    view: LodView,
    kind: u32,
    a: Corner,
    value_a: u32,
    b: Corner,
    value_b: u32,
) -> u32 {
    var level = levels.level;
    switch (levels.kind) {
        case LEVELS_PER_POINT: {
            level = max(value_a, value_b);
        }
        case LEVELS_MAX_ERROR, LEVELS_PIXEL_ERROR: {
            // A single call for both cases, since compilers copy the function into every call.
            var error = max(levels.amount, 1e-6);
            if (levels.kind == LEVELS_PIXEL_ERROR) {
                error = levels.amount * um_per_pixel(view, a, b);
            }
            level = by_error(error * SHARE, levels.path, kind, a, b);
        }
        case LEVELS_DISTANCE: {
            level = by_distance(view, levels.level, levels.amount, a, b);
        }
        case LEVELS_PIXEL_SIZE: {
            let size = levels.amount * um_per_pixel(view, a, b);
            level = round_up(length(b.position - a.position) / size);
        }
        default: {}
    }
    return clamp(level, 1u, HIGHEST_LEVEL);
}

// The level of the edges of an implicit ring, the same for all since it is a circle. `value`: the
// level given for its tracing point. Equal to edge_level's, up to rounding.
fn ring_level(levels: LodCriterion, view: LodView, center: vec3<f32>, radius: f32, value: u32) -> u32 {
    let nearest = max(dot(view.forward, center - view.eye) - radius, view.near);
    let pixel = view.slope * nearest + view.flat;
    var level = levels.level;
    switch (levels.kind) {
        case LEVELS_PER_POINT: {
            level = value;
        }
        case LEVELS_MAX_ERROR, LEVELS_PIXEL_ERROR: {
            var error = max(levels.amount, 1e-6);
            if (levels.kind == LEVELS_PIXEL_ERROR) {
                error = levels.amount * pixel;
            }
            // by_error with `turning` of a quarter turn, whose speed is 2 tan(45 degrees).
            level = round_up(sqrt(4.0 * radius / (8.0 * error * SHARE)));
        }
        case LEVELS_DISTANCE: {
            let near = clamp(1.0 - length(center - view.eye) / levels.amount, 0.0, 1.0);
            level = u32(f32(levels.level) * near + 0.5);
        }
        case LEVELS_PIXEL_SIZE: {
            level = round_up(radius * SQRT_2 / (levels.amount * pixel));
        }
        default: {}
    }
    return clamp(level, 1u, HIGHEST_LEVEL);
}

// The level of all edges within a sphere that bend by at most `bend`; 0 if they may have different
// levels.
fn sphere_level(levels: LodCriterion, view: LodView, center: vec3<f32>, radius: f32, bend: f32) -> u32 {
    switch (levels.kind) {
        case LEVELS_PER_POINT, LEVELS_PIXEL_SIZE: {
            return 0u;
        }
        case LEVELS_MAX_ERROR: {
            return one_if(bend <= 8.0 * max(levels.amount, 1e-6) * SHARE);
        }
        case LEVELS_DISTANCE: {
            let nearest = max(length(center - view.eye) - radius, 0.0);
            let most = clamp(1.0 - nearest / levels.amount, 0.0, 1.0);
            return one_if(f32(levels.level) * most < 1.499);
        }
        case LEVELS_PIXEL_ERROR: {
            let nearest = max(dot(view.forward, center - view.eye) - radius, view.near);
            return one_if(bend <= 8.0 * levels.amount * (view.slope * nearest + view.flat) * SHARE);
        }
        default: {
            return clamp(levels.level, 1u, HIGHEST_LEVEL);
        }
    }
}

fn one_if(certain: bool) -> u32 {
    return select(0u, 1u, certain);
}

// A curve with a second derivative of at most M, cut into n parts, is at most M / (8 n^2) from its
// chords.
fn by_error(error: f32, path: u32, kind: u32, a: Corner, b: Corner) -> u32 {
    var bend = 0.0;
    if (kind == EDGE_RING) {
        bend = turning(a, b);
    } else if (kind == EDGE_ALONG) {
        bend = center_bend(a, b, path) + turning(a, b) + widening(a, b, path);
    } else {
        var p = soma_controls(a, b);
        if (kind == EDGE_LOFT) {
            p = loft_controls(a, b);
        }
        bend = max(second(p[0], p[1], p[2]), second(p[1], p[2], p[3]));
    }
    return round_up(sqrt(bend / (8.0 * error)));
}

fn second(p: vec3<f32>, q: vec3<f32>, r: vec3<f32>) -> f32 {
    return length(p - q * 2.0 + r) * 6.0;
}

fn importance(view: LodView, far: f32, k: Corner) -> f32 {
    return clamp(1.0 - length(k.center - view.eye) / far, 0.0, 1.0);
}

// The importance of Garcia-Cantero et al. 2017, as the mean of the two ends.
fn by_distance(view: LodView, level: u32, far: f32, a: Corner, b: Corner) -> u32 {
    return u32(f32(level) * 0.5 * (importance(view, far, a) + importance(view, far, b)) + 0.5);
}

fn near_depth(view: LodView, k: Corner) -> f32 {
    return dot(view.forward, k.center - view.eye) - length(k.offset);
}

// Size (micrometers) of a pixel at the nearer end of an edge.
fn um_per_pixel(view: LodView, a: Corner, b: Corner) -> f32 {
    let nearer = max(min(near_depth(view, a), near_depth(view, b)), view.near);
    return view.slope * nearer + view.flat;
}

fn round_up(cuts: f32) -> u32 {
    if (cuts < f32(HIGHEST_LEVEL)) {
        return u32(max(ceil(cuts - SLACK), 1.0));
    }
    return HIGHEST_LEVEL;
}

// Bound of the second derivative of the offset as it turns from one corner to the other.
fn turning(a: Corner, b: Corner) -> f32 {
    let ra = length(a.offset);
    let rb = length(b.offset);
    let speed = turning_speed(a, b);
    return max(ra, rb) * speed * speed + 2.0 * abs(ra - rb) * speed;
}

// Greatest speed (radians) of the normalized mixture of two corners' radials.
fn turning_speed(a: Corner, b: Corner) -> f32 {
    let apart = length(a.radial - b.radial);
    let together = length(a.radial + b.radial);
    return 2.0 * min(apart / max(together, 1e-6), STEEPEST);
}

// Bound of what the second derivative of the offset is more where the radius is no straight line.
fn widening(a: Corner, b: Corner, path: u32) -> f32 {
    let profile = profile_between(a, b, path);
    let steeper = profile_steepest(profile) - abs(profile.way);
    let radii = max(length(a.offset) / max(a.radius, 1e-37), length(b.offset) / max(b.radius, 1e-37));
    return radii * (profile_bend(profile) + 2.0 * steeper * turning_speed(a, b));
}

fn center_bend(a: Corner, b: Corner, path: u32) -> f32 {
    if (path == PATH_LINEAR) {
        return 0.0;
    }
    let way = b.center - a.center;
    let m0 = hermite_tangent(a, a, b);
    let m1 = hermite_tangent(b, a, b);
    let start = way * 6.0 - m0 * 4.0 - m1 * 2.0;
    let end = m0 * 2.0 + m1 * 4.0 - way * 6.0;
    return max(length(start), length(end));
}
