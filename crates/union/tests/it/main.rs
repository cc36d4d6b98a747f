//! Surfaces without crossings.

mod angles;
mod bodies;
mod cells;
mod pressing;
mod random_tubes;
mod rejoin;
mod shapes;
mod tunnels;

neurotess_testing::main!();
