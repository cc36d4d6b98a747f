// Selects what exploration mode draws, and how finely, within a budget. Seven passes, and nothing
// is read back:
//
// cull_instances  for each instance that may show, its number of clusters of 64 chunks
// sum_clusters    where the clusters of each instance begin
// measure         for each chunk, the steps that it requests, summed into a histogram of quads by
// worth limit           the least worth that is within the budget, and the clusters that have
// anything above it count           the quads and visible chunks of each of those clusters
// sum_visible     where those of each cluster begin; arguments of the draws write           the
// list of quads, in the order of instances and chunks, so that equal frames are
//                 drawn equally
//
// Called by passes.rs.

#import budgeted.wgsl

struct Shape {
    center: vec3<f32>,
    reach: f32,
    first_chunk: u32,
    chunks: u32,
    pad: vec2<u32>,
}

struct Sums {
    clusters: u32,
    visible: u32,
    threshold: u32,
    quads: u32,
    visible_chunks: u32,
    wanted: u32,
    instances: u32,
    pad: u32,
}

struct VisibleCluster {
    cluster: u32,
    // Counts; after sum_visible, indices of the first.
    quads: u32,
    visible_chunks: u32,
}

struct Arguments {
    clusters: array<u32, 3>,
    visible: array<u32, 3>,
    // Two indexed draws: full blocks of quads, and the rest.
    draws: array<u32, 10>,
}

struct Book {
    sums: Sums,
    // By instance: its number of clusters; after sum_clusters, the index of its first.
    starts: array<u32>,
}

@group(0) @binding(2) var<storage, read> shapes: array<Shape>;
@group(0) @binding(4) var<storage, read_write> book: Book;
@group(0) @binding(6) var<storage, read_write> arguments: Arguments;
// By cluster: the greatest bin of its chunks.
@group(0) @binding(7) var<storage, read_write> best: array<u32>;
// By bin: number of quads.
@group(0) @binding(8) var<storage, read_write> histogram: array<atomic<u32>>;
@group(0) @binding(9) var<storage, read_write> visible: array<VisibleCluster>;
@group(0) @binding(10) var<storage, read_write> visible_chunks: array<VisibleChunk>;
// Number of quads, then the index of each quad's visible chunk.
@group(0) @binding(11) var<storage, read_write> quads: array<u32>;

@compute @workgroup_size(WIDE)
fn cull_instances(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let instance = (group.y * ROW + group.x) * WIDE + lane;
    if (instance >= eye.instances) {
        return;
    }
    let place = gpu_instances[instance];
    let shape = shapes[place.shape];
    var count = 0u;
    if ((place.flags & HIDDEN) == 0u && shape.chunks > 0u
        && in_sight(relative(place, shape.center), shape.reach * place.scale)) {
        count = (shape.chunks + CLUSTER - 1u) / CLUSTER;
    }
    book.starts[instance] = count;
}

var<workgroup> parts: array<u32, WIDE>;

// Sum of the values of all lanes before this one.
fn sum_before(lane: u32, value: u32) -> u32 {
    parts[lane] = value;
    workgroupBarrier();
    for (var stride = 1u; stride < WIDE; stride *= 2u) {
        var before = 0u;
        if (lane >= stride) {
            before = parts[lane - stride];
        }
        workgroupBarrier();
        parts[lane] += before;
        workgroupBarrier();
    }
    return parts[lane] - value;
}

fn dispatch_of(groups: u32) -> array<u32, 3> {
    let rows = (groups + ROW - 1u) / ROW;
    return array<u32, 3>(min(groups, ROW), rows, min(groups, 1u));
}

@compute @workgroup_size(WIDE)
fn sum_clusters(@builtin(local_invocation_index) lane: u32) {
    let share = (eye.instances + WIDE - 1u) / WIDE;
    let first = min(lane * share, eye.instances);
    let end = min(first + share, eye.instances);
    var sum = 0u;
    for (var i = first; i < end; i += 1u) {
        sum += book.starts[i];
    }
    var at = sum_before(lane, sum);
    let total = parts[WIDE - 1u];
    var seen = 0u;
    for (var i = first; i < end; i += 1u) {
        let count = book.starts[i];
        book.starts[i] = at;
        at += count;
        seen += u32(count > 0u);
    }
    workgroupBarrier();
    let before = sum_before(lane, seen);
    if (lane == 0u) {
        book.sums.clusters = total;
        book.sums.instances = parts[WIDE - 1u];
        arguments.clusters = dispatch_of(total);
    }
}

