//! What draws.

use serde::{Deserialize, Serialize};

use crate::words::Bytes;

/// The graphics adapter, and how much of its memory may be used.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct DeviceOptions {
    /// What to draw with: a part of an adapter's name, or, for pictures, cpu: the processor [default: NEUROTESS_ADAPTER;
    /// for pictures the processor, but for large scenes where there is graphics hardware]
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub adapter: Option<String>,
    /// Most memory of the adapter that the tracings of large scenes may take, as in 512MiB or 2GB: what is near is
    /// then finer than what is not [default: as much as the adapter can bind]
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "SIZE",
            env = "NEUROTESS_GPU_MEMORY",
            hide_env_values = true
        )
    )]
    pub gpu_memory: Option<Bytes>,
}
