//! Plots in the window.

#[path = "../common/mod.rs"]
mod common;
mod measures;
mod traces;

neurotess_testing::main!(finally: common::wait_for_threads());
