//! What can go wrong between us and a GPU.

use thiserror::Error;

/// Why no device can be had, or why it stopped working: `what: what to do`.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum DeviceError {
    /// The machine has no adapter that can compute.
    #[error(
        "no graphics adapter: install a driver, or Mesa's software Vulkan \
         (Debian: apt-get install mesa-vulkan-drivers libvulkan1; or cargo xtask setup)"
    )]
    NoAdapter,
    /// None has the wanted name.
    #[error("no adapter is called '{wanted}': choose from {}", list(.there))]
    UnknownAdapter {
        /// The name, or a part of it.
        wanted: String,
        /// What there is.
        there: Vec<String>,
    },
    /// The driver did not open the adapter.
    #[error("{adapter} cannot be opened ({reason}): choose another adapter")]
    Refused {
        /// Its name.
        adapter: String,
        /// In the driver's words.
        reason: String,
    },
    /// One thing is larger than the adapter can hold in a piece.
    #[error("{what} needs {bytes} bytes in one piece, the adapter has {most}: lower the level")]
    TooLarge {
        /// The thing.
        what: &'static str,
        /// What it needs.
        bytes: u64,
        /// What there can be.
        most: u64,
    },
    /// The adapter's memory is used up.
    #[error("the adapter's memory is used up: lower the level, the size or the samples")]
    OutOfMemory,
    /// The device is gone.
    #[error("the graphics device was lost ({0}): try again, or choose another adapter")]
    Lost(String),
    /// The driver or wgpu objects to what we do: a bug of ours or theirs.
    #[error("the graphics driver objects ({0}): please report this as a bug")]
    Driver(String),
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".into();
    }
    names.join(", ")
}
