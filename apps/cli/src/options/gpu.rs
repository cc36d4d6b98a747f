//! The graphics adapter, and how much of its memory may be used.

use bytesize::ByteSize;
use clap::Args;

/// What to draw with.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct GpuArgs {
    /// What to draw with: a part of an adapter's name, or, for pictures, cpu: the processor [default: NEUROTESS_ADAPTER;
    /// for pictures the processor, but for large scenes where there is graphics hardware]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Most memory of the adapter that the tracings of large scenes may take, as in 512MiB or 2GB: what is near is
    /// then finer than what is not [default: as much as the adapter can bind]
    #[arg(long, value_name = "SIZE", env = "NEUROTESS_GPU_MEMORY", hide_env_values = true,
          value_parser = memory)]
    pub(crate) gpu_memory: Option<u64>,
}

fn memory(text: &str) -> Result<u64, String> {
    match text.parse::<ByteSize>() {
        Ok(size) if size.as_u64() > 0 => Ok(size.as_u64()),
        _ => Err("a size above 0 is needed, like 512MiB, 2GB or 1000000 (bytes)".into()),
    }
}
