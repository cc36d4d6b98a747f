//! Pages: what is in them.

neurotess_testing::main!();