// The instance that a cluster belongs to: the last that begins at or before it.
fn owner_of(cluster: u32) -> u32 {
    var low = 0u;
    var high = eye.instances;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (book.starts[middle] <= cluster) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The chunk of a lane, and the steps that it requests.
struct LodRequest {
    instance: u32,
    chunk: u32,
    offers: Offers,
}

fn lod_requests(cluster: u32, lane: u32) -> LodRequest {
    let instance = owner_of(cluster);
    let place = gpu_instances[instance];
    let shape = shapes[place.shape];
    let index = (cluster - book.starts[instance]) * CLUSTER + lane;
    if (index >= shape.chunks) {
        return LodRequest(instance, 0u, no_offers());
    }
    let chunk = shape.first_chunk + index;
    return LodRequest(instance, chunk, offers(instance, place, chunk));
}

var<workgroup> greatest: atomic<u32>;

@compute @workgroup_size(CLUSTER)
fn measure(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cluster = group.y * ROW + group.x;
    let there = cluster < book.sums.clusters;
    if (there) {
        let offers = lod_requests(cluster, lane).offers;
        for (var k = 0u; k < 4u; k += 1u) {
            if (offers.quads[k] > 0u) {
                atomicAdd(&histogram[offers.bins[k]], offers.quads[k]);
            }
        }
        atomicMax(&greatest, offers.bins.x);
    }
    workgroupBarrier();
    if (there && lane == 0u) {
        best[cluster] = atomicLoad(&greatest);
    }
}

var<workgroup> least: atomic<u32>;

@compute @workgroup_size(WIDE)
fn limit(@builtin(local_invocation_index) lane: u32) {
    // Sums from the greatest bin down: four bins a lane.
    let each = BINS / WIDE;
    var sum = 0u;
    for (var k = 0u; k < each; k += 1u) {
        sum += atomicLoad(&histogram[BINS - 1u - lane * each - k]);
    }
    var above = sum_before(lane, sum);
    let wanted = parts[WIDE - 1u];
    // The first bin that exceeds the budget: only those above it are drawn.
    for (var k = 0u; k < each; k += 1u) {
        let bin = BINS - 1u - lane * each - k;
        above += atomicLoad(&histogram[bin]);
        if (above > eye.budget) {
            atomicMax(&least, bin + 1u);
            break;
        }
    }
    workgroupBarrier();
    let threshold = max(atomicLoad(&least), 1u);
    let share = (book.sums.clusters + WIDE - 1u) / WIDE;
    let first = min(lane * share, book.sums.clusters);
    let end = min(first + share, book.sums.clusters);
    var count = 0u;
    for (var i = first; i < end; i += 1u) {
        count += u32(best[i] >= threshold);
    }
    var at = sum_before(lane, count);
    let total = min(parts[WIDE - 1u], arrayLength(&visible));
    for (var i = first; i < end; i += 1u) {
        if (best[i] >= threshold) {
            if (at < total) {
                visible[at].cluster = i;
            }
            at += 1u;
        }
    }
    if (lane == 0u) {
        book.sums.visible = total;
        book.sums.threshold = threshold;
        book.sums.wanted = wanted;
        arguments.visible = dispatch_of(total);
    }
}

// How a chunk is drawn: the last of its steps that is within the budget.
struct Drawn {
    quads: u32,
    lod: u32,
}

fn drawn(offers: Offers) -> Drawn {
    var it = Drawn(0u, 0u);
    let threshold = book.sums.threshold;
    for (var k = 0u; k < 4u; k += 1u) {
        if (offers.quads[k] > 0u && offers.bins[k] >= threshold) {
            it = Drawn(it.quads + offers.quads[k], offers.lods[k]);
        }
    }
    if (lod_what(it.lod) == WHAT_TUBE) {
        // A chunk that is only just within the budget is drawn with part of its width, so that it
        // fades in and out.
        var width = FULL_WIDTH;
        if (threshold > 1u) {
            let over = f32(offers.bins.x - threshold) + 1.0;
            width = u32(clamp(over / (0.5 * BINS_OF_OCTAVE), 0.1, 1.0) * f32(FULL_WIDTH));
        }
        it.lod |= width << LOD_WIDTH_SHIFT;
    }
    return it;
}

var<workgroup> quad_count: atomic<u32>;
var<workgroup> visible_chunk_count: atomic<u32>;

@compute @workgroup_size(CLUSTER)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let at = group.y * ROW + group.x;
    let there = at < book.sums.visible;
    if (there) {
        let it = drawn(lod_requests(visible[at].cluster, lane).offers);
        if (it.quads > 0u) {
            atomicAdd(&quad_count, it.quads);
            atomicAdd(&visible_chunk_count, 1u);
        }
    }
    workgroupBarrier();
    if (there && lane == 0u) {
        visible[at].quads = atomicLoad(&quad_count);
        visible[at].visible_chunks = atomicLoad(&visible_chunk_count);
    }
}

