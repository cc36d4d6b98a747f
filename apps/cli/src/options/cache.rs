//! Whether a circuit's cache is used.

use clap::Args;

/// The cache of a circuit.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct CacheArgs {
    /// Neither read nor write the meshes that are kept beside a circuit (NAME.ntcache)
    #[arg(long, help_heading = "Circuits")]
    pub(crate) no_cache: bool,
}
