// Turns counts into offsets and draw arguments.
//
// Called by refiner.rs for a batch, after note.wgsl: `scan_marks`, then `scan_buckets`.

#import clusters.wgsl

struct Bucket {
    // First index in the list, and number of patches.
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

@group(2) @binding(0) var<storage, read_write> buckets: array<Bucket>;
// The draw of flat patches, then those of the buckets.
@group(2) @binding(1) var<storage, read_write> draws: array<DrawIndexed>;

var<workgroup> sums: array<u32, CLUSTER>;

// Exclusive prefix sums: a workgroup for each bucket's sections, and one for the flat patches of
// clusters.
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
