//! The command line as scripts see it: one test for each row of its contract.

mod attacks;
mod bench;
mod cache;
mod check;
mod circuit;
mod convert;
mod display;
mod foreign_circuits;
mod formats;
mod help;
mod html;
mod info;
mod inputs;
mod kill;
mod like;
mod markers;
mod mesh;
mod meshes;
mod neuroglancer;
#[cfg(feature = "gpu")]
mod options;
mod palettes;
mod parts;
mod render;
mod resume;
mod sections;
mod sessions;
mod snudda;
mod streams;
mod synth;
mod tables;
mod values;
mod view;
mod view_keys;
mod written;
