//! Another thread can stop the work.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use neurotess_formats::{ReadOptions, swc};
use neurotess_generate::{GenerateError, GenerateOptions, generate, generate_watched};
use neurotess_mesh::Watch;

#[neurotess_testing::test]
fn what_is_stopped_is_an_error_at_whichever_stage() {
    let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 20 0 1 2\n4 3 9 30 0 1 3\n5 3 -9 30 0 1 3\n";
    let read = swc::read_bytes(text, "cell.swc", &ReadOptions::default()).expect("a cell");
    let options = GenerateOptions::default();
    // The clock is asked before and after the soma.
    for stage in 0..3 {
        let (stopped, asked) = (AtomicBool::new(stage == 0), AtomicUsize::new(0));
        let clock = || {
            let asked = asked.fetch_add(1, Ordering::Relaxed) + 1;
            stopped.fetch_or(asked == stage, Ordering::Relaxed);
            0.0
        };
        let watch = Watch::stopped_by(&stopped).with_clock(&clock);
        let made = generate_watched(&read.morphology, &options, &watch);
        assert!(matches!(made, Err(GenerateError::Stopped(_))), "{stage}");
        assert_eq!(asked.into_inner(), [0, 2, 2][stage], "{stage}");
    }
    let running = AtomicBool::new(false);
    let made = generate_watched(&read.morphology, &options, &Watch::stopped_by(&running));
    let usual = generate(&read.morphology, &options).expect("a mesh");
    assert_eq!(made.expect("a mesh").mesh, usual.mesh);
}
