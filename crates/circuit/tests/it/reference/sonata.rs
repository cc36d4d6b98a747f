//! Where the circuits of others are.

use std::path::PathBuf;

/// The folder of SONATA circuits in the reference data.
pub(crate) fn sonata() -> PathBuf {
    neurotess_testing::shared_data().join("sonata")
}
