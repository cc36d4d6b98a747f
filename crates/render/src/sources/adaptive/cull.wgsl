// Decides for each patch whether it is drawn, and at which levels.
//
// Called by refiner.rs for a batch, after classify.wgsl, for what it queued: `decide_plain` for
// clusters whose one level is known; `decide_tubes` for points with implicit rings, a lane for the
// four patches to the next point; `decide_singles` for all other patches. CPU twin: cull.rs.

#import clusters.wgsl
#import shown.wgsl

@group(2) @binding(0) var<storage, read_write> decisions: array<u32>;
// By point: level of its implicit ring; 0 if no tube of an asked cluster needs it.
@group(2) @binding(1) var<storage, read_write> ring_levels: array<u32>;
// Workgroups of decide_singles: three u32s.
@group(2) @binding(2) var<storage, read_write> single_dispatch: array<atomic<u32>>;

@compute @workgroup_size(CLUSTER)
fn decide_plain(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let entry = queues[plain_queue() + group.x];
    let cluster = queued_cluster(entry);
    let slot = cluster * CLUSTER + lane;
    let place = placed[owners[cluster]];
    let patch_index = slot - place.first_slot;
    var decided = 0u;
    if (patch_exists(place.base, patch_index)) {
        let tube = patch_is_tube(place.base, patch_index);
        let kind = select(PATCH_LATERAL, DECIDED_TUBE, tube);
        decided = decision(kind, vec4<u32>(queued_level(entry)));
    }
    decisions[slot] = decided;
}

// A point of an asked cluster: one whose patches are decided one by one.
struct AskedPoint {
    there: bool,
    // First of the slots of its four patches.
    slot: u32,
    owner: u32,
    point: u32,
}

fn asked_point(group: u32, lane: u32) -> AskedPoint {
    let k = CLUSTERS_OF_GROUP * group + lane / POINTS_OF_CLUSTER;
    if (k >= atomicLoad(&marks[ASKED_MARK])) {
        return AskedPoint(false, 0u, 0u, 0u);
    }
    let cluster = queues[asked_queue() + k];
    let owner = owners[cluster];
    let slot = cluster * CLUSTER + 4u * (lane % POINTS_OF_CLUSTER);
    return AskedPoint(true, slot, owner, (slot - placed[owner].first_slot) / 4u);
}

// Levels of the rings of asked clusters, and of the first ring of the next cluster. They are
// computed only here, so that all patches that meet at a ring agree.
@compute @workgroup_size(CLUSTER)
fn level_rings(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let asked = asked_point(group.x, lane);
    if (!asked.there) {
        return;
    }
    let place = placed[asked.owner];
    let last = asked.point % POINTS_OF_CLUSTER == POINTS_OF_CLUSTER - 1u;
    for (var k = 0u; k < 2u; k += 1u) {
        let point = asked.point + k;
        if (k == 0u || (last && point < place.base.point_count)) {
            let point_bits = packed_point(place.base, point);
            if (is_implicit(point_bits)) {
                ring_levels[asked.slot / 4u + k] = level_of_ring(place, point, point_bits);
            }
        }
    }
}

fn level_of_ring(place: Placed, point: u32, point_bits: vec4<u32>) -> u32 {
    let center = point_center(place.base, point, point_bits);
    let value = value_of(place.base, 4u * point);
    return ring_level(levels_of(place), view_of(frame, place), center, point_radius(point_bits), value);
}

@compute @workgroup_size(CLUSTER)
fn decide_tubes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let asked = asked_point(group.x, lane);
    if (!asked.there) {
        return;
    }
    let place = placed[asked.owner];
    let base = place.base;
    let tube = patch_is_tube(base, 4u * asked.point);
    var decided = vec4<u32>(0u);
    if (goes_on(base, asked.point)) {
        if (tube) {
            decided = ask_tube(place, asked.point, asked.slot);
        } else {
            let k = atomicAdd(&marks[SINGLE_MARK], 1u);
            queues[single_queue() + k] = asked.slot / 4u;
            if (k % POINTS_OF_CLUSTER == 0u) {
                atomicAdd(&single_dispatch[0], 1u);
            }
        }
    }
    for (var k = 0u; k < 4u; k += 1u) {
        decisions[asked.slot + k] = decided[k];
    }
}

