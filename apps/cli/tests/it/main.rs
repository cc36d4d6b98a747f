//! The command as scripts and users call it.

#[cfg(feature = "view")]
mod contract;
mod needs;
mod simulation;
mod tracings;
mod work;

neurotess_testing::main!();
