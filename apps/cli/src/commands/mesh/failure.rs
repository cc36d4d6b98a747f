//! What keeps a cell from being meshed, with what to do, in the words of the command line.

use neurotess::recipe::MeshError;

use crate::report::Failure;

impl From<MeshError> for Failure {
    fn from(error: MeshError) -> Self {
        let remedy = match error {
            MeshError::Empty => ": check --types and --soma",
            MeshError::StillCrosses { .. } => ": try another --level",
            MeshError::CutOff { .. } => ": mend the tracing there, or use --crossings merge",
            MeshError::NotManifold | MeshError::FellApart { .. } => {
                ": use --crossings merge and look at it with neurotess check"
            }
            _ => "",
        };
        Self(format!("{error}{remedy}"))
    }
}
