// Lists the patches that are refined, bucket by bucket, in their order, so that equal scenes are
// drawn in equal order.
//
// Called by refiner.rs for a batch, after scan.wgsl: a workgroup for each queued section.

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

@group(2) @binding(0) var<storage, read_write> decisions: array<u32>;
@group(2) @binding(1) var<storage, read_write> list: array<vec2<u32>>;
@group(2) @binding(2) var<storage, read_write> buckets: array<Bucket>;

var<workgroup> here: array<u32, CLUSTER>;
// The same, with four patches in an entry, 16 bits for each: less to load.
var<workgroup> fours: array<vec2<u32>, POINTS_OF_CLUSTER>;
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
        // Clusters that do not show still have the decisions of an earlier frame.
        var decided = 0u;
        if (slot < batch.slots && atomicLoad(&marks[fine_mark(slot / CLUSTER)]) != 0u) {
            decided = decisions[slot];
        }
        let fine = decided != 0u && !is_flat(decided);
        var bucket = BUCKETS;
        if (fine) {
            bucket = bucket_of(decided, frame.levels.caps);
        }
        here[lane] = bucket;
        workgroupBarrier();
        if (lane < POINTS_OF_CLUSTER) {
            let first = 4u * lane;
            fours[lane] = vec2<u32>(here[first], here[first + 2u])
                | (vec2<u32>(here[first + 1u], here[first + 3u]) << vec2<u32>(16u));
        }
        workgroupBarrier();
        var place = 0u;
        if (fine) {
            place = atomicLoad(&places[bucket]);
            for (var k = 0u; k < lane / 4u; k += 1u) {
                place += count_of(fours[k], bucket);
            }
            for (var k = lane & ~3u; k < lane; k += 1u) {
                place += u32(here[k] == bucket);
            }
            list[place] = vec2<u32>(slot, decided);
        }
        workgroupBarrier();
        if (fine) {
            atomicMax(&places[bucket], place + 1u);
        }
    }
}

// How many of four are in a bucket.
fn count_of(four: vec2<u32>, bucket: u32) -> u32 {
    let low = vec2<u32>((four & vec2<u32>(0xffffu)) == vec2<u32>(bucket));
    let high = vec2<u32>((four >> vec2<u32>(16u)) == vec2<u32>(bucket));
    return low.x + low.y + high.x + high.y;
}
