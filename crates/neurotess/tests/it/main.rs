//! The library as its users call it.

mod crossings;
#[cfg(feature = "render")]
mod examples;
mod jittered;
mod real_cells;

neurotess_testing::main!();
