//! What cannot be meshed at all.

use neurotess_mesh::Stopped;

/// Largest coordinate or radius (µm): a kilometer a thousand times over. Products of three still have
/// room in 32 bits. A guard.
pub(crate) const LARGEST: f64 = 1e12;

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// A coordinate or radius is beyond anything that is a neuron.
    #[error(
        "sample {sample}: coordinates or radius of {size:.3e} µm, and at most {LARGEST:e} µm can be meshed: \
         mend the number, or its unit"
    )]
    TooLarge {
        /// The file's own number of the sample.
        sample: i64,
        /// The largest of its coordinates and its radius (µm).
        size: f64,
    },
    /// So far from the origin, 32-bit coordinates do not resolve the neurite.
    #[error(
        "sample {sample}: a radius of {radius} µm at {distance:.3e} µm from the origin, where 32-bit coordinates \
         are rounded by up to {rounding:.2e} µm: move the cell to the origin, or mend the number or its unit"
    )]
    Unresolved {
        /// The file's own number of the sample.
        sample: i64,
        /// Its radius (µm).
        radius: f64,
        /// The largest of its coordinates (µm).
        distance: f64,
        /// Largest error of rounding there (µm).
        rounding: f64,
    },
    /// A vertex of the mesh is no number.
    #[error(
        "sample {sample}: the surface there has no finite place: please report it with the file"
    )]
    NotFinite {
        /// The file's own number of the sample.
        sample: i64,
    },
    /// Another thread stopped it: [`generate_watched`](crate::generate_watched).
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl GenerateError {
    /// The same of the sample that a label stands for.
    pub(crate) fn with_own_sample(mut self, own: impl Fn(i64) -> i64) -> Self {
        match &mut self {
            Self::TooLarge { sample, .. }
            | Self::Unresolved { sample, .. }
            | Self::NotFinite { sample } => *sample = own(*sample),
            Self::Stopped(_) => {}
        }
        self
    }
}
