//! Where results go.

use std::path::PathBuf;

use clap::Args;

/// Where results go.
#[derive(Args, Clone, Debug)]
pub(crate) struct OutArgs {
    /// A file for one input, - for standard output; a folder for several, or for a folder, whose
    /// structure it repeats
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
}
