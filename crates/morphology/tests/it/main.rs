//! Morphologies: edits, differences, spines.

mod cuts;
mod differences;
mod edits;
mod spines;

neurotess_testing::main!();
