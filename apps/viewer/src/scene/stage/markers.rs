//! Synapses and points of the picture: made in the background whenever what they depend on changes, and drawn
//! beside what any source draws.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::coloring::{ClosestColors, closest};
use neurotess::render::overlay::Legend;
use neurotess::render::{DeviceError, Frame, MarkerShape, Markers, ViewParams};

use super::Stage;
use super::cost_model::RestMode;
use crate::io::task::{Progress, Task};
use crate::model::markers::MarkerRef;
use crate::model::revision::Revision;
use crate::model::state::State;
use crate::scene::content::{self, SceneContent};
use crate::scene::markers::{MarkerInputs, MarkerRequest, SceneMarkers, settings};
use crate::scene::meshes::{self, SceneMesh};

/// Most triangles of markers at rest without a budget: a processor draws a million of small ones in less time than
/// a slice may take.
const SOFTWARE_TRIANGLES: usize = 1_000_000;
const TRIANGLES: usize = 20_000_000;

/// Markers of the picture, once they are made.
#[derive(Default)]
pub(super) struct StageMarkers {
    /// What those that show were made of; none: nothing is to be shown.
    inputs: Option<MarkerInputs>,
    making: Option<(MarkerInputs, Task<Made>)>,
    made: Option<Arc<SceneMarkers>>,
    device: Option<Markers>,
    /// Revision of their places and color keys.
    revision: Revision,
    /// Most triangles at rest without a budget.
    most: usize,
    shown: Option<[usize; 3]>,
    closest: Option<ClosestColors>,
}

type Made = Result<MadeMarkers, DeviceError>;

/// What was made in the background.
struct MadeMarkers {
    markers: SceneMarkers,
    /// None if they are where they were, and only colors differ.
    device: Option<Option<Markers>>,
    problem: Option<(String, String)>,
}

/// What a picture depends on of its markers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MarkersKey {
    revision: Revision,
    form: (MarkerShape, f64),
}

impl StageMarkers {
    pub(super) fn new(software: bool) -> Self {
        Self {
            most: if software {
                SOFTWARE_TRIANGLES
            } else {
                TRIANGLES
            },
            ..Self::default()
        }
    }

    /// The key of those that show.
    pub(super) fn key(&self, state: &State) -> Option<MarkersKey> {
        self.device.as_ref()?;
        Some(MarkersKey {
            revision: self.revision,
            form: state.document.markers.form(),
        })
    }

    /// Those on the device, to be drawn. `sub_pixels`: width of a pixel of the window; `budget`: triangles
    /// of what they are drawn beside.
    pub(super) fn drawn(
        &mut self,
        key: Option<MarkersKey>,
        sub_pixels: f64,
        budget: Option<u32>,
    ) -> Option<&mut Markers> {
        let form = key?.form;
        let markers = self.device.as_mut()?;
        markers.set_settings(settings(form, sub_pixels, budget, self.most));
        Some(markers)
    }

    /// What the marker of an id is.
    pub(super) fn picked(
        &self,
        id: neurotess::render::pick::PickId,
    ) -> Option<(MarkerRef, glam::DVec3)> {
        let index = self.device.as_ref()?.picked(id)?;
        let made = self.made.as_ref()?;
        Some((made.marker(index)?, made.markers.get(index)?.position))
    }

    /// Whether they are being made.
    pub(super) fn is_making(&self) -> bool {
        self.making.is_some()
    }

    pub(super) fn bytes(&self) -> u64 {
        self.device.as_ref().map_or(0, Markers::bytes)
    }

    /// Numbers of those that the last picture shows, of those in view, and of all.
    pub(super) fn shown(&self) -> Option<[usize; 3]> {
        self.device.as_ref().and(self.shown)
    }

    /// Those that show, for pictures that are saved.
    pub(super) fn made(&self) -> Option<&Arc<SceneMarkers>> {
        self.made.as_ref()
    }

    fn clear(&mut self) {
        *self = Self {
            most: self.most,
            ..Self::default()
        };
    }
}

impl Stage {
    /// Brings markers up to date: takes those that were made, and begins to make others.
    pub(super) fn update_markers(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        self.take_markers(state, ctx)?;
        if self.markers.making.is_some() {
            return Ok(());
        }
        let inputs = MarkerInputs::new(state, &self.content);
        if self.markers.inputs == inputs {
            return Ok(());
        }
        let request = MarkerRequest::new(state, &self.content);
        let (Some(inputs), Some(request)) = (inputs, request) else {
            self.markers.clear();
            self.markers_changed();
            return Ok(());
        };
        let (gpu, waker) = (Arc::clone(&self.gpu), ctx.clone());
        let before = self.markers.made.clone();
        let work = move |_: &Progress| {
            let (markers, problem) = request.markers();
            let same = before.is_some_and(|before| before.is_recolored(&markers));
            let device = match same {
                true => Ok(None),
                false => markers.upload(&gpu).map(Some),
            };
            Ok(device.map(|device| MadeMarkers {
                markers,
                device,
                problem,
            }))
        };
        let progress = Progress::new("preparing synapses and points", "markers", 0);
        let task = Task::start(progress, move || waker.request_repaint(), work);
        self.markers.making = Some((inputs, task));
        Ok(())
    }

