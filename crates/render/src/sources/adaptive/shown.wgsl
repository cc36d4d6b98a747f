// What is in view. Called by classify.wgsl and cull.wgsl. CPU twin: cull.rs.

#import clusters.wgsl

// What shows of a sphere: nothing, some of it or all. It shows within the frustum, and if it is not
// smaller than what is left out. What is thinner than a pixel is drawn a pixel wide.
const SHOWS_NOTHING: u32 = 0u;
const SHOWS_SOME: u32 = 1u;
const SHOWS_ALL: u32 = 2u;

fn shown(place: Placed, center: vec3<f32>, radius: f32) -> u32 {
    let view = view_of(frame, place);
    let depth = max(dot(view.forward, center - view.eye) - radius, view.near);
    let pixel = view.slope * depth + view.flat;
    let p = relative(place, center);
    let reach = (radius + pixel) * place.scale;
    // Of things within the sphere, each with a reach of its own, nothing must be asked any more.
    var all = frame.smallest == 0.0;
    for (var k = 0u; k < 5u; k += 1u) {
        let inside = dot(frame.planes[k].xyz, p) + frame.planes[k].w;
        // Also where it is not a number.
        if (!(inside >= -reach)) {
            return SHOWS_NOTHING;
        }
        all = all && inside >= reach;
    }
    if (!(2.0 * radius >= frame.smallest * pixel)) {
        return SHOWS_NOTHING;
    }
    return select(SHOWS_SOME, SHOWS_ALL, all);
}

// The criterion in the coordinates of a placed part.
fn levels_of(place: Placed) -> LodCriterion {
    var levels = frame.levels;
    if (levels.kind == LEVELS_DISTANCE || levels.kind == LEVELS_MAX_ERROR) {
        levels.amount = levels.amount / place.scale;
    }
    return levels;
}
