//! Circuits, their reports and spikes, from outside.

mod faults;
mod fuzz;
mod reference;
mod snudda;

neurotess_testing::main!();
