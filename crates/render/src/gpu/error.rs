//! Errors of the GPU.

use thiserror::Error;

/// Why a device cannot be opened or stopped working. Messages have the form `what: what to do`.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum DeviceError {
    /// The machine has no adapter that can compute.
    #[error(
        "no graphics adapter: install a driver, or Mesa's software Vulkan \
         (Debian: apt-get install mesa-vulkan-drivers libvulkan1; or cargo xtask setup)"
    )]
    NoAdapter,
    /// No adapter has the requested name.
    #[error("no adapter is called '{wanted}': choose from {}", list(.there))]
    UnknownAdapter {
        /// The requested name, or a part of it.
        wanted: String,
        /// Names of the adapters that exist.
        there: Vec<String>,
    },
    /// The adapter cannot do what is needed to draw.
    #[error(
        "{adapter} cannot draw neurons, since it has no {}: update its driver, choose another adapter, or \
         install Mesa's software Vulkan (Debian: apt-get install mesa-vulkan-drivers libvulkan1)",
        .lacks.join(", no ")
    )]
    Unable {
        /// Name of the adapter.
        adapter: String,
        /// What it would have to have.
        lacks: Vec<&'static str>,
    },
    /// A device that another program opened has less than is needed.
    #[error(
        "the device of {adapter} was opened with too little ({}): ask for the limits of Gpu::requirements",
        .short.join(", ")
    )]
    Limited {
        /// Name of the adapter.
        adapter: String,
        /// Names of limits, and what they are instead of what they would have to be.
        short: Vec<String>,
    },
    /// The driver did not open the adapter.
    #[error("{adapter} cannot be opened ({reason}): choose another adapter")]
    Refused {
        /// Name of the adapter.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// A buffer is larger than the adapter can bind.
    #[error("{what} needs {bytes} bytes in one piece, the adapter has {most}: lower the level")]
    TooLarge {
        /// What the buffer holds.
        what: &'static str,
        /// Bytes that it needs.
        bytes: u64,
        /// Most bytes that the adapter can bind.
        most: u64,
    },
    /// Not even the coarsest form of all tracings fits the memory.
    #[error(
        "all tracings together take {bytes} bytes at least, but there are {most}: allow more memory, or show fewer"
    )]
    TooManyTracings {
        /// Bytes of the coarsest form of all.
        bytes: u64,
        /// Bytes that they may take.
        most: u64,
    },
    /// The adapter's memory is used up.
    #[error("the adapter's memory is used up: lower the level, the size or the samples")]
    OutOfMemory,
    /// The device is gone.
    #[error("the graphics device was lost ({0}): try again, or choose another adapter")]
    Lost(String),
    /// The driver or wgpu rejected a call: a bug in neurotess, wgpu or the driver.
    #[error("the graphics driver objects ({0}): please report this as a bug")]
    Driver(String),
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".into();
    }
    names.join(", ")
}
