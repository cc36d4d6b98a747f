//! Coarse meshes of tracings.

mod branches;
mod forks;
mod growth;
mod hubs;
mod limits;
mod near_somata;
mod rings;
mod soma;
mod stop;
mod traced_somata;
mod tubes;
mod turned_back;

neurotess_testing::main!();
