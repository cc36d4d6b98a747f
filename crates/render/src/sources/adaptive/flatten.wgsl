// Writes the triangles of patches at level 1.
//
// Called by refiner.rs for a batch, after scan.wgsl: a workgroup for each cluster that shows.

#import clusters.wgsl

@group(2) @binding(0) var<storage, read_write> decisions: array<u32>;
@group(2) @binding(1) var<storage, read_write> flat_indices: array<u32>;

var<workgroup> here: array<u32, CLUSTER>;
// Number of flat patches among each eight of a cluster.
var<workgroup> eights: array<u32, 8>;

// Writes the triangles of the flat patches of a cluster that shows.
@compute @workgroup_size(CLUSTER)
fn flatten(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let cluster = queues[shown_queue() + group.x];
    let slot = cluster * CLUSTER + lane;
    here[lane] = u32(is_flat(decisions[slot]));
    workgroupBarrier();
    if (lane < 8u) {
        var count = 0u;
        for (var k = 0u; k < 8u; k += 1u) {
            count += here[8u * lane + k];
        }
        eights[lane] = count;
    }
    workgroupBarrier();
    if (here[lane] == 0u) {
        return;
    }
    var before = 0u;
    for (var k = 0u; k < 8u; k += 1u) {
        before += select(0u, eights[k], k < lane / 8u);
        before += select(0u, here[(lane & ~7u) + k], k < (lane & 7u));
    }
    let place = placed[owners[cluster]];
    let p = patch_at(place.base, slot - place.first_slot);
    var corners: vec4<u32>;
    for (var k = 0u; k < 4u; k += 1u) {
        let own = select(0u, k << FLAT_CORNER_SHIFT, frame.flat_indices != FLAT_PLACES);
        let named = select(coarse_place(place, p.corners[k]), slot, frame.flat_indices == FLAT_SLOTS);
        corners[k] = named | own;
    }
    let at = FLAT_INDICES * (atomicLoad(&marks[flat_mark(cluster)]) + before);
    flat_indices[at] = corners.x;
    flat_indices[at + 1u] = corners.y;
    flat_indices[at + 2u] = corners.z;
    flat_indices[at + 3u] = corners.x;
    flat_indices[at + 4u] = corners.z;
    flat_indices[at + 5u] = corners.w;
}
