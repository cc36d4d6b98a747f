// Who is drawn in exploration, and how well, within a budget: seven passes, none of which is read back.
//
// stand       by instance: chunks of 64 runs of those that may show
// sum_chunks  where the chunks of each instance begin
// measure     by run: what it asks for, as a histogram of quads by worth
// limit       the least worth that is within the budget, and the chunks that have any
// count       by run of those chunks: quads and pieces
// sum_live    where those of each chunk begin; arguments of the draws
// write       the list of quads, in the order of instances and runs: equal frames are equal
//
// Called by passes.rs; comes after explore.wgsl.

struct Shape {
    center: vec3<f32>,
    reach: f32,
    first_run: u32,
    runs: u32,
    pad: vec2<u32>,
}

struct Sums {
    chunks: u32,
    live: u32,
    threshold: u32,
    quads: u32,
    pieces: u32,
    wanted: u32,
    instances: u32,
    pad: u32,
}

struct Live {
    chunk: u32,
    // Counts, then places of the first.
    quads: u32,
    pieces: u32,
}

struct Arguments {
    chunks: array<u32, 3>,
    live: array<u32, 3>,
    // Two indexed draws: full blocks, and the rest.
    draws: array<u32, 10>,
}

struct Book {
    sums: Sums,
    // By instance: chunks, then the place of its first.
    starts: array<u32>,
}

@group(0) @binding(2) var<storage, read> shapes: array<Shape>;
@group(0) @binding(4) var<storage, read_write> book: Book;
@group(0) @binding(6) var<storage, read_write> arguments: Arguments;
// By chunk: the greatest class of its runs.
@group(0) @binding(7) var<storage, read_write> best: array<u32>;
// By class: quads.
@group(0) @binding(8) var<storage, read_write> histogram: array<atomic<u32>>;
@group(0) @binding(9) var<storage, read_write> live: array<Live>;
@group(0) @binding(10) var<storage, read_write> pieces: array<Piece>;
// Number of quads, then the piece of each.
@group(0) @binding(11) var<storage, read_write> quads: array<u32>;

