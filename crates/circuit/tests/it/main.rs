//! Circuits, their reports and spikes, from outside.

mod dialects;
mod faults;
mod fuzz;
mod reference;
mod snudda;

neurotess_testing::main!();
