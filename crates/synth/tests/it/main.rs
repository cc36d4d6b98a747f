//! Synthetic cells.

mod cells;
mod crossings;
mod samples;

neurotess_testing::main!();
