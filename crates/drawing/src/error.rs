//! Why nothing is drawn.

use neurotess_options::OptionError;
use neurotess_output::OutputError;
use neurotess_picture::SceneError;

/// Why nothing is drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// Options are wrong, or do not go together.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// An input or the device fails.
    #[error("{0}")]
    Failed(String),
    /// There is too little memory.
    #[error("{0}")]
    Memory(String),
    /// Another thread asked to stop.
    #[error("stopped")]
    Stopped,
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl DrawError {
    /// An input or the device fails: the message of an error, which tells its cause itself.
    pub(crate) fn failed(error: impl std::fmt::Display) -> Self {
        Self::Failed(error.to_string())
    }
}

#[cfg(feature = "gpu")]
impl From<neurotess_render::DeviceError> for DrawError {
    fn from(error: neurotess_render::DeviceError) -> Self {
        Self::failed(error)
    }
}

#[cfg(feature = "gpu")]
impl From<neurotess_render::ExplorationError> for DrawError {
    fn from(error: neurotess_render::ExplorationError) -> Self {
        Self::failed(error)
    }
}

impl From<SceneError> for DrawError {
    fn from(error: SceneError) -> Self {
        Self::failed(error)
    }
}

/// Options that do not go together.
pub(crate) fn together<T>(why: impl Into<String>) -> Result<T, DrawError> {
    Err(OptionError::together(why).into())
}
