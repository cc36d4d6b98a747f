//! What drivers that draw on the processor need of the memory allocator.
//!
//! Mesa's rasterizer keeps the triangles of a frame in blocks of 64 KiB, up to 36 MiB of them, and frees
//! them when the frame is drawn. glibc returns what is free at the end of its heap to the system as soon as
//! it is more than 128 KiB. Then the system clears every page of it anew for the next frame: 160,000
//! triangles took 35 ms instead of 20.
//!
//! glibc raises this threshold on its own when a program frees a large block: to twice that block's size.
//! Whether a program has done so is chance, so here it is done once.

use std::hint::black_box;
use std::sync::Once;

/// The largest block that glibc learns from has 32 MiB with its header.
const BLOCK: usize = (32 << 20) - (64 << 10);

/// Makes the allocator keep up to 64 MiB of what drivers free. Does nothing with allocators other than
/// glibc's, and where `MALLOC_TRIM_THRESHOLD_` is set.
pub(crate) fn keep_freed_memory() {
    static DONE: Once = Once::new();
    if cfg!(all(target_os = "linux", target_env = "gnu")) {
        // Nothing is written to it, so it takes no memory.
        DONE.call_once(|| drop(black_box(Vec::<u8>::with_capacity(BLOCK))));
    }
}
