//! Groups made on all threads and taken in order.

use std::collections::BTreeMap;
use std::panic::{self, AssertUnwindSafe};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use rayon::Yield;

use super::{WriteError, window};

/// Makes groups on all threads, never more than [`window`] ahead of what is taken, and takes them in
/// order on this thread, which helps with making while there is nothing to take.
///
/// # Panics
/// Where `make` does.
pub(super) fn in_order<G: Sync, T: Send>(
    groups: &[G],
    make: impl Fn(&G) -> T + Sync,
    mut take: impl FnMut(T) -> Result<(), WriteError>,
) -> Result<(), WriteError> {
    let (send, received) = mpsc::channel();
    rayon::in_place_scope_fifo(|scope| {
        let begin = |number: usize| {
            if let Some(group) = groups.get(number) {
                let (send, make) = (send.clone(), &make);
                scope.spawn_fifo(move |_| {
                    // A panic is passed on: whoever waits for this group must not wait forever.
                    let made = panic::catch_unwind(AssertUnwindSafe(|| make(group)));
                    // Nobody receives it where taking another one failed.
                    let _ = send.send((number, made));
                });
            }
        };
        (0..window()).for_each(begin);
        let mut early = BTreeMap::new();
        for number in 0..groups.len() {
            let made = loop {
                if let Some(made) = early.remove(&number) {
                    break made;
                }
                let (number, made) = wait_for(&received);
                early.insert(number, made);
            };
            take(made.unwrap_or_else(|panic| panic::resume_unwind(panic)))?;
            begin(number + window());
        }
        Ok(())
    })
}

/// The next message. A thread of the pool makes groups meanwhile: it may be the only one.
fn wait_for<T>(received: &Receiver<T>) -> T {
    loop {
        if let Ok(message) = received.try_recv() {
            return message;
        }
        let patience = match rayon::yield_now() {
            Some(Yield::Executed) => continue,
            // All that is left is being made by others.
            Some(Yield::Idle) => Duration::from_micros(50),
            None => Duration::MAX,
        };
        if let Ok(message) = received.recv_timeout(patience) {
            return message;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    fn on_threads(threads: usize, run: impl FnOnce() + Send) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(run);
    }

    fn check_order() {
        let groups: Vec<usize> = (0..200).collect();
        let (ahead, mut taken) = (AtomicUsize::new(0), 0);
        let make = |&group: &usize| {
            ahead.fetch_add(1, Ordering::Relaxed);
            if group % 7 == 0 {
                std::thread::sleep(Duration::from_micros(300));
            }
            group
        };
        in_order(&groups, make, |group| {
            assert_eq!(group, taken);
            taken += 1;
            let made = ahead.load(Ordering::Relaxed);
            assert!(made <= group + window(), "{made} made before {group}");
            Ok(())
        })
        .expect("nothing fails");
        assert_eq!(taken, groups.len());
    }

    #[test]
    fn groups_are_taken_in_order_and_few_are_made_ahead() {
        check_order();
        on_threads(1, check_order);
        on_threads(3, check_order);
    }

    #[test]
    fn a_failure_ends_it() {
        let groups = [0; 50];
        let full = || WriteError::Io(std::io::Error::other("full"));
        for threads in [1, 2] {
            on_threads(threads, || {
                let mut left = 9;
                let ended = in_order(
                    &groups,
                    |_| (),
                    |()| {
                        left -= 1;
                        if left == 0 { Err(full()) } else { Ok(()) }
                    },
                );
                assert!(matches!(ended, Err(WriteError::Io(_))));
                assert_eq!(left, 0);
            });
        }
    }

    #[test]
    #[should_panic(expected = "group 5")]
    fn a_panic_is_passed_on() {
        let groups: Vec<usize> = (0..50).collect();
        let make = |&group: &usize| assert!(group != 5, "group {group}");
        let _ = in_order(&groups, make, Ok);
    }
}
