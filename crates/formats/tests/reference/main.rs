//! Files of others, and what other programs found in them: `../shared` beside the workspace.

mod both_formats;
mod neuroml;
mod outlined;
mod swc;
mod table;

neurotess_testing::main!();
