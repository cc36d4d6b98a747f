// Who is drawn, how finely, and in which bucket.
//
// Three passes over a batch: `decide` finds each patch's levels or culls it, and counts; `scan` turns
// counts into places and draw arguments; `scatter` lists the patches of every bucket in their order,
// so that equal scenes are drawn in equal order. CPU twin of the decisions: decide.rs.

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

@group(0) @binding(3) var<storage, read> clusters: array<vec4<f32>>;

@group(1) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(1) var<uniform> batch: Batch;
@group(1) @binding(2) var<storage, read> placed: array<Placed>;
// By cluster of slots: its placed part.
@group(1) @binding(3) var<storage, read_write> owners: array<u32>;
@group(1) @binding(4) var<storage, read_write> decisions: array<u32>;
// By bucket and section of slots; after `scan` the first place in the list.
@group(1) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;

@group(2) @binding(0) var<storage, read_write> list: array<vec2<u32>>;
@group(2) @binding(1) var<storage, read_write> buckets: array<Bucket>;
@group(2) @binding(2) var<storage, read_write> draws: array<DrawIndexed>;

// The placed part that a slot belongs to: the last that begins at or before it.
fn owner_of(slot: u32) -> u32 {
    var low = 0u;
    var high = batch.placed;
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

// Whether a ball shows: within the frustum, and not smaller than what is left out.
fn shows(place: Placed, center: vec3<f32>, radius: f32) -> bool {
    let p = relative(place, center);
    let reach = radius * place.scale;
    for (var k = 0u; k < 5u; k += 1u) {
        // Also where it is not a number.
        if (!(dot(frame.planes[k].xyz, p) + frame.planes[k].w >= -reach)) {
            return false;
        }
    }
    let view = view_of(frame, place);
    let depth = max(dot(view.forward, center - view.eye) - radius, view.near);
    return 2.0 * radius >= frame.smallest * (view.slope * depth + view.flat);
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

// Place of a level in the set of grid sizes: the smallest that holds it.
fn size_class(level: u32) -> u32 {
    for (var k = 0u; k < GRID_SIZES; k += 1u) {
        if (GRID_SIZE[k] >= level) {
            return k;
        }
    }
    return GRID_SIZES - 1u;
}

fn bucket_of(word: u32) -> u32 {
    let kind = decided_kind(word);
    let grid = patch_grid(kind, frame.levels.caps, decided_levels(word));
    let flat = size_class(grid.ny) * GRID_SIZES + size_class(grid.nx);
    return select(flat + GRID_SIZES * GRID_SIZES, flat, kind == PATCH_LATERAL);
}

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
        let cluster = clusters[place.first_cluster + patch_index / CLUSTER];
        if (shows(place, cluster.xyz, cluster.w)) {
            word = decide_patch(place, patch_index);
        }
    }
    decisions[slot] = word;
    if (word != 0u) {
        atomicAdd(&counts[bucket_of(word) * batch.sections + slot / SECTION], 1u);
    }
}

fn decide_patch(place: Placed, patch_index: u32) -> u32 {
    let base = base_of(place);
    let p = patch_at(base, patch_index);
    let ball = patch_ball(base, p);
    if (!shows(place, ball.center, ball.radius)) {
        return 0u;
    }
    var levels = frame.levels;
    if (levels.kind == LEVELS_DISTANCE || levels.kind == LEVELS_MAX_ERROR) {
        levels.amount = levels.amount / place.scale;
    }
    return decision(p.kind, side_levels(base, p, levels, view_of(frame, place)));
}

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
        sum += atomicLoad(&counts[k]);
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
        let count = atomicLoad(&counts[k]);
        atomicStore(&counts[k], at);
        at += count;
    }
    let listed = sums[255];
    storageBarrier();
    for (var b = lane; b < BUCKETS; b += 256u) {
        let start = atomicLoad(&counts[b * batch.sections]);
        var next = listed;
        if (b + 1u < BUCKETS) {
            next = atomicLoad(&counts[(b + 1u) * batch.sections]);
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
        places[b] = atomicLoad(&counts[b * batch.sections + group.x]);
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
            bucket = bucket_of(word);
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
