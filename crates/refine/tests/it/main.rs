//! Refinement on the processor, and the shaders beside it.

mod closed;
mod edge_rules;
mod judge;
mod labels;
mod parts;
mod resident;
#[cfg(feature = "testing")]
mod shaders;
mod shape;
mod trees;

neurotess_testing::main!();
