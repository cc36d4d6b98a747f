//! Files of others, and what other programs found in them: `../shared` beside the workspace.

mod neuroml;
mod outlined;
mod swc;
mod table;
