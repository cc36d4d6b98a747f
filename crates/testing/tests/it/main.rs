//! The harness, tested by itself.

mod harness;

neurotess_testing::main!();
