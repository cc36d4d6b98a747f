//! Why no page is made.

use thiserror::Error;

/// Why no page is made. Displays as `what: what to do`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WebError {
    /// There is nothing to show.
    #[error("no cell has a surface: give one that has")]
    Empty,
    /// More than a page can name.
    #[error(
        "{points} tracing points are too many for a page, which may have {most}: leave out cells"
    )]
    TooManyPoints {
        /// Their number.
        points: usize,
        /// The most.
        most: usize,
    },
    /// More than a browser draws at once.
    #[error("{patches} patches are too many for a page, which may have {most}: leave out cells")]
    TooManyPatches {
        /// Their number.
        patches: usize,
        /// The most.
        most: usize,
    },
    /// One of our shaders cannot be translated: a bug.
    #[error("a shader cannot be translated ({0}): report it")]
    Shader(String),
}
