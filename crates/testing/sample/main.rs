//! A test program of every kind of test, which `harness.rs` runs and listens to.

mod inner;

use neurotess_testing::note;

fn moon() -> Result<(), String> {
    Err("no moon\n  tonight".into())
}

fn sun() -> Result<(), String> {
    Ok(())
}

#[neurotess_testing::test]
fn what_needs_nothing_runs() {}

#[neurotess_testing::test(needs(sun))]
fn what_is_there_is_used() {}

#[neurotess_testing::test(needs(sun, crate::moon))]
fn what_is_missing_is_skipped() {
    panic!("nobody may get here");
}

#[neurotess_testing::test(needs(neurotess_testing::shared))]
fn reference_data_are_there() {
    assert!(neurotess_testing::shared_data().is_dir());
}

#[neurotess_testing::test]
fn fails_if_asked_to() {
    note!("a note with {}", 7);
    assert!(std::env::var_os("SAMPLE_FAILS").is_none(), "as asked");
}

neurotess_testing::main!();
