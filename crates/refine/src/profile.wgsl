// The radius along a tube.
//
// Imported by evaluate.wgsl and level.wgsl. Rust twin: evaluate/profile.rs, with the theory.

// The radius at y in [0, 1]: start + way y + y (1 - y) ((1 - y) b_0 - y b_1), a monotone cubic (Fritsch
// and Carlson, Monotone piecewise cubic interpolation, 1980). Its slopes are way + b_0 and way + b_1.
struct Profile {
    start: f32,
    way: f32,
    beyond: vec2<f32>,
}

// Between two radii. `slopes`: what the tapers say at both ends; `own`: whether they say anything.
fn profile_of(start: f32, end: f32, slopes: vec2<f32>, own: vec2<bool>) -> Profile {
    let way = end - start;
    let most = STEEPEST_PROFILE * way;
    let least = vec2(min(most, 0.0));
    let greatest = vec2(max(most, 0.0));
    let limited = clamp(slopes, least, greatest);
    // Where tubes have no slope in common the cubic has that of the straight way.
    let ends = select(vec2(way), limited, own);
    return Profile(start, way, ends - vec2(way));
}

fn profile_radius(p: Profile, y: f32) -> f32 {
    return p.start + p.way * y + profile_bump(p, y).x;
}

// The radius over what it would be on the straight way, with its derivative.
fn profile_share(p: Profile, y: f32) -> vec2<f32> {
    let straight = 1.0 / max(p.start + p.way * y, 1e-37);
    let bump = profile_bump(p, y) * straight;
    return vec2(1.0 + bump.x, bump.y - bump.x * p.way * straight);
}

// How much more the radius is than on the straight way, with its derivative.
fn profile_bump(p: Profile, y: f32) -> vec2<f32> {
    let turn = (1.0 - y) * p.beyond.x - y * p.beyond.y;
    return vec2(
        y * (1.0 - y) * turn,
        (1.0 - 2.0 * y) * turn - y * (1.0 - y) * (p.beyond.x + p.beyond.y),
    );
}

// Bound of the second derivative.
fn profile_bend(p: Profile) -> f32 {
    let b = p.beyond;
    return max(abs(4.0 * b.x + 2.0 * b.y), abs(2.0 * b.x + 4.0 * b.y));
}

// Bound of the derivative: those of the ends and of the control point between them.
fn profile_steepest(p: Profile) -> f32 {
    let ends = abs(vec2(p.way) + p.beyond);
    return max(max(ends.x, ends.y), abs(p.way - p.beyond.x - p.beyond.y));
}
