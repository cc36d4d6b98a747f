//! Meshes of tracings, and their files.

mod files;
mod number;
mod purposes;
mod soma_meshes;

neurotess_testing::main!();

/// A soma with an axon and a dendrite.
const SMALL: &str =
    "1 1 0 0 0 5 -1\n2 2 0 -9 0 1 1\n3 2 0 -30 0 1 2\n4 3 0 9 0 1 1\n5 3 0 30 0 1 4\n";

fn cell(text: &str) -> neurotess_morphology::Morphology {
    let options = neurotess_formats::ReadOptions::default();
    let read = neurotess_formats::swc::read_bytes(text.as_bytes(), "cell.swc", &options);
    read.expect("a cell").morphology
}
