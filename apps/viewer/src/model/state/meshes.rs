//! Meshes beside the cells: what is to be read, and where they are.

use std::path::PathBuf;

use neurotess::render::BoundingSphere;

use super::State;
use crate::model::command::Edit;
use crate::model::document::MeshEntry;
use crate::model::meshes::ReadMesh;
use crate::model::numbers::grouped;
use crate::model::revision::Revision;

/// What the places of meshes depend on: revisions of the document's and of what was read.
pub(crate) type MeshesKey = [Revision; 2];

impl State {
    /// Shows meshes of files.
    pub(super) fn open_meshes(&mut self, files: Vec<PathBuf>) {
        // A file that could not be read may have been corrected.
        self.mesh_data
            .keep(|file, good| good || !files.iter().any(|of| of == file));
        let first = self.document.meshes.len();
        let entries = files.into_iter().zip(first..);
        let entries: Vec<MeshEntry> = entries.map(|(f, i)| MeshEntry::new(f, i)).collect();
        if !entries.is_empty() {
            self.run(Edit::AddMeshes(entries));
        }
    }

    /// A file that is to be read and was not yet.
    pub(crate) fn mesh_due(&mut self) -> Option<PathBuf> {
        if self.document.neurons.is_empty() {
            return None;
        }
        let entries = &self.document.meshes;
        self.mesh_data
            .keep(|file, _| entries.iter().any(|entry| entry.file == file));
        let mut due = entries.iter().map(|entry| &entry.file);
        due.find(|file| !self.mesh_data.was_read(file)).cloned()
    }

    /// Takes what was read of a file.
    pub(crate) fn set_mesh(&mut self, file: PathBuf, read: Result<ReadMesh, String>) {
        if let Err(why) = &read {
            self.problem(file.display().to_string(), why.clone());
        }
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let name = name.into_owned();
        let faces = read.as_ref().map(ReadMesh::faces);
        self.messages.status = match faces {
            Ok(faces) => format!("{name}: {} faces", grouped(faces as u64)),
            Err(_) => format!("{name} does not show"),
        };
        self.mesh_data.set(file, read);
    }

    /// Whether meshes are where they are relative to the cells: side by side, cells are elsewhere.
    pub(crate) fn places_meshes(&self) -> bool {
        !self.document.grid
    }

    /// Meshes that show, as they were read.
    pub(crate) fn meshes_shown(&self) -> impl Iterator<Item = (&MeshEntry, &ReadMesh)> {
        let placed = self.places_meshes();
        let entries = self.document.meshes.iter().filter(move |_| placed);
        let entries = entries.filter(|entry| !entry.hidden);
        entries.filter_map(|entry| Some((entry, self.mesh_data.get(&entry.file)?)))
    }

    /// Points (µm) of the meshes that show. `translucent`: whether of those that one can see through, too, which only
    /// surround what is shown.
    pub(crate) fn mesh_points(&self, translucent: bool) -> Vec<BoundingSphere> {
        let meshes = self.meshes_shown();
        let meshes = meshes.filter(|(entry, _)| translucent || !entry.is_translucent());
        let points = meshes.flat_map(|(entry, read)| {
            let um = entry.um();
            read.points.iter().map(move |&(at, _)| (um * at, 0.0))
        });
        points.collect()
    }

    /// What the places of meshes depend on.
    pub(crate) fn meshes_key(&self) -> MeshesKey {
        [self.document.meshes.revision(), self.mesh_data.revision()]
    }
}
