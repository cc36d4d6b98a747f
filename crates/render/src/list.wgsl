// Lists the patches to be drawn.
//
// Called by refiner.rs for a batch, after note.wgsl: `scan_marks` and `scan_buckets` turn counts into
// places and draw arguments; `flatten` writes the triangles of patches at level 1; `scatter` lists the
// others, bucket by bucket, in their order, so that equal scenes are drawn in equal order.

struct Bucket {
    // First place in the list, and how many.
    start: u32,
    count: u32,
    // Patches per instance of the draw.
    together: u32,
    indices: u32,
    first_index: u32,
}

struct DrawIndexed {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}

@group(2) @binding(0) var<storage, read_write> decisions: array<u32>;
@group(2) @binding(1) var<storage, read_write> list: array<vec2<u32>>;
@group(2) @binding(2) var<storage, read_write> flat_indices: array<u32>;

@group(3) @binding(0) var<storage, read_write> buckets: array<Bucket>;
// That of flat patches, then those of buckets.
@group(3) @binding(1) var<storage, read_write> draws: array<DrawIndexed>;

var<workgroup> sums: array<u32, CLUSTER>;

// Exclusive prefix sums: a workgroup for each bucket's sections, and one for the flat patches of clusters.
@compute @workgroup_size(CLUSTER)
fn scan_marks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let bucket = group.x;
    var first = flat_mark(0u);
    var total = batch.clusters;
    if (bucket < BUCKETS) {
        first = count_mark(bucket, 0u);
        total = batch.sections;
    }
    let share = (total + CLUSTER - 1u) / CLUSTER;
    let start = first + min(lane * share, total);
    let end = first + min((lane + 1u) * share, total);
    var sum = 0u;
    for (var k = start; k < end; k += 1u) {
        sum += atomicLoad(&marks[k]);
    }
    sums[lane] = sum;
    workgroupBarrier();
    var at = 0u;
    var all = 0u;
    for (var k = 0u; k < CLUSTER; k += 1u) {
        at += select(0u, sums[k], k < lane);
        all += sums[k];
    }
    for (var k = start; k < end; k += 1u) {
        let count = atomicLoad(&marks[k]);
        atomicStore(&marks[k], at);
        at += count;
    }
    if (lane == 0u) {
        if (bucket < BUCKETS) {
            buckets[bucket].count = all;
        } else {
            draws[0] = DrawIndexed(FLAT_INDICES * all, min(all, 1u), 0u, 0u, 0u);
        }
    }
}

// Where each bucket begins, and how it is drawn.
@compute @workgroup_size(CLUSTER)
fn scan_buckets(@builtin(local_invocation_index) lane: u32) {
    let share = (BUCKETS + CLUSTER - 1u) / CLUSTER;
    let first = min(lane * share, BUCKETS);
    let end = min(first + share, BUCKETS);
    var sum = 0u;
    for (var b = first; b < end; b += 1u) {
        sum += buckets[b].count;
    }
    sums[lane] = sum;
    workgroupBarrier();
    var at = 0u;
    for (var k = 0u; k < lane; k += 1u) {
        at += sums[k];
    }
    for (var b = first; b < end; b += 1u) {
        let bucket = buckets[b];
        buckets[b].start = at;
        at += bucket.count;
        let instances = (bucket.count + bucket.together - 1u) / bucket.together;
        draws[1u + b] = DrawIndexed(bucket.indices, instances, bucket.first_index, 0u, 0u);
    }
}

var<workgroup> here: array<u32, CLUSTER>;
// Flat patches among eight of a cluster.
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
        // Wires need corners that know which of the patch's they are.
        let own = select(0u, k << FLAT_CORNER_SHIFT, frame.wires != 0u);
        corners[k] = coarse_place(place, p.corners[k]) | own;
    }
    let at = FLAT_INDICES * (atomicLoad(&marks[flat_mark(cluster)]) + before);
    flat_indices[at] = corners.x;
    flat_indices[at + 1u] = corners.y;
    flat_indices[at + 2u] = corners.z;
    flat_indices[at + 3u] = corners.x;
    flat_indices[at + 4u] = corners.z;
    flat_indices[at + 5u] = corners.w;
}

var<workgroup> places: array<atomic<u32>, BUCKETS>;

// Lists a queued section's refined patches, cluster by cluster, each in its bucket.
@compute @workgroup_size(CLUSTER)
fn scatter(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let section = queues[section_queue() + group.x];
    for (var b = lane; b < BUCKETS; b += CLUSTER) {
        atomicStore(&places[b], buckets[b].start + atomicLoad(&marks[count_mark(b, section)]));
    }
    for (var round = 0u; round < SECTION / CLUSTER; round += 1u) {
        let slot = section * SECTION + round * CLUSTER + lane;
        // Of clusters that do not show, decisions are those of an earlier frame.
        var word = 0u;
        if (slot < batch.slots && atomicLoad(&marks[fine_mark(slot / CLUSTER)]) != 0u) {
            word = decisions[slot];
        }
        let fine = word != 0u && !is_flat(word);
        var bucket = BUCKETS;
        if (fine) {
            bucket = bucket_of(word, frame.levels.caps);
        }
        here[lane] = bucket;
        workgroupBarrier();
        var place = 0u;
        if (fine) {
            place = atomicLoad(&places[bucket]);
            for (var k = 0u; k < lane; k += 1u) {
                place += u32(here[k] == bucket);
            }
            list[place] = vec2<u32>(slot, word);
        }
        workgroupBarrier();
        if (fine) {
            atomicMax(&places[bucket], place + 1u);
        }
    }
}
