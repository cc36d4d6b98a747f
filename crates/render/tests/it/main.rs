//! Pictures and what draws them.

mod adapter;
mod adaptive;
mod common;
mod compared;
mod composite;
mod cracks;
mod device;
mod exploration;
mod golden;
mod markers;
mod memory;
mod meshes;
mod opengl;
mod orthographic;
mod parity;
mod picking;
mod pictured;
mod pictures;
mod popping;
mod processor;
mod progressive;
mod renderer;
mod static_picture;
mod streaming;

neurotess_testing::main!();
