// What the compute passes share: placed parts, queues and marks.
//
// Imported by all shaders of passes.rs. The sizes of the buffers are in work.rs.

#import placed.wgsl
#import corner_source.wgsl

@group(1) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(1) var<uniform> batch: Batch;
@group(1) @binding(2) var<storage, read> placed: array<Placed>;
// By cluster of slots: index of its placed part.
@group(1) @binding(3) var<storage, read_write> owners: array<u32>;
// All queues, one after the other: see the functions below.
@group(1) @binding(4) var<storage, read_write> queues: array<u32>;
// Counters that passes add to: see the functions below.
@group(1) @binding(5) var<storage, read_write> marks: array<atomic<u32>>;

// A queued cluster with the level of all its edges.
fn queued(cluster: u32, level: u32) -> u32 {
    return cluster | (level << QUEUED_LEVEL_SHIFT);
}

fn queued_cluster(entry: u32) -> u32 {
    return entry & ((1u << QUEUED_LEVEL_SHIFT) - 1u);
}

fn queued_level(entry: u32) -> u32 {
    return entry >> QUEUED_LEVEL_SHIFT;
}

// Where each queue begins. Four are of clusters: those in which one level holds everywhere (plain);
// those with tubes that must be decided one by one (asked); all that show; those whose rings are
// needed. Then one of points, whose four patches are decided one by one (single), and one of
// sections with patches that are refined.
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

// Marks that count the entries of queues of which a workgroup takes several at once.
const ASKED_MARK: u32 = 0u;
const RING_MARK: u32 = 1u;
const SINGLE_MARK: u32 = 2u;
const FIRST_MARK: u32 = 3u;

// By cluster: number of patches that are drawn flat; after the scan, how many come before.
fn flat_mark(cluster: u32) -> u32 {
    return FIRST_MARK + cluster;
}

// By cluster: a bit for each of its points whose ring is needed.
fn ring_mark(cluster: u32) -> u32 {
    return FIRST_MARK + batch.clusters + cluster;
}

// By cluster: number of patches that are refined.
fn fine_mark(cluster: u32) -> u32 {
    return FIRST_MARK + 2u * batch.clusters + cluster;
}

// By section: whether it is queued.
fn section_mark(section: u32) -> u32 {
    return FIRST_MARK + 3u * batch.clusters + section;
}

// By bucket and section: number of patches; after the scan, how many of the bucket come before.
fn count_mark(bucket: u32, section: u32) -> u32 {
    return FIRST_MARK + 3u * batch.clusters + (1u + bucket) * batch.sections + section;
}
