//! Plots in the window.

#[path = "../common/mod.rs"]
mod common;
mod measures;
mod traces;

neurotess_testing::main!();
