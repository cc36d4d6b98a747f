// The first two of the passes of select.wgsl: which chunks may be worth the floor, and so are measured.

#import selection.wgsl

// How many of an instance's chunks may be worth the floor: the first ones, since chunks are sorted
// by what they carry. `nearest`: size (µm) of a pixel at the instance's nearest point.
fn chunks_above_floor(shape: Shape, nearest: f32, instance: u32) -> u32 {
    // Twigs that are left out at the instance's nearest point are left out everywhere.
    let tiny = shape.twig_length < 0.99 * TWIG_FADES_FROM * nearest;
    let most = select(shape.chunks, shape.before_twigs, tiny);
    let floor = book.sums.floor;
    if (floor <= 1u) {
        return most;
    }
    // A little less, since two compilations of an expression may round differently.
    let carried = 0.99 * worth_of(floor) * nearest * sqrt(nearest) / (2.0 * MAX_CHANCE);
    var low = shape.somata;
    var high = max(most, low);
    while (low < high) {
        let middle = (low + high) / 2u;
        if (chunks[shape.first_chunk + middle].carried >= carried) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    let side = 1.7725 * shape.soma_radius / nearest;
    if (low == shape.somata && 1.01 * soma_worth(1.01 * side, instance) < worth_of(floor)) {
        return 0u;
    }
    return low;
}

@compute @workgroup_size(WIDE)
fn cull_instances(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let instance = (group.y * ROW + group.x) * WIDE + lane;
    if (instance == 0u) {
        book.sums.open = 1u;
    }
    if (instance >= eye.instances) {
        return;
    }
    let place = gpu_instances[instance];
    let shape = shapes[place.shape];
    var count = NOT_IN_VIEW;
    if ((place.flags & HIDDEN) == 0u && shape.chunks > 0u) {
        let center = relative(place, shape.center);
        let reach = shape.reach * place.scale;
        if (in_sight(center, reach)) {
            let depth = max(dot(eye.forward, center) - reach, eye.near);
            count = chunks_above_floor(shape, pixel_at(depth) / place.scale, instance);
        }
    }
    book.extents[instance].chunks = count;
}

fn measured_chunks(extent: Extent) -> u32 {
    return select(extent.chunks, 0u, extent.chunks == NOT_IN_VIEW);
}

@compute @workgroup_size(WIDE)
fn sum_chunks(@builtin(local_invocation_index) lane: u32) {
    let open = book.sums.open == 1u;
    let instances = select(0u, eye.instances, open);
    let share = (instances + WIDE - 1u) / WIDE;
    let first = min(lane * share, instances);
    let end = min(first + share, instances);
    var sum = 0u;
    for (var i = first; i < end; i += 1u) {
        sum += measured_chunks(book.extents[i]);
    }
    var at = sum_before(lane, sum);
    let total = parts[WIDE - 1u];
    var seen = 0u;
    for (var i = first; i < end; i += 1u) {
        let extent = book.extents[i];
        let next = at + measured_chunks(extent);
        book.extents[i].first = at;
        // The clusters that begin in this instance.
        for (var k = (at + CLUSTER - 1u) / CLUSTER; k * CLUSTER < next; k += 1u) {
            measured[k].instance = i;
        }
        at = next;
        seen += u32(extent.chunks != NOT_IN_VIEW);
    }
    workgroupBarrier();
    let before = sum_before(lane, seen);
    if (lane == 0u && open) {
        book.sums.chunks = total;
        book.sums.instances = parts[WIDE - 1u];
        arguments.clusters = dispatch_of((total + CLUSTER - 1u) / CLUSTER);
    }
}
