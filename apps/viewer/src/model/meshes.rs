//! Meshes beside the cells that were read.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use neurotess::mesh::SurfaceMesh;
use neurotess::render::BoundingSphere;

use crate::model::revision::Revision;

/// A mesh that was read.
#[derive(Clone, Debug)]
pub(crate) struct ReadMesh {
    pub(crate) surface: Arc<SurfaceMesh>,
    /// Points that cameras are fitted to, in units of the file.
    pub(crate) points: Arc<Vec<BoundingSphere>>,
}

impl ReadMesh {
    /// Number of its faces.
    pub(crate) fn faces(&self) -> usize {
        let faces = &self.surface.faces;
        faces.triangles.len() + faces.quads.len()
    }
}

/// All meshes that were read, or why one was not.
#[derive(Clone, Debug, Default)]
pub struct MeshData {
    read: Vec<(PathBuf, Result<ReadMesh, String>)>,
    revision: Revision,
}

impl MeshData {
    /// The revision of what was read.
    pub(crate) fn revision(&self) -> Revision {
        self.revision
    }

    /// Whether a file was read already, or could not be read.
    pub(crate) fn was_read(&self, file: &Path) -> bool {
        self.read.iter().any(|(of, _)| of == file)
    }

    /// The mesh of a file, if it was read.
    pub(crate) fn get(&self, file: &Path) -> Option<&ReadMesh> {
        let (_, read) = self.read.iter().find(|(of, _)| of == file)?;
        read.as_ref().ok()
    }

    /// Why the mesh of a file does not show.
    pub(crate) fn failure(&self, file: &Path) -> Option<&str> {
        let (_, read) = self.read.iter().find(|(of, _)| of == file)?;
        read.as_ref().err().map(String::as_str)
    }

    /// Number of faces of the mesh of a file.
    pub(crate) fn faces(&self, file: &Path) -> Option<usize> {
        self.get(file).map(ReadMesh::faces)
    }

    /// Takes what was read.
    pub(crate) fn set(&mut self, file: PathBuf, read: Result<ReadMesh, String>) {
        self.read.retain(|(of, _)| *of != file);
        self.read.push((file, read));
        self.revision = Revision::next();
    }

    /// Forgets files, so that they are read again if they are to be shown.
    pub(crate) fn keep(&mut self, keeps: impl Fn(&Path, bool) -> bool) {
        let before = self.read.len();
        self.read.retain(|(of, read)| keeps(of, read.is_ok()));
        if self.read.len() != before {
            self.revision = Revision::next();
        }
    }
}
