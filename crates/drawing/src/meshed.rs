//! A cell with its mesh, or why there is none.

use neurotess_formats::Warning;
use neurotess_generate::Generated;
use neurotess_mesh::CoarseMesh;
use neurotess_morphology::Morphology;
use neurotess_picture::BoundingSphere;
#[cfg(feature = "gpu")]
use neurotess_render::Proxy;

/// A cell that can be drawn.
pub struct MeshedCell {
    /// Its file, or its name.
    pub file: String,
    /// Its tracing.
    pub morphology: Morphology,
    /// Its mesh; of many that exploration draws without vertices and patches.
    pub mesh: CoarseMesh,
    /// What exploration draws, if it came with the mesh; all its color keys are 0.
    #[cfg(feature = "gpu")]
    pub(crate) proxy: Option<Proxy>,
    /// Bounding spheres of the mesh, if only its tracing points are kept.
    pub(crate) bounds: Option<Vec<BoundingSphere>>,
    pub(crate) warnings: Vec<Warning>,
    pub(crate) mended: Vec<String>,
    /// Whether nothing of it can be drawn.
    pub(crate) is_empty: bool,
}

impl MeshedCell {
    /// Of a mesh that there is.
    pub(crate) fn of_mesh(file: String, morphology: Morphology, generated: Generated) -> Self {
        let mended = generated.warnings.iter();
        Self {
            file,
            mended: mended.map(|w| format!("{w} ({})", w.code)).collect(),
            is_empty: generated.mesh.patches.is_empty(),
            morphology,
            mesh: generated.mesh,
            #[cfg(feature = "gpu")]
            proxy: None,
            bounds: None,
            warnings: Vec::new(),
        }
    }
}

/// A file that could not be drawn.
#[derive(Clone, Debug)]
pub struct Unread {
    /// The file.
    pub file: String,
    /// Why: file, line, what to do.
    pub error: String,
}