@compute @workgroup_size(WIDE)
fn stand(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let instance = (group.y * ROW + group.x) * WIDE + lane;
    if (instance >= eye.instances) {
        return;
    }
    let place = standing[instance];
    let shape = shapes[place.shape];
    var count = 0u;
    if ((place.flags & HIDDEN) == 0u && shape.runs > 0u
        && in_sight(relative(place, shape.center), shape.reach * place.scale)) {
        count = (shape.runs + CHUNK - 1u) / CHUNK;
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
fn sum_chunks(@builtin(local_invocation_index) lane: u32) {
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
        book.sums.chunks = total;
        book.sums.instances = parts[WIDE - 1u];
        arguments.chunks = dispatch_of(total);
    }
}

// The instance that a chunk belongs to: the last that begins at or before it.
fn owner_of(chunk: u32) -> u32 {
    var low = 0u;
    var high = eye.instances;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (book.starts[middle] <= chunk) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// What the run of a lane asks for.
struct Asked {
    instance: u32,
    run: u32,
    offers: Offers,
}

fn asked(chunk: u32, lane: u32) -> Asked {
    let instance = owner_of(chunk);
    let place = standing[instance];
    let shape = shapes[place.shape];
    let index = (chunk - book.starts[instance]) * CHUNK + lane;
    if (index >= shape.runs) {
        return Asked(instance, 0u, no_offers());
    }
    let run = shape.first_run + index;
    return Asked(instance, run, offers(instance, place, run));
}

var<workgroup> greatest: atomic<u32>;

@compute @workgroup_size(CHUNK)
fn measure(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let chunk = group.y * ROW + group.x;
    let there = chunk < book.sums.chunks;
    if (there) {
        let offers = asked(chunk, lane).offers;
        for (var k = 0u; k < 4u; k += 1u) {
            if (offers.quads[k] > 0u) {
                atomicAdd(&histogram[offers.bins[k]], offers.quads[k]);
            }
        }
        atomicMax(&greatest, offers.bins.x);
    }
    workgroupBarrier();
    if (there && lane == 0u) {
        best[chunk] = atomicLoad(&greatest);
    }
}

var<workgroup> least: atomic<u32>;

@compute @workgroup_size(WIDE)
fn limit(@builtin(local_invocation_index) lane: u32) {
    // Sums from the greatest class down: four classes a lane.
    let each = BINS / WIDE;
    var sum = 0u;
    for (var k = 0u; k < each; k += 1u) {
        sum += atomicLoad(&histogram[BINS - 1u - lane * each - k]);
    }
    var above = sum_before(lane, sum);
    let wanted = parts[WIDE - 1u];
    // The least class so far that is too much: all above it are drawn.
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
    let share = (book.sums.chunks + WIDE - 1u) / WIDE;
    let first = min(lane * share, book.sums.chunks);
    let end = min(first + share, book.sums.chunks);
    var count = 0u;
    for (var i = first; i < end; i += 1u) {
        count += u32(best[i] >= threshold);
    }
    var at = sum_before(lane, count);
    let total = min(parts[WIDE - 1u], arrayLength(&live));
    for (var i = first; i < end; i += 1u) {
        if (best[i] >= threshold) {
            if (at < total) {
                live[at].chunk = i;
            }
            at += 1u;
        }
    }
    if (lane == 0u) {
        book.sums.live = total;
        book.sums.threshold = threshold;
        book.sums.wanted = wanted;
        arguments.live = dispatch_of(total);
    }
}

// How a run is drawn: the last step that is worth it.
struct Drawn {
    quads: u32,
    form: u32,
}

fn drawn(offers: Offers) -> Drawn {
    var it = Drawn(0u, 0u);
    let threshold = book.sums.threshold;
    for (var k = 0u; k < 4u; k += 1u) {
        if (offers.quads[k] > 0u && offers.bins[k] >= threshold) {
            it = Drawn(it.quads + offers.quads[k], offers.forms[k]);
        }
    }
    if ((it.form & 7u) == WHAT_TUBE) {
        // What has hardly found room is drawn with part of its width: it fades in and out.
        var width = 63u;
        if (threshold > 1u) {
            let over = f32(offers.bins.x - threshold) + 1.0;
            width = u32(clamp(over / (0.5 * BINS_OF_OCTAVE), 0.1, 1.0) * 63.0);
        }
        it.form |= width << 16u;
    }
    return it;
}

var<workgroup> quad_count: atomic<u32>;
var<workgroup> piece_count: atomic<u32>;

@compute @workgroup_size(CHUNK)
fn count(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let at = group.y * ROW + group.x;
    let there = at < book.sums.live;
    if (there) {
        let it = drawn(asked(live[at].chunk, lane).offers);
        if (it.quads > 0u) {
            atomicAdd(&quad_count, it.quads);
            atomicAdd(&piece_count, 1u);
        }
    }
    workgroupBarrier();
    if (there && lane == 0u) {
        live[at].quads = atomicLoad(&quad_count);
        live[at].pieces = atomicLoad(&piece_count);
    }
}

@compute @workgroup_size(WIDE)
fn sum_live(@builtin(local_invocation_index) lane: u32) {
    let share = (book.sums.live + WIDE - 1u) / WIDE;
    let first = min(lane * share, book.sums.live);
    let end = min(first + share, book.sums.live);
    var quad_sum = 0u;
    var piece_sum = 0u;
    for (var i = first; i < end; i += 1u) {
        quad_sum += live[i].quads;
        piece_sum += live[i].pieces;
    }
    var quad_at = sum_before(lane, quad_sum);
    let all_quads = parts[WIDE - 1u];
    workgroupBarrier();
    var piece_at = sum_before(lane, piece_sum);
    let all_pieces = parts[WIDE - 1u];
    for (var i = first; i < end; i += 1u) {
        let quads_here = live[i].quads;
        let pieces_here = live[i].pieces;
        live[i].quads = quad_at;
        live[i].pieces = piece_at;
        quad_at += quads_here;
        piece_at += pieces_here;
    }
    if (lane == 0u) {
        // Two compilations of one expression could round differently: whatever they count, no more
        // is drawn than there is room for.
        let most = min(min(all_quads, eye.budget), arrayLength(&quads) - 1u);
        book.sums.quads = most;
        book.sums.pieces = min(all_pieces, arrayLength(&pieces));
        quads[0] = most;
        let indices = 6u * BLOCK;
        arguments.draws = array<u32, 10>(
            indices, most / BLOCK, 0u, 0u, 0u,
            6u * (most % BLOCK), 1u, indices, 0u, 0u,
        );
    }
}

var<workgroup> counts: array<u32, CHUNK>;
// Up to and with each lane.
var<workgroup> quads_before: array<u32, CHUNK>;
var<workgroup> pieces_before: array<u32, CHUNK>;

@compute @workgroup_size(CHUNK)
fn write(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let at = group.y * ROW + group.x;
    let there = at < book.sums.live;
    var ask = Asked(0u, 0u, no_offers());
    var it = Drawn(0u, 0u);
    if (there) {
        ask = asked(live[at].chunk, lane);
        it = drawn(ask.offers);
    }
    // Inclusive sums, by each lane for itself: two barriers instead of twelve, which cost more in software.
    counts[lane] = it.quads;
    workgroupBarrier();
    var sum = 0u;
    var piece_sum = 0u;
    for (var k = 0u; k <= lane; k += 1u) {
        sum += counts[k];
        piece_sum += u32(counts[k] > 0u);
    }
    quads_before[lane] = sum;
    pieces_before[lane] = piece_sum;
    workgroupBarrier();
    if (!there) {
        return;
    }
    let first_quad = live[at].quads;
    let first_piece = live[at].pieces;
    if (it.quads > 0u) {
        let piece = first_piece + piece_sum - 1u;
        if (piece < arrayLength(&pieces)) {
            let first = first_quad + sum - it.quads;
            pieces[piece] = Piece(ask.instance, ask.run, it.form, first);
        }
    }
    // All lanes share the list of the chunk's quads.
    let total = quads_before[CHUNK - 1u];
    for (var k = lane; k < total; k += CHUNK) {
        var low = 0u;
        var high = CHUNK - 1u;
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
            quads[place + 1u] = first_piece + pieces_before[low] - 1u;
        }
    }
}
