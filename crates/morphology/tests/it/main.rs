//! Morphologies: edits, differences, spines.

mod differences;
mod edits;
mod spines;

neurotess_testing::main!();
