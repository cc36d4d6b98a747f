// What the passes that select chunks share: their buffers, and sums over a workgroup.
//
// Imported by candidates.wgsl and select.wgsl. Rust twins: layout.rs and passes.rs.

#import budgeted.wgsl

struct Shape {
    center: vec3<f32>,
    reach: f32,
    first_chunk: u32,
    chunks: u32,
    // Number of chunks that are somata, which are the first, and the greatest radius of them.
    somata: u32,
    soma_radius: f32,
    // Number of chunks before those that are twigs up to the last one, and the greatest length of these.
    before_twigs: u32,
    twig_length: f32,
    pad: vec2<u32>,
}

struct Sums {
    // Chunks that are measured.
    chunks: u32,
    visible: u32,
    threshold: u32,
    quads: u32,
    visible_chunks: u32,
    wanted: u32,
    instances: u32,
    // Chunks that are worth less than this bin need not be measured.
    floor: u32,
    // Times that the selection was repeated with a lower floor.
    rounds: u32,
    // 1: until the budget is exceeded above the floor, or the floor is 0.
    open: u32,
    pad: vec2<u32>,
}

// The part of an instance that is measured: the index of its first chunk in the list, and the number
// of chunks; NOT_IN_VIEW for instances that do not show.
struct Extent {
    first: u32,
    chunks: u32,
}

const NOT_IN_VIEW: u32 = 0xffffffffu;

// 64 chunks of the list, of one instance or several.
struct Measured {
    // The instance of its first chunk.
    instance: u32,
    // The greatest bin of its chunks.
    best: u32,
}

struct VisibleCluster {
    cluster: u32,
    // The instances of its first and its last chunk.
    first_instance: u32,
    last_instance: u32,
    // Counts; after sum_visible, indices of the first.
    quads: u32,
    visible_chunks: u32,
}

struct Arguments {
    clusters: array<u32, 3>,
    visible: array<u32, 3>,
    // Two indexed draws: full blocks of quads, and the rest.
    draws: array<u32, 10>,
    // Of cull_instances, if it is repeated.
    again: array<u32, 3>,
}

struct Book {
    sums: Sums,
    // By instance.
    extents: array<Extent>,
}

@group(0) @binding(2) var<storage, read> shapes: array<Shape>;
@group(0) @binding(4) var<storage, read_write> book: Book;
@group(0) @binding(6) var<storage, read_write> arguments: Arguments;
// By cluster.
@group(0) @binding(7) var<storage, read_write> measured: array<Measured>;
// By bin: number of quads.
@group(0) @binding(8) var<storage, read_write> histogram: array<atomic<u32>>;
@group(0) @binding(9) var<storage, read_write> visible: array<VisibleCluster>;
@group(0) @binding(10) var<storage, read_write> visible_chunks: array<VisibleChunk>;
// Number of quads, then the index of each quad's visible chunk.
@group(0) @binding(11) var<storage, read_write> quads: array<u32>;

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
