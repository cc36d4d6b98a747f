// Lists the patches to be drawn, bucket by bucket.
//
// Called by refiner.rs for a batch, after decide.wgsl: `scan` turns counts into places and draw
// arguments; `scatter` lists the patches of every bucket in their order, so that equal scenes are drawn
// in equal order.

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

@group(0) @binding(4) var<uniform> frame: Frame;
@group(0) @binding(5) var<uniform> batch: Batch;
@group(0) @binding(8) var<storage, read_write> decisions: array<u32>;
// By bucket and section of slots; after `scan` the first place in the list.
@group(0) @binding(9) var<storage, read_write> counts: array<u32>;

@group(1) @binding(0) var<storage, read_write> list: array<vec2<u32>>;
@group(1) @binding(1) var<storage, read_write> buckets: array<Bucket>;
@group(1) @binding(2) var<storage, read_write> draws: array<DrawIndexed>;

var<workgroup> sums: array<u32, 256>;

// Exclusive prefix sum of all counts, by one workgroup.
@compute @workgroup_size(256)
fn scan(@builtin(local_invocation_index) lane: u32) {
    let total = BUCKETS * batch.sections;
    let share = (total + 255u) / 256u;
    let first = min(lane * share, total);
    let end = min(first + share, total);
    var sum = 0u;
    for (var k = first; k < end; k += 1u) {
        sum += counts[k];
    }
    sums[lane] = sum;
    workgroupBarrier();
    for (var stride = 1u; stride < 256u; stride *= 2u) {
        var before = 0u;
        if (lane >= stride) {
            before = sums[lane - stride];
        }
        workgroupBarrier();
        sums[lane] += before;
        workgroupBarrier();
    }
    var at = sums[lane] - sum;
    for (var k = first; k < end; k += 1u) {
        let count = counts[k];
        counts[k] = at;
        at += count;
    }
    let listed = sums[255];
    storageBarrier();
    for (var b = lane; b < BUCKETS; b += 256u) {
        let start = counts[b * batch.sections];
        var next = listed;
        if (b + 1u < BUCKETS) {
            next = counts[(b + 1u) * batch.sections];
        }
        let count = next - start;
        buckets[b].start = start;
        buckets[b].count = count;
        let together = buckets[b].together;
        let instances = (count + together - 1u) / together;
        draws[b] = DrawIndexed(buckets[b].indices, instances, buckets[b].first_index, 0u, 0u);
    }
}

var<workgroup> here: array<u32, CLUSTER>;
var<workgroup> places: array<u32, BUCKETS>;

// Lists a section's patches, cluster by cluster, each in its bucket.
@compute @workgroup_size(CLUSTER)
fn scatter(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    for (var b = lane; b < BUCKETS; b += CLUSTER) {
        places[b] = counts[b * batch.sections + group.x];
    }
    let first = group.x * SECTION;
    for (var round = 0u; round < SECTION / CLUSTER; round += 1u) {
        let slot = first + round * CLUSTER + lane;
        var word = 0u;
        if (slot < batch.slots) {
            word = decisions[slot];
        }
        var bucket = BUCKETS;
        if (word != 0u) {
            bucket = bucket_of(word, frame.levels.caps);
        }
        here[lane] = bucket;
        workgroupBarrier();
        var before = 0u;
        var after = 0u;
        for (var k = 0u; k < CLUSTER; k += 1u) {
            if (here[k] == bucket) {
                before += u32(k < lane);
                after += u32(k > lane);
            }
        }
        var place = 0u;
        if (word != 0u) {
            place = places[bucket] + before;
            list[place] = vec2<u32>(slot, word);
        }
        workgroupBarrier();
        if (word != 0u && after == 0u) {
            places[bucket] = place + 1u;
        }
    }
}
