// Makes coarse vertices: the corners of all rings that are needed, and the loose vertices of all placed
// parts.
//
// Called by refiner.rs for a batch, after note.wgsl: a lane for each point of queued clusters, and
// one for each loose vertex.

@group(2) @binding(0) var<storage, read_write> coarse: array<CoarseVertex>;

@compute @workgroup_size(CLUSTER)
fn make_rings(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let k = CLUSTERS_OF_GROUP * group.x + lane / POINTS_OF_CLUSTER;
    if (k >= atomicLoad(&marks[RING_MARK])) {
        return;
    }
    let cluster = queues[ring_queue() + k];
    let here = lane % POINTS_OF_CLUSTER;
    if ((atomicLoad(&marks[ring_mark(cluster)]) & (1u << here)) == 0u) {
        return;
    }
    let slot = cluster * CLUSTER + 4u * here;
    let part = placed[owners[cluster]];
    let point = (slot - part.first_slot) / 4u;
    let words = point_words(part.base, point);
    if ((words.y >> POINT_KIND_SHIFT) == POINT_LOOSE) {
        return;
    }
    let ring = own_ring(part.base, point, words);
    let word = tube_word(part.base, words);
    for (var corner = 0u; corner < 4u; corner += 1u) {
        coarse[slot + corner] = coarse_vertex_of(part, ring_corner(ring, corner), word);
    }
}

@compute @workgroup_size(CLUSTER)
fn make_loose(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= batch.loose) {
        return;
    }
    let at = batch.slots + id.x;
    let part = placed[loose_owner_of(at)];
    let vertex = (at - part.first_loose) | LOOSE;
    let v = loose_corner(part.base, vertex);
    coarse[at] = coarse_vertex_of(part, v, word_of(part.base, vertex));
}

// The placed part that a loose vertex belongs to.
fn loose_owner_of(at: u32) -> u32 {
    var low = batch.first;
    var high = batch.first + batch.placed;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        if (placed[middle].first_loose <= at) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

fn coarse_vertex_of(part: Placed, v: Corner, word: u32) -> CoarseVertex {
    let position = relative(part, v.position);
    let normal = pack_direction(turned(part, v.normal));
    if (v.role == ROLE_SOMA) {
        // Somata are never widened.
        return CoarseVertex(
            position.x, position.y, position.z, 0.0, normal, normal, word, part.instance);
    }
    return CoarseVertex(
        position.x,
        position.y,
        position.z,
        v.radius * part.scale,
        normal,
        pack_direction(turned(part, v.radial)),
        word,
        part.instance,
    );
}
