// What the passes that choose share: placed parts, queues of clusters, and marks.
//
// Called by all that passes.rs lists. Sizes: work.rs.

#import placed.wgsl
#import corner_source.wgsl

@group(1) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(1) var<uniform> batch: Batch;
@group(1) @binding(2) var<storage, read> placed: array<Placed>;
// By cluster of slots: its placed part.
@group(1) @binding(3) var<storage, read_write> owners: array<u32>;
// Four queues of clusters, one of sections.
@group(1) @binding(4) var<storage, read_write> queues: array<u32>;
// Numbers that passes add to: see the functions below.
@group(1) @binding(5) var<storage, read_write> marks: array<atomic<u32>>;

// A queued cluster with the level of all its edges, or 0 where each must be asked.
fn queued(cluster: u32, level: u32) -> u32 {
    return cluster | (level << QUEUED_LEVEL_SHIFT);
}

fn queued_cluster(entry: u32) -> u32 {
    return entry & ((1u << QUEUED_LEVEL_SHIFT) - 1u);
}

fn queued_level(entry: u32) -> u32 {
    return entry >> QUEUED_LEVEL_SHIFT;
}

// Queues of clusters: in which one level holds everywhere; of tubes that must be asked; that show at all;
// whose rings are needed. Then one of points whose patches are asked one by one, and one of sections
// with patches that are refined.
fn plain_queue() -> u32 {
    return 0u;
}

fn asked_queue() -> u32 {
    return batch.clusters;
}

fn shown_queue() -> u32 {
    return 2u * batch.clusters;
}

fn ring_queue() -> u32 {
    return 3u * batch.clusters;
}

fn single_queue() -> u32 {
    return 4u * batch.clusters;
}

fn section_queue() -> u32 {
    return (4u + POINTS_OF_CLUSTER) * batch.clusters;
}

// Lengths of those queues whose entries share a workgroup.
const ASKED_MARK: u32 = 0u;
const RING_MARK: u32 = 1u;
const SINGLE_MARK: u32 = 2u;
const FIRST_MARK: u32 = 3u;

// By cluster: patches that are drawn flat; after the scan how many come before.
fn flat_mark(cluster: u32) -> u32 {
    return FIRST_MARK + cluster;
}

// By cluster: a bit for each of its points whose ring is needed.
fn ring_mark(cluster: u32) -> u32 {
    return FIRST_MARK + batch.clusters + cluster;
}

// By cluster: patches that are refined.
fn fine_mark(cluster: u32) -> u32 {
    return FIRST_MARK + 2u * batch.clusters + cluster;
}

// By section: whether it is queued.
fn section_mark(section: u32) -> u32 {
    return FIRST_MARK + 3u * batch.clusters + section;
}

// By bucket and section: patches; after the scan how many of the bucket come before.
fn count_mark(bucket: u32, section: u32) -> u32 {
    return FIRST_MARK + 3u * batch.clusters + (1u + bucket) * batch.sections + section;
}
