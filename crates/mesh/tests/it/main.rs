//! Meshes, their files and checks.

mod attributes;
mod colors;
mod compressed;
mod draco;
mod fuzz;
mod independent;
mod intersect;
mod legacy;
mod materials;
mod parts;
mod readers;
mod round_trip;
mod scenes;
mod shapes;
mod simulators;
mod topology;

neurotess_testing::main!();
