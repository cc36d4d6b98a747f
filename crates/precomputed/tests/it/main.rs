//! Folders of precomputed data, byte by byte.

neurotess_testing::main!();
