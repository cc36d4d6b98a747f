//! The cache from outside.

mod cache;

neurotess_testing::main!();
