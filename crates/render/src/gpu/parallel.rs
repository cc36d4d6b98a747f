//! Pipelines that are made side by side.

use rayon::prelude::*;

use crate::gpu::device::Gpu;

/// What `make` makes of 0 to `count` - 1, on all cores. Drivers of graphics hardware compile a pipeline while it is
/// made, each for up to a second. Scopes of errors are a thread's own, so each gets some.
pub(crate) fn side_by_side<T: Send>(
    gpu: &Gpu,
    count: usize,
    make: impl Fn(usize) -> T + Send + Sync,
) -> Vec<T> {
    (0..count)
        .into_par_iter()
        .map(|place| gpu.caught(|| make(place)))
        .collect()
}

/// [`side_by_side`] for a number that is known.
pub(crate) fn all_of<const N: usize, T: Send>(
    gpu: &Gpu,
    make: impl Fn(usize) -> T + Send + Sync,
) -> [T; N] {
    let made: Option<[T; N]> = side_by_side(gpu, N, make).try_into().ok();
    made.expect("as many as there are")
}

/// What `here` makes on this thread, and `there` on another meanwhile.
pub(crate) fn beside<A, B: Send>(
    gpu: &Gpu,
    here: impl FnOnce() -> A,
    there: impl FnOnce() -> B + Send,
) -> (A, B) {
    let mut made = None;
    let own = rayon::in_place_scope(|scope| {
        scope.spawn(|_| made = Some(gpu.caught(there)));
        here()
    });
    (own, made.expect("scopes wait for what they spawn"))
}