// Decisions on the four patches around a tube.
fn ask_tube(place: Placed, point: u32, slot: u32) -> vec4<u32> {
    let base = place.base;
    let first_bits = packed_point(base, point);
    let last_bits = packed_point(base, point + 1u);
    let first = implicit_ring(base, point, first_bits);
    let last = implicit_ring(base, point + 1u, last_bits);
    let half = length(last.center - first.center) * 0.5;
    let reach = half + max(first.radius, last.radius) * TUBE_REACH;
    if (shown(place, (first.center + last.center) * 0.5, reach) == SHOWS_NOTHING) {
        return vec4<u32>(0u);
    }
    // Opposite corners of a ring have opposite directions, so edges along the path have the same
    // level there, unless the criterion measures the edge itself.
    let levels = levels_of(place);
    let view = view_of(frame, place);
    let values = vec2<u32>(value_of(base, 4u * point), value_of(base, 4u * point + 4u));
    var along = vec4<u32>(1u);
    for (var k = 0u; k < select(2u, 4u, levels.kind == LEVELS_PIXEL_SIZE); k += 1u) {
        let a = ring_corner(first, k);
        let b = ring_corner(last, k);
        along[k] = edge_level(levels, view, EDGE_ALONG, a, values.x, b, values.y);
    }
    if (levels.kind != LEVELS_PIXEL_SIZE) {
        along = along.xyxy;
    }
    let near = ring_levels[slot / 4u];
    let far = ring_levels[slot / 4u + 1u];
    return vec4<u32>(
        decision(DECIDED_TUBE, vec4<u32>(near, along.y, far, along.x)),
        decision(DECIDED_TUBE, vec4<u32>(near, along.z, far, along.y)),
        decision(DECIDED_TUBE, vec4<u32>(near, along.w, far, along.z)),
        decision(DECIDED_TUBE, vec4<u32>(near, along.x, far, along.w)),
    );
}

@compute @workgroup_size(CLUSTER)
fn decide_singles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let k = POINTS_OF_CLUSTER * group.x + lane / 4u;
    if (k >= atomicLoad(&marks[SINGLE_MARK])) {
        return;
    }
    let slot = 4u * queues[single_queue() + k] + (lane & 3u);
    let place = placed[owners[slot / CLUSTER]];
    let patch_index = slot - place.first_slot;
    var decided = 0u;
    if (patch_index < place.patches && patch_exists(place.base, patch_index)) {
        decided = ask(place, patch_index);
    }
    decisions[slot] = decided;
}

fn ask(place: Placed, patch_index: u32) -> u32 {
    let base = place.base;
    let p = patch_at(base, patch_index);
    let sphere = patch_sphere(base, p);
    if (shown(place, sphere.center, sphere.radius) == SHOWS_NOTHING) {
        return 0u;
    }
    var levels = side_levels(base, p, levels_of(place), view_of(frame, place));
    for (var index = 0u; index < 4u; index += 1u) {
        let s = patch_side(base, p, index);
        if (s.kind == EDGE_RING && (s.start & EXPLICIT) == 0u) {
            levels[index] = known_ring_level(place, s.start / 4u);
        }
    }
    return decision(p.kind, levels);
}

fn known_ring_level(place: Placed, point: u32) -> u32 {
    let known = ring_levels[place.first_slot / 4u + point];
    if (known != 0u) {
        return known;
    }
    // No tube of an asked cluster meets there.
    return level_of_ring(place, point, packed_point(place.base, point));
}

// Bounding sphere of a patch at any level.
struct BoundingSphere {
    center: vec3<f32>,
    radius: f32,
}

fn patch_sphere(base: Base, p: Patch) -> BoundingSphere {
    let by_corners = p.kind == PATCH_SOMA || p.kind == PATCH_LOFT;
    var points: array<vec3<f32>, 4>;
    var reaches: vec4<f32>;
    for (var k = 0u; k < 4u; k += 1u) {
        let c = corner(base, p.corners[k]);
        points[k] = c.center;
        reaches[k] = length(c.offset) * TUBE_REACH;
        if (by_corners) {
            points[k] = c.position;
            reaches[k] = 0.0;
        }
    }
    let center = (points[0] + points[1] + points[2] + points[3]) * 0.25;
    var radius = 0.0;
    for (var k = 0u; k < 4u; k += 1u) {
        var reach = length(points[k] - center) + reaches[k];
        if (by_corners) {
            reach *= SOMA_REACH;
        }
        radius = max(radius, reach);
    }
    return BoundingSphere(center, radius);
}
