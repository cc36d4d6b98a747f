//! Meshes of the window's picture: uploaded on another thread, one after the other.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::mesh::SurfaceMesh;
use neurotess::render::color::ColorTable;
use neurotess::render::overlay::Legend;
use neurotess::render::pick::PickId;
use neurotess::render::{DeviceError, MeshGeometry, Meshes};

use super::Stage;
use crate::io::task::{Progress, Task};
use crate::model::revision::Revision;
use crate::model::state::{MeshesKey, State};
use crate::scene::meshes::{self, SceneMesh};

/// Meshes of the picture, once they are uploaded.
#[derive(Default)]
pub(super) struct StageMeshes {
    /// Those that were uploaded; without a geometry if that failed, so that it is not tried again.
    uploaded: Vec<(Arc<SurfaceMesh>, Option<Arc<MeshGeometry>>)>,
    uploading: Option<(Arc<SurfaceMesh>, Task<Uploaded>)>,
    /// What those that show were made of: of the document, whether they are placed, and how many were uploaded.
    inputs: Option<(MeshesKey, bool, usize)>,
    /// How many meshes were uploaded in all.
    count: usize,
    shown: Vec<SceneMesh>,
    device: Option<Meshes>,
    /// Revision of all but their colors.
    revision: Revision,
}

type Uploaded = Result<MeshGeometry, DeviceError>;

/// What a picture depends on of its meshes: all but their colors, and where these are in the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DrawnMeshes {
    revision: Revision,
    first: u32,
}

impl StageMeshes {
    /// The key of those that show.
    pub(super) fn key(&self) -> Option<DrawnMeshes> {
        let first = self.shown.first()?.look.color_key;
        let revision = self.revision;
        self.device
            .as_ref()
            .map(|_| DrawnMeshes { revision, first })
    }

    /// Those on the device, to be drawn.
    pub(super) fn drawn(&mut self) -> Option<&mut Meshes> {
        let device = self.device.as_mut()?;
        for (index, mesh) in self.shown.iter().enumerate() {
            device.set_look(index, mesh.look);
        }
        Some(device)
    }

    /// Index of the mesh that an id means, if it means one.
    pub(super) fn picked(&self, id: PickId) -> Option<usize> {
        self.device.as_ref()?.picked(id)
    }

    /// Whether one is being uploaded.
    pub(super) fn is_uploading(&self) -> bool {
        self.uploading.is_some()
    }

    pub(super) fn bytes(&self) -> u64 {
        let meshes = self.uploaded.iter().filter_map(|(_, mesh)| mesh.as_ref());
        meshes.map(|mesh| mesh.bytes()).sum()
    }

    /// Those that show, for pictures that are saved.
    pub(super) fn shown(&self) -> &[SceneMesh] {
        &self.shown
    }

    /// Adds their colors to a table behind all others.
    pub(super) fn add_colors(&mut self, table: &mut ColorTable, categories: usize) {
        if !self.shown.is_empty() {
            meshes::add_colors(&mut self.shown, table, categories);
        }
    }

    /// A legend with their names below.
    pub(super) fn legend_below(&self, legend: Legend) -> Legend {
        meshes::legend_below(&self.shown, legend)
    }

    fn geometry(&self, surface: &Arc<SurfaceMesh>) -> Option<&Arc<MeshGeometry>> {
        let mut uploaded = self.uploaded.iter();
        let found = uploaded.find(|(of, _)| Arc::ptr_eq(of, surface));
        found.and_then(|(_, geometry)| geometry.as_ref())
    }

    fn was_uploaded(&self, surface: &Arc<SurfaceMesh>) -> bool {
        let mut uploaded = self.uploaded.iter();
        uploaded.any(|(of, _)| Arc::ptr_eq(of, surface))
    }
}

impl Stage {
    /// Brings meshes up to date: takes those that were uploaded, and begins to upload others.
    pub(super) fn update_meshes(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        self.take_uploaded(state, ctx)?;
        let inputs = (state.meshes_key(), state.places_meshes(), self.meshes.count);
        if self.meshes.inputs == Some(inputs) {
            return Ok(());
        }
        let wanted = meshes::shown(state);
        let missing = wanted.iter().map(|mesh| &mesh.surface);
        let mut missing = missing.filter(|surface| !self.meshes.was_uploaded(surface));
        if let Some(surface) = missing.next().cloned() {
            self.upload(surface, ctx);
        } else {
            self.meshes.inputs = Some(inputs);
        }
        self.show_meshes(wanted);
        Ok(())
    }

    fn upload(&mut self, surface: Arc<SurfaceMesh>, ctx: &egui::Context) {
        if self.meshes.uploading.is_some() {
            return;
        }
        let (gpu, waker, of) = (Arc::clone(&self.gpu), ctx.clone(), Arc::clone(&surface));
        let work = move |_: &Progress| Ok(MeshGeometry::new(&gpu, SurfaceMesh::clone(&of)));
        let progress = Progress::new("preparing a mesh", "meshes", 0);
        let task = Task::start(progress, move || waker.request_repaint(), work);
        self.meshes.uploading = Some((surface, task));
    }

    fn take_uploaded(&mut self, state: &mut State, ctx: &egui::Context) -> Result<(), DeviceError> {
        let Some((_, task)) = &self.meshes.uploading else {
            return Ok(());
        };
        let Some(result) = task.take() else {
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        };
        let Some((surface, _)) = self.meshes.uploading.take() else {
            return Ok(());
        };
        self.meshes.count += 1;
        let (geometry, end) = match result {
            Ok(Ok(geometry)) => (Some(Arc::new(geometry)), Ok(())),
            Ok(Err(e)) => (None, Err(e)),
            Err(why) => {
                state.problem("preparing a mesh", why);
                (None, Ok(()))
            }
        };
        self.meshes.uploaded.push((surface, geometry));
        end
    }

    /// Shows those of these meshes that are uploaded.
    fn show_meshes(&mut self, mut wanted: Vec<SceneMesh>) {
        let geometries: Vec<_> = wanted
            .iter()
            .map(|mesh| self.meshes.geometry(&mesh.surface).cloned())
            .collect();
        let mut there = geometries.iter().map(Option::is_some);
        wanted.retain(|_| there.next() == Some(true));
        let shown = &self.meshes.shown;
        let same = shown.len() == wanted.len()
            && shown.iter().zip(&wanted).all(|(a, b)| a.is_recolored(b));
        self.meshes.shown = wanted;
        if !same {
            let looks = self.meshes.shown.iter().map(|mesh| mesh.look);
            let all: Vec<_> = geometries.into_iter().flatten().zip(looks).collect();
            self.meshes.device = (!all.is_empty()).then(|| Meshes::new(&self.gpu, all));
            self.meshes.revision = Revision::next();
            self.drop_hidden();
            // Ids of a picture that is on its way are those of the meshes before.
            (self.pointing.resolver, self.pointing.stale) = (None, true);
        }
        self.set_colors();
        self.recorded.changed = true;
    }

    /// Gives back what no mesh of the document needs, but for what was hidden a moment ago.
    fn drop_hidden(&mut self) {
        let shown = &self.meshes.shown;
        self.meshes.uploaded.retain(|(surface, _)| {
            // The window's state holds what is hidden, so it can be shown again at once.
            Arc::strong_count(surface) > 1 || shown.iter().any(|m| Arc::ptr_eq(&m.surface, surface))
        });
    }
}
