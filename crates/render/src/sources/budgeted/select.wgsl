// Selects what exploration mode draws, and how finely, within a budget. Nothing is read back. Passes:
//
// cull_instances  for each instance that may show, how many of its chunks may be worth the floor
// sum_chunks      lists these chunks, in clusters of 64
// measure         for each of these chunks, the steps that it requests, summed into a histogram of
//                 quads by worth
// limit           the least worth that is within the budget, and the clusters that have anything
//                 above it
// count           the quads and visible chunks of each of those clusters
// sum_visible     where those of each cluster begin; arguments of the draws
// write           the list of quads, in the order of instances and chunks, so that equal frames are
//                 drawn equally
//
// The floor is a guess at the least worth, somewhat below that of the frame before. If the budget
// is not exceeded above it, the first four passes are repeated with lower floors, the last of them
// 0: so what is drawn depends on the camera alone, and only what it costs on the guess. Chunks of a
// template are sorted by their worth at equal distance, so an instance's share of the work is a
// search in that list.
//
// Called by passes.rs.

#import candidates.wgsl

// The last instance that a cluster has chunks of, or a later one.
fn last_instance(cluster: u32) -> u32 {
    if ((cluster + 1u) * CLUSTER < book.sums.chunks) {
        return measured[cluster + 1u].instance;
    }
    return eye.instances - 1u;
}

// The chunk of a lane, and the steps that it requests.
struct LodRequest {
    instance: u32,
    chunk: u32,
    offers: Offers,
}

fn no_request() -> LodRequest {
    return LodRequest(0u, 0u, no_offers());
}

// `first` and `last`: between them is the chunk's instance.
fn lod_request(cluster: u32, lane: u32, first: u32, last: u32) -> LodRequest {
    let at = cluster * CLUSTER + lane;
    if (at >= book.sums.chunks) {
        return no_request();
    }
    // The last instance that begins at or before it. Those without chunks begin where the next one
    // does.
    var low = first;
    var high = last + 1u;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (book.extents[middle].first <= at) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let place = gpu_instances[low];
    let chunk = shapes[place.shape].first_chunk + at - book.extents[low].first;
    return LodRequest(low, chunk, offers(low, place, chunk));
}

var<workgroup> greatest: atomic<u32>;

@compute @workgroup_size(CLUSTER)
fn measure(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cluster = group.y * ROW + group.x;
    let there = cluster * CLUSTER < book.sums.chunks;
    if (there) {
        let first = measured[cluster].instance;
        let offers = lod_request(cluster, lane, first, last_instance(cluster)).offers;
        for (var k = 0u; k < 4u; k += 1u) {
            if (offers.quads[k] > 0u) {
                atomicAdd(&histogram[offers.bins[k]], offers.quads[k]);
            }
        }
        atomicMax(&greatest, offers.bins.x);
    }
    workgroupBarrier();
    if (there && lane == 0u) {
        measured[cluster].best = atomicLoad(&greatest);
    }
}

var<workgroup> least: atomic<u32>;

// By how many bins the floor is below the least worth of the frame before, and by how many octaves
// it falls from round to round.
const FLOOR_MARGIN: u32 = u32(0.25 * BINS_OF_OCTAVE);
const FLOOR_FALLS = array<f32, 3>(1.0, 4.0, 10.0);

fn below(bin: u32, bins: u32) -> u32 {
    return bin - min(bin, bins);
}

@compute @workgroup_size(WIDE)
fn limit(@builtin(local_invocation_index) lane: u32) {
    let open = book.sums.open == 1u;
    let floor = book.sums.floor;
    let rounds = book.sums.rounds;
    // Sums from the greatest bin down, several bins a lane.
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
    // Bins below the floor hold only part of what is requested.
    let complete = floor <= 1u || threshold > floor;
    let all = (book.sums.chunks + CLUSTER - 1u) / CLUSTER;
    let clusters = select(0u, all, open && complete);
    let share = (clusters + WIDE - 1u) / WIDE;
    let first = min(lane * share, clusters);
    let end = min(first + share, clusters);
    var count = 0u;
    for (var i = first; i < end; i += 1u) {
        count += u32(measured[i].best >= threshold);
    }
    var at = sum_before(lane, count);
    let total = min(parts[WIDE - 1u], arrayLength(&visible));
    for (var i = first; i < end; i += 1u) {
        if (measured[i].best >= threshold) {
            if (at < total) {
                visible[at].cluster = i;
                visible[at].first_instance = measured[i].instance;
                visible[at].last_instance = last_instance(i);
            }
            at += 1u;
        }
    }
    if (!open) {
        return;
    }
    if (!complete) {
        for (var k = 0u; k < each; k += 1u) {
            atomicStore(&histogram[lane * each + k], 0u);
        }
    }
    if (lane > 0u) {
        return;
    }
    // Nothing is measured anew unless cull_instances is.
    arguments.clusters = dispatch_of(0u);
    if (complete) {
        book.sums.visible = total;
        book.sums.threshold = threshold;
        book.sums.wanted = wanted;
        book.sums.floor = below(threshold, FLOOR_MARGIN);
        book.sums.rounds = 0u;
        book.sums.open = 0u;
        arguments.visible = dispatch_of(total);
        arguments.again = dispatch_of(0u);
    } else {
        book.sums.floor = 0u;
        if (rounds < 3u) {
            book.sums.floor = below(floor, u32(FLOOR_FALLS[rounds] * BINS_OF_OCTAVE));
        }
        book.sums.rounds = rounds + 1u;
        arguments.again = dispatch_of((eye.instances + WIDE - 1u) / WIDE);
    }
}

// What the bits of a width hold.
const MAX_DOT_WIDTH: f32 = 1000.0;

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
        var width = offers.width;
        if (threshold > 1u) {
            let over = f32(offers.bins.x - threshold) + 1.0;
            width *= clamp(over / (0.5 * BINS_OF_OCTAVE), 0.1, 1.0);
        }
        it.lod |= u32(width * f32(FULL_WIDTH)) << LOD_WIDTH_SHIFT;
    } else if (lod_what(it.lod) == WHAT_DOT) {
        let least = select(0.0, worth_of(threshold), threshold > 1u);
        let width = min(dot_width(offers.width, least), MAX_DOT_WIDTH);
        it.lod |= u32(width * f32(FULL_WIDTH)) << LOD_WIDTH_SHIFT;
    }
    return it;
}

// What a lane of a visible cluster requests.
fn requested(at: u32, lane: u32) -> LodRequest {
    let it = visible[at];
    return lod_request(it.cluster, lane, it.first_instance, it.last_instance);
}

var<workgroup> quad_count: atomic<u32>;
var<workgroup> visible_chunk_count: atomic<u32>;

@compute @workgroup_size(CLUSTER)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let at = group.y * ROW + group.x;
    let there = at < book.sums.visible;
    if (there) {
        let it = drawn(requested(at, lane).offers);
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
    var ask = no_request();
    var it = Drawn(0u, 0u);
    if (there) {
        ask = requested(at, lane);
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
