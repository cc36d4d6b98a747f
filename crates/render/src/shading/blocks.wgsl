// Which blocks of 8 × 8 show anything. Most of a picture of neurons is empty: the passes after this one
// run for these blocks only. Called by finish.rs.
//
// `blocks` has four parts, each with a number for each block of the tile: whether anything shows in it, and for each
// list the numbers from 1 on of its blocks, in any order.

#import finish.wgsl

// For an indirect dispatch of each list: columns, rows, 1, and the number of its blocks.
@group(1) @binding(0) var<storage, read_write> dispatches: array<atomic<u32>>;

// Blocks of sub-pixels of the tile that show anything: what is around a sub-pixel occludes it.
const COVERED: u32 = 0u;
// Those of them that occlusion is asked of.
const OCCLUDED: u32 = 1u;
// Blocks of pixels of what is kept.
const GATHERED: u32 = 2u;

// Workgroups in a row of a dispatch: a large picture has more blocks than a row may have.
const COLUMNS: u32 = 64u;

// Blocks in a row of the tile, and rows.
fn block_counts() -> vec2<u32> {
    return (finish.tile_size + 7u) / 8u;
}

// Where the numbers of a list begin.
fn first_of(list: u32) -> u32 {
    return (list + 1u) * (arrayLength(&blocks) / 4u);
}

fn list_block(list: u32, block: vec2<u32>) {
    let dispatch = 4u * list;
    let place = atomicAdd(&dispatches[dispatch + 3u], 1u);
    blocks[first_of(list) + place] = block.y * block_counts().x + block.x + 1u;
    atomicMax(&dispatches[dispatch], COLUMNS);
    atomicMax(&dispatches[dispatch + 1u], place / COLUMNS + 1u);
    atomicMax(&dispatches[dispatch + 2u], 1u);
}

// Where an invocation is that is dispatched for a list of blocks; beyond everything if the row of
// workgroups is longer than the list.
fn within_block(list: u32, workgroup: vec3<u32>, local: vec3<u32>) -> vec2<u32> {
    let place = workgroup.y * COLUMNS + workgroup.x;
    if place >= arrayLength(&blocks) / 4u {
        return vec2(0xffffffu);
    }
    let named = blocks[first_of(list) + place];
    if named == 0u {
        return vec2(0xffffffu);
    }
    let number = named - 1u;
    let across = block_counts().x;
    return vec2(number % across, number / across) * 8u + local.xy;
}

// An invocation for each block of sub-pixels. In software, invocations for each sub-pixel took as long as all the
// rest, since there those that have nothing to do take as long as the others.
@compute @workgroup_size(8, 8)
fn find_blocks(@builtin(global_invocation_id) id: vec3<u32>) {
    let block = id.xy;
    if any(block >= block_counts()) {
        return;
    }
    let first = block * 8u;
    var covered = false;
    for (var k = 0u; k < 64u && !covered; k++) {
        let p = min(first + vec2(k & 7u, k >> 3u), finish.tile_size - 1u);
        covered = textureLoad(colors, vec2<i32>(p), 0).a > 0.0;
    }
    if !covered {
        return;
    }
    blocks[block.y * block_counts().x + block.x] = 1u;
    if finish.radius == 0.0 {
        return;
    }
    list_block(COVERED, block);
    // The blur reads occlusion around what is kept.
    let from_kept = vec2<i32>(first) - vec2<i32>(finish.inset);
    let kept = vec2<i32>(finish.kept * finish.scale);
    if all(from_kept + 7 >= vec2(-BLUR)) && all(from_kept < kept + BLUR) {
        list_block(OCCLUDED, block);
    }
}

// An invocation for each block of pixels: it is gathered if anything shows in the blocks of sub-pixels below it.
@compute @workgroup_size(8, 8)
fn find_pixels(@builtin(global_invocation_id) id: vec3<u32>) {
    let first = id.xy * 8u;
    if any(first >= finish.kept) {
        return;
    }
    let end = min(first + 8u, finish.kept);
    let low = (first * finish.scale + finish.inset) / 8u;
    let high = (end * finish.scale + finish.inset - 1u) / 8u;
    let across = block_counts().x;
    var covered = 0u;
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            covered |= blocks[y * across + x];
        }
    }
    if covered != 0u {
        list_block(GATHERED, id.xy);
    }
}
