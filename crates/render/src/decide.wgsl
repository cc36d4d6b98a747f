// Who is drawn, and how finely: each patch's levels, or nothing where it is culled; and the counts of
// every bucket.
//
// Called by refiner.rs for a batch, before list.wgsl. CPU twin: decide.rs.

@group(1) @binding(4) var<uniform> frame: Frame;
@group(1) @binding(5) var<uniform> batch: Batch;
@group(1) @binding(6) var<storage, read> placed: array<Placed>;
// By cluster of slots: its placed part.
@group(1) @binding(7) var<storage, read_write> owners: array<u32>;
@group(1) @binding(8) var<storage, read_write> decisions: array<u32>;
// By bucket and section of slots.
@group(1) @binding(9) var<storage, read_write> counts: array<atomic<u32>>;

// The placed part that a slot belongs to: the last that begins at or before it.
fn owner_of(slot: u32) -> u32 {
    var low = batch.first;
    var high = batch.first + batch.placed;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (placed[middle].first_slot <= slot) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Whether a ball shows: within the frustum, and not smaller than what is left out. What is thinner than
// a pixel is drawn a pixel wide.
fn shows(place: Placed, center: vec3<f32>, radius: f32) -> bool {
    let view = view_of(frame, place);
    let depth = max(dot(view.forward, center - view.eye) - radius, view.near);
    let pixel = view.slope * depth + view.flat;
    let p = relative(place, center);
    let reach = (radius + pixel) * place.scale;
    for (var k = 0u; k < 5u; k += 1u) {
        // Also where it is not a number.
        if (!(dot(frame.planes[k].xyz, p) + frame.planes[k].w >= -reach)) {
            return false;
        }
    }
    return 2.0 * radius >= frame.smallest * pixel;
}

// Ball around a patch at any level.
struct Ball {
    center: vec3<f32>,
    radius: f32,
}

fn patch_ball(base: Base, p: Patch) -> Ball {
    var points: array<vec3<f32>, 4>;
    var reaches: vec4<f32>;
    for (var k = 0u; k < 4u; k += 1u) {
        let c = corner(base, p.corners[k]);
        points[k] = c.center;
        reaches[k] = length(c.offset) * TUBE_REACH;
        if (p.kind == PATCH_SOMA) {
            points[k] = c.position;
            reaches[k] = 0.0;
        }
    }
    let center = (points[0] + points[1] + points[2] + points[3]) * 0.25;
    var radius = 0.0;
    for (var k = 0u; k < 4u; k += 1u) {
        var reach = length(points[k] - center) + reaches[k];
        if (p.kind == PATCH_SOMA) {
            reach *= SOMA_REACH;
        }
        radius = max(radius, reach);
    }
    return Ball(center, radius);
}

var<workgroup> words: array<u32, CLUSTER>;

@compute @workgroup_size(CLUSTER)
fn decide(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let slot = group.x * CLUSTER + lane;
    let owner = owner_of(group.x * CLUSTER);
    if (lane == 0u) {
        owners[group.x] = owner;
    }
    let place = placed[owner];
    let patch_index = slot - place.first_slot;
    var word = 0u;
    if (patch_index < place.patches) {
        let at = place.base.balls + 4u * (patch_index / PLACES_OF_BALL);
        let center = vec3<f32>(
            bitcast<f32>(heap[at]),
            bitcast<f32>(heap[at + 1u]),
            bitcast<f32>(heap[at + 2u]),
        );
        if (shows(place, center, bitcast<f32>(heap[at + 3u]))
            && patch_exists(place.base, patch_index)) {
            word = decide_patch(place, patch_index);
        }
    }
    words[lane] = word;
    workgroupBarrier();
    // The patches around a tube, all of level 1, are drawn as one: 10 vertices instead of 16.
    let first = lane & ~3u;
    var whole = true;
    for (var k = 0u; k < 4u; k += 1u) {
        whole = whole && words[first + k] == decision(DECIDED_TUBE, vec4<u32>(1u));
    }
    if (whole) {
        word = select(0u, word | DECISION_WHOLE, lane == first);
    }
    decisions[slot] = word;
    if (word != 0u) {
        atomicAdd(&counts[bucket_of(word, frame.levels.caps) * batch.sections + slot / SECTION], 1u);
    }
}

fn decide_patch(place: Placed, patch_index: u32) -> u32 {
    let base = place.base;
    let p = patch_at(base, patch_index);
    let ball = patch_ball(base, p);
    if (!shows(place, ball.center, ball.radius)) {
        return 0u;
    }
    var levels = frame.levels;
    if (levels.kind == LEVELS_DISTANCE || levels.kind == LEVELS_MAX_ERROR) {
        levels.amount = levels.amount / place.scale;
    }
    let kind = select(p.kind, DECIDED_TUBE, patch_is_tube(base, patch_index));
    return decision(kind, side_levels(base, p, levels, view_of(frame, place)));
}