    fn take_markers(&mut self, state: &mut State, ctx: &egui::Context) -> Result<(), DeviceError> {
        let Some((_, task)) = &self.markers.making else {
            return Ok(());
        };
        let Some(result) = task.take() else {
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        };
        // Not tried again: the same would fail again.
        self.markers.inputs = self.markers.making.take().map(|(inputs, _)| inputs);
        let made = match result {
            Ok(made) => made?,
            Err(why) => {
                state.problem("preparing synapses and points", why);
                return Ok(());
            }
        };
        if let Some((what, why)) = made.problem {
            state.problem(what, why);
        }
        if let Some(device) = made.device {
            self.markers.device = device;
            self.markers.revision = Revision::next();
            // Ids of a picture that is on its way are those of the markers before. What was resolved stays, so
            // that the second click of a double click hits what the first one did.
            (self.pointing.resolver, self.pointing.stale) = (None, true);
        }
        self.markers.made = Some(Arc::new(made.markers));
        self.markers_changed();
        Ok(())
    }

    fn markers_changed(&mut self) {
        self.set_colors();
        self.rebuilds.colors += 1;
        self.recorded.changed = true;
    }

    /// The markers that show, if cells leave room for their colors; else they are being made again.
    fn fitting_markers(&self) -> Option<&SceneMarkers> {
        let made = self.markers.made.as_deref();
        made.filter(|made| made.fits(&self.content))
    }

    /// Passes the colors of cells, markers and meshes to the renderer.
    pub(super) fn set_colors(&mut self) {
        let mut table = self.content.table.clone();
        self.markers.closest = None;
        if let Some(markers) = self.fitting_markers() {
            table.categories = markers.categories(&table.categories);
            let mut entries = self.content.legend.entries().to_vec();
            entries.extend(markers.entries());
            self.markers.closest = closest(&entries);
        } else if self.markers.made.is_some() {
            self.markers.clear();
        }
        self.meshes.add_colors(&mut table, self.content.categories);
        self.progressive.set_colors(table);
    }

    /// The legend of cells, markers and meshes.
    pub(super) fn whole_legend(&self) -> Legend {
        let cells = self.content.legend.clone();
        let legend = match self.fitting_markers() {
            Some(markers) => markers.legend_below(cells),
            None => cells,
        };
        self.meshes.legend_below(legend)
    }

    /// The colors of the legend that are closest to one another.
    pub(crate) fn closest_colors(&self) -> Option<&ClosestColors> {
        let markers = self.markers.closest.as_ref();
        markers.or(self.content.closest.as_ref())
    }

    /// Where the synapses and points of the picture are (µm).
    pub fn marker_positions(&self) -> Vec<glam::DVec3> {
        let made = self.fitting_markers().map(|made| &made.markers[..]);
        let markers = made.unwrap_or_default().iter();
        markers.map(|marker| marker.position).collect()
    }

    /// What has a color that one may set: of the cells, then of markers.
    pub fn colored_things(&self) -> Vec<neurotess::coloring::ColoredThing> {
        let mut things = self.content.coloring.things.clone();
        let markers = self.fitting_markers().map(|markers| &*markers.things);
        things.extend_from_slice(markers.unwrap_or_default());
        things
    }

    /// The scene, and markers and meshes with it, for pictures that are saved. Its instances are those of the
    /// document: those of the stage may be a frame older.
    pub(crate) fn saved_content(
        &self,
        state: &State,
    ) -> (SceneContent, Option<Arc<SceneMarkers>>, Vec<SceneMesh>) {
        let mut content = self.content.clone();
        content.instances = content::instances(state, &content.sources);
        let markers = self.markers.made().cloned();
        if let Some(markers) = &markers {
            markers.add_to(&mut content);
        }
        let mut meshes = self.meshes.shown().to_vec();
        meshes::add_to(&mut meshes, &mut content);
        (content, markers, meshes)
    }

    /// Counts the markers that a picture shows.
    pub(super) fn count_markers(
        &mut self,
        params: &ViewParams,
        key: Option<MarkersKey>,
        budget: Option<u32>,
    ) {
        let (camera, near) = params.frozen.unwrap_or((params.camera, params.near));
        let frame = Frame::whole(camera, near, params.size);
        let markers = self.markers.drawn(key, 1.0, budget);
        self.markers.shown = markers.map(|markers| {
            let [drawn, in_view] = markers.shown(&frame);
            [drawn, in_view, markers.len()]
        });
    }

    /// Triangles of what is drawn at rest, if it has a budget.
    pub(super) fn rest_budget(&self) -> Option<u32> {
        match self.pace.rest_mode {
            RestMode::Refined => None,
            RestMode::Explored | RestMode::Coarser => Some(self.pace.cost_model.budget),
        }
    }
}
