//! What keeps a cell from being meshed, with what to do, in the words of the command line.

use neurotess::recipe::{MeshError, Spelling};

use crate::report::Failure;

impl From<MeshError> for Failure {
    fn from(error: MeshError) -> Self {
        Self(error.told(Spelling::Flag))
    }
}
