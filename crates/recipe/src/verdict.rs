//! What a mesh for simulators must be.

use neurotess_generate::Generated;

use crate::{CellSurface, MeshError};

/// Fails unless solvers can take the mesh. [`Merged::new`](crate::Merged) has seen to crossings.
pub(crate) fn check(surface: &CellSurface<'_>, generated: &Generated) -> Result<(), MeshError> {
    let topology = &surface.topology;
    if !topology.closed || !topology.oriented || !topology.vertex_manifold {
        return Err(MeshError::NotManifold);
    }
    let merged = surface.merged();
    if let Some(part) = merged.and_then(|merged| merged.report.cut_off.first()) {
        return Err(MeshError::CutOff { sample: part.point });
    }
    let traced = generated.mesh.topology().components;
    if topology.components > traced {
        return Err(MeshError::FellApart {
            pieces: topology.components,
            traced,
        });
    }
    Ok(())
}
