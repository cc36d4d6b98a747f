// Finds the clusters that show, and those in which one level holds everywhere: most of what is far
// away.
//
// Called by refiner.rs for a batch, before all other passes. A cluster that does not show costs
// nothing after this.

#import clusters.wgsl
#import shown.wgsl

// Workgroups of the passes that take queues of clusters, and of the one that takes single patches:
// three u32s each.
@group(2) @binding(0) var<storage, read_write> cluster_dispatches: array<atomic<u32>>;
@group(2) @binding(1) var<storage, read_write> single_dispatch: array<atomic<u32>>;

// The placed part that a slot belongs to: the last that begins at or before it.
fn owner_of(slot: u32) -> u32 {
    var low = batch.first;
    var high = batch.first + batch.placed;
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

@compute @workgroup_size(CLUSTER)
fn classify(@builtin(global_invocation_id) id: vec3<u32>) {
    let cluster = id.x;
    if (cluster >= batch.clusters) {
        return;
    }
    let slot = cluster * CLUSTER;
    let owner = owner_of(slot);
    owners[cluster] = owner;
    let place = placed[owner];
    let first = slot - place.first_slot;
    if (first >= place.patches) {
        return;
    }
    let at = place.base.spheres + SPHERE_U32S * (first / PATCHES_OF_SPHERE);
    let center = vec3<f32>(
        bitcast<f32>(packed[at]),
        bitcast<f32>(packed[at + 1u]),
        bitcast<f32>(packed[at + 2u]),
    );
    let radius = bitcast<f32>(packed[at + 3u]);
    let shows = shown(place, center, radius);
    if (shows == SHOWS_NOTHING) {
        return;
    }
    queues[shown_queue() + atomicAdd(&cluster_dispatches[3u * QUEUE_SHOWN], 1u)] = cluster;
    if (first >= 4u * place.base.point_count) {
        queue_singles(cluster);
        return;
    }
    let bend = bitcast<f32>(packed[at + 4u]);
    let level = sphere_level(levels_of(place), view_of(frame, place), center, radius, bend);
    if (shows == SHOWS_ALL && level != 0u) {
        let k = atomicAdd(&cluster_dispatches[3u * QUEUE_PLAIN], 1u);
        queues[plain_queue() + k] = queued(cluster, level);
    } else {
        let k = atomicAdd(&marks[ASKED_MARK], 1u);
        queues[asked_queue() + k] = cluster;
        if (k % CLUSTERS_OF_GROUP == 0u) {
            atomicAdd(&cluster_dispatches[3u * QUEUE_ASKED], 1u);
        }
    }
}

// Queues patches that are not around a path: those of somata, joints and caps.
fn queue_singles(cluster: u32) {
    let k = atomicAdd(&marks[SINGLE_MARK], POINTS_OF_CLUSTER);
    for (var point = 0u; point < POINTS_OF_CLUSTER; point += 1u) {
        queues[single_queue() + k + point] = POINTS_OF_CLUSTER * cluster + point;
        if ((k + point) % POINTS_OF_CLUSTER == 0u) {
            atomicAdd(&single_dispatch[0], 1u);
        }
    }
}
