// Counts the decisions: how many patches each bucket gets, and which rings they need.
//
// Called by refiner.rs for a batch, after cull.wgsl: a workgroup for each cluster that shows.

#import clusters.wgsl

@group(2) @binding(0) var<storage, read_write> decisions: array<u32>;
// Workgroups of the passes that take the queues of sections and of rings: three u32s each.
@group(2) @binding(1) var<storage, read_write> dispatches: array<atomic<u32>>;

var<workgroup> decided_of_lane: array<u32, CLUSTER>;
// By four patches of the cluster: how many are drawn flat, and how many are refined.
var<workgroup> flat_counts: array<u32, POINTS_OF_CLUSTER>;
var<workgroup> fine_counts: array<u32, POINTS_OF_CLUSTER>;

@compute @workgroup_size(CLUSTER)
fn note(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let cluster = queues[shown_queue() + group.x];
    let slot = cluster * CLUSTER + lane;
    let decided = decisions[slot];
    decided_of_lane[lane] = decided;
    let place = placed[owners[cluster]];
    let patch_index = slot - place.first_slot;
    let lateral = patch_index < 4u * place.base.point_count;
    let section = slot / SECTION;
    if (decided != 0u && !is_flat(decided)) {
        atomicAdd(&marks[count_mark(bucket_of(decided, frame.levels.caps), section)], 1u);
    }
    if (decided != 0u && !lateral) {
        need_cap_ring(place, patch_index);
    }
    workgroupBarrier();
    if (lane < POINTS_OF_CLUSTER) {
        var flat = 0u;
        var fine = 0u;
        for (var k = 0u; k < 4u; k += 1u) {
            let other = decided_of_lane[4u * lane + k];
            flat += u32(is_flat(other));
            fine += u32(other != 0u && !is_flat(other));
        }
        flat_counts[lane] = flat;
        fine_counts[lane] = fine;
    }
    workgroupBarrier();
    if (lane == 0u) {
        note_cluster(cluster, section, lateral);
    }
}

fn note_cluster(cluster: u32, section: u32, lateral: bool) {
    var flat = 0u;
    var fine = 0u;
    var points = 0u;
    for (var k = 0u; k < POINTS_OF_CLUSTER; k += 1u) {
        flat += flat_counts[k];
        fine += fine_counts[k];
        points |= u32(flat_counts[k] + fine_counts[k] != 0u) << k;
    }
    atomicStore(&marks[flat_mark(cluster)], flat);
    atomicStore(&marks[fine_mark(cluster)], fine);
    if (fine != 0u && atomicExchange(&marks[section_mark(section)], 1u) == 0u) {
        queues[section_queue() + atomicAdd(&dispatches[3u * QUEUE_SECTIONS], 1u)] = section;
    }
    if (lateral && points != 0u) {
        // A tube needs the rings at both its ends.
        let both = points | (points << 1u);
        need_rings(cluster, both & ((1u << POINTS_OF_CLUSTER) - 1u));
        if ((both >> POINTS_OF_CLUSTER) != 0u) {
            need_rings(cluster + 1u, 1u);
        }
    }
}

fn need_rings(cluster: u32, points: u32) {
    if (atomicOr(&marks[ring_mark(cluster)], points) == 0u) {
        let k = atomicAdd(&marks[RING_MARK], 1u);
        queues[ring_queue() + k] = cluster;
        if (k % CLUSTERS_OF_GROUP == 0u) {
            atomicAdd(&dispatches[3u * QUEUE_RINGS], 1u);
        }
    }
}

fn need_cap_ring(place: Placed, patch_index: u32) {
    let corner = patch_at(place.base, patch_index).corners.x;
    if ((corner & EXPLICIT) == 0u) {
        let slot = place.first_slot + corner;
        need_rings(slot / CLUSTER, 1u << (slot % CLUSTER / 4u));
    }
}
