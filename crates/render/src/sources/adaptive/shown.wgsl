// Culls bounding spheres. Imported by classify.wgsl and cull.wgsl. CPU twin: cull.rs.

#import clusters.wgsl

// How much of a sphere shows: nothing, some or all. It must reach into the frustum, and must not be
// smaller than the smallest size. It may reach a pixel further, since thin tubes are drawn a pixel
// wide.
const SHOWS_NOTHING: u32 = 0u;
const SHOWS_SOME: u32 = 1u;
const SHOWS_ALL: u32 = 2u;

fn shown(place: Placed, center: vec3<f32>, radius: f32) -> u32 {
    let view = view_of(frame, place);
    let depth = max(dot(view.forward, center - view.eye) - radius, view.near);
    let pixel = view.slope * depth + view.flat;
    let p = relative(place, center);
    let reach = (radius + pixel) * place.scale;
    // Only then does everything inside the sphere show, and need not be culled for itself.
    var all = frame.smallest == 0.0;
    for (var k = 0u; k < 5u; k += 1u) {
        let inside = dot(frame.planes[k].xyz, p) + frame.planes[k].w;
        // Written so that a position that is not a number is outside.
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
