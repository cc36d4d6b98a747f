// Computes coarse points: the rings that are needed, and the explicit vertices of all placed parts.
//
// Called by refiner.rs for a batch, after note.wgsl: a lane for each point of queued clusters, and
// one for each explicit vertex.

#import clusters.wgsl
#import coarse_point.wgsl

@group(2) @binding(0) var<storage, read_write> coarse: array<CoarsePoint>;

@compute @workgroup_size(CLUSTER)
fn make_rings(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let k = CLUSTERS_OF_GROUP * group.x + lane / POINTS_OF_CLUSTER;
    if (k >= atomicLoad(&marks[RING_MARK])) {
        return;
    }
    let cluster = queues[ring_queue() + k];
    let here = lane % POINTS_OF_CLUSTER;
    if ((atomicLoad(&marks[ring_mark(cluster)]) & (1u << here)) == 0u) {
        return;
    }
    let slot = cluster * CLUSTER + 4u * here;
    let part = placed[owners[cluster]];
    let point = (slot - part.first_slot) / 4u;
    let point_bits = packed_point(part.base, point);
    if (!is_implicit(point_bits)) {
        return;
    }
    let ring = implicit_ring(part.base, point, point_bits);
    let center = relative(part, ring.center);
    let turn = pack_turn(
        direction_of(part, ring_direction(ring.tangent, ring.turn, 0u)),
        direction_of(part, ring_direction(ring.tangent, ring.turn, 1u)),
        direction_of(part, ring.tangent),
        taper_bits(part.base, point, point_bits),
    );
    coarse[slot / 4u] = CoarsePoint(
        center.x,
        center.y,
        center.z,
        ring.radius * part.scale,
        turn.x,
        turn.y,
        point_color_key(part.base, point_bits),
        part.instance,
    );
}

@compute @workgroup_size(CLUSTER)
fn make_explicit(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= batch.explicit_vertices) {
        return;
    }
    let at = frame.first_explicit + id.x;
    let part = placed[explicit_owner_of(at)];
    let vertex = (at - part.first_explicit) | EXPLICIT;
    let v = named_corner(part.base, vertex);
    let position = relative(part, v.position);
    coarse[coarse_index(at)] = CoarsePoint(
        position.x,
        position.y,
        position.z,
        v.radius * part.scale,
        pack_direction(turned(part, v.normal)),
        pack_direction(turned(part, v.tangent)),
        color_key_of(part.base, vertex),
        part.instance,
    );
    let center = relative(part, v.center);
    let collar = v.collar * select(1.0, part.scale, v.role == ROLE_INSET);
    coarse[coarse_index(at) + 1u] =
        CoarsePoint(center.x, center.y, center.z, collar, v.role, bitcast<u32>(v.taper), 0u, part.instance);
}

// The placed part that an explicit vertex belongs to.
fn explicit_owner_of(at: u32) -> u32 {
    var low = batch.first;
    var high = batch.first + batch.placed;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (placed[middle].first_explicit <= at) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

fn direction_of(part: Placed, v: vec3<f32>) -> vec3<f32> {
    return turned(part, v) / part.scale;
}