@compute @workgroup_size(WIDE)
fn sum_visible(@builtin(local_invocation_index) lane: u32) {
    let share = (book.sums.visible + WIDE - 1u) / WIDE;
    let first = min(lane * share, book.sums.visible);
    let end = min(first + share, book.sums.visible);
    var quad_sum = 0u;
    var visible_chunk_sum = 0u;
    for (var i = first; i < end; i += 1u) {
        quad_sum += visible[i].quads;
        visible_chunk_sum += visible[i].visible_chunks;
    }
    var quad_at = sum_before(lane, quad_sum);
    let all_quads = parts[WIDE - 1u];
    workgroupBarrier();
    var visible_chunk_at = sum_before(lane, visible_chunk_sum);
    let all_visible_chunks = parts[WIDE - 1u];
    for (var i = first; i < end; i += 1u) {
        let quads_here = visible[i].quads;
        let visible_chunks_here = visible[i].visible_chunks;
        visible[i].quads = quad_at;
        visible[i].visible_chunks = visible_chunk_at;
        quad_at += quads_here;
        visible_chunk_at += visible_chunks_here;
    }
    if (lane == 0u) {
        // Two compilations of an expression may round differently, so the counts of two passes may
        // differ: here they are limited to what there is room for.
        let most = min(min(all_quads, eye.budget), arrayLength(&quads) - 1u);
        book.sums.quads = most;
        book.sums.visible_chunks = min(all_visible_chunks, arrayLength(&visible_chunks));
        quads[0] = most;
        let indices = 6u * BLOCK;
        arguments.draws = array<u32, 10>(
            indices, most / BLOCK, 0u, 0u, 0u,
            6u * (most % BLOCK), 1u, indices, 0u, 0u,
        );
    }
}

var<workgroup> counts: array<u32, CLUSTER>;
// Sums up to and including each lane.
var<workgroup> quads_before: array<u32, CLUSTER>;
var<workgroup> visible_chunks_before: array<u32, CLUSTER>;

@compute @workgroup_size(CLUSTER)
fn write(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let at = group.y * ROW + group.x;
    let there = at < book.sums.visible;
    var ask = LodRequest(0u, 0u, no_offers());
    var it = Drawn(0u, 0u);
    if (there) {
        ask = lod_requests(visible[at].cluster, lane);
        it = drawn(ask.offers);
    }
    // Inclusive sums, computed by each lane for itself: this takes two barriers instead of twelve,
    // which are slow in software rendering.
    counts[lane] = it.quads;
    workgroupBarrier();
    var sum = 0u;
    var visible_chunk_sum = 0u;
    for (var k = 0u; k <= lane; k += 1u) {
        sum += counts[k];
        visible_chunk_sum += u32(counts[k] > 0u);
    }
    quads_before[lane] = sum;
    visible_chunks_before[lane] = visible_chunk_sum;
    workgroupBarrier();
    if (!there) {
        return;
    }
    let first_quad = visible[at].quads;
    let first_visible_chunk = visible[at].visible_chunks;
    if (it.quads > 0u) {
        let visible_chunk = first_visible_chunk + visible_chunk_sum - 1u;
        if (visible_chunk < arrayLength(&visible_chunks)) {
            let first = first_quad + sum - it.quads;
            visible_chunks[visible_chunk] = VisibleChunk(ask.instance, ask.chunk, it.lod, first);
        }
    }
    // All lanes together write the list of the cluster's quads.
    let total = quads_before[CLUSTER - 1u];
    for (var k = lane; k < total; k += CLUSTER) {
        var low = 0u;
        var high = CLUSTER - 1u;
        while (low < high) {
            let middle = (low + high) / 2u;
            if (quads_before[middle] > k) {
                high = middle;
            } else {
                low = middle + 1u;
            }
        }
        let place = first_quad + k;
        if (place < book.sums.quads) {
            quads[place + 1u] = first_visible_chunk + visible_chunks_before[low] - 1u;
        }
    }
}
