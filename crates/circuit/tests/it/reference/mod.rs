//! Circuits of others, and what other programs found in them: `../shared` beside the workspace.

mod circuits;
mod reports;
mod sonata;
