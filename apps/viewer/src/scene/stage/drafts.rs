//! Drafts, which are drawn while something moves.

use std::time::{Duration, Instant};

use eframe::egui;
use neurotess::render::outline::Outlines;
use neurotess::render::state::OUTLINED;
use neurotess::render::{
    AdaptiveSettings, Camera, Clip, Combined, DeviceError, Occlusion, Scene, VertexSource,
    ViewParams,
};

use super::cost_model::explorable;
use super::pointing::outlines;
use super::rest::REST;
use super::static_mode::StaticKey;
use super::{PictureInputs, RestPhase, Stage};
use crate::model::state::State;
use crate::scene::content::{self, InstancesKey, StatesKey};

/// Longest time (ms) that a draft should take.
const DRAFT_MS: f64 = 40.0;
/// Most bytes of finer points that a draft uploads, where not all fit the device.
const DRAFT_UPLOAD: u64 = 8 << 20;
/// Drafts that are coarser than this have half the width and height.
const HALF_FROM: f32 = 6.0;
/// Number of frame times that are shown.
const FRAMES: usize = 90;

impl Stage {
    /// What the current picture depends on. While the neurons stay the same, its time does not grow
    /// with their number.
    pub(super) fn inputs(
        &mut self,
        state: &State,
        size: [u32; 2],
        pixels_per_point: f32,
    ) -> PictureInputs {
        let look = &state.document.look;
        let camera = state.view.camera();
        // Less than a pixel would be fainter, so it is no less where points are smaller.
        let least = look.least_width_of(state.shown()) * pixels_per_point.max(1.0);
        let mut surface = content::surface_look(look, least);
        surface.clip = self.clip(state);
        let frozen = state.views.frozen.map(|view| {
            let camera = view.camera();
            (camera, self.near(state, 1, camera))
        });
        PictureInputs {
            params: ViewParams {
                camera,
                near: self.near(state, 0, camera),
                size,
                look: surface,
                occlusion: if look.occlusion {
                    Occlusion::Fit
                } else {
                    Occlusion::Off
                },
                background: look.background,
                frozen,
            },
            detail: state.document.detail,
            states: StatesKey::new(&state.document),
            instances: InstancesKey::new(state, self.content.revision),
            clamped: state.document.neurons.revisions().clamped,
            markers: self.markers.key(state),
            meshes: self.meshes.key(),
        }
    }

    /// The near plane of a camera; `which`: 0 for that of the picture, 1 for that of frozen levels.
    fn near(&mut self, state: &State, which: usize, camera: Camera) -> f64 {
        let key = (camera, state.spheres_key());
        match self.on_device.near[which] {
            Some((known, near)) if known == key => near,
            _ => {
                let (spheres, meshes) = (state.spheres(), state.mesh_points(true));
                let near = match meshes.is_empty() {
                    true => camera.near(&spheres),
                    false => camera.near(&[&spheres[..], &meshes].concat()),
                };
                self.on_device.near[which] = Some((key, near));
                near
            }
        }
    }

    fn clip(&mut self, state: &State) -> Option<Clip> {
        let key = (state.document.look.cut?, state.spheres_key());
        match self.on_device.clip {
            Some((known, clip)) if known == key => clip,
            _ => {
                let clip = content::clip(&state.document.look, &state.spheres());
                self.on_device.clip = Some((key, clip));
                clip
            }
        }
    }

    /// Draws a draft at once, so coarsely that frames do not take too long.
    pub(super) fn draft(
        &mut self,
        state: &State,
        inputs: PictureInputs,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        self.note_change(state, &inputs);
        if self.progressive.is_busy(&self.gpu) {
            // Waits for the draft before: if drafts piled up, they would be shown too late.
            ctx.request_repaint_after(Duration::from_millis(3));
            return Ok(());
        }
        if self.on_device.instances != Some(inputs.instances) {
            self.set_instances(state, inputs.instances);
        }
        self.look(state, &inputs.params);
        if self.explorer.is_making()
            && explorable(&inputs.params)
            && (self.room.residency.is_some() || self.pace.cost_model.too_many(self.room.patches))
        {
            // Refining even a draft would take seconds: waits for the proxies.
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        }
        if self.pace.drafted && self.progressive.shows_draft() {
            self.keep_up();
        }
        if self.on_device.states != Some(inputs.states) {
            self.set_states(state, inputs.states);
        }
        // If only the selection has changed, picking stays valid, so that the second click of a
        // double click hits what the first one did.
        let before = self.drawn.map(|d| (d.params, d.instances));
        if before != Some((inputs.params, inputs.instances)) {
            self.pointing.picks = None;
        }
        self.pointing.stale = true;
        self.pointing.resolver = None;
        self.pace.counts = None;
        let any = !state.document.neurons.selected().is_empty();
        let around = Outlines {
            // No outlines if there is nothing to outline, since searching for them takes time.
            width: u32::from(any),
            ..outlines(&inputs.params, state.shown())
        };
        self.progressive.set_outlines(&self.gpu, around, None);
        self.pointing.mask = None;
        self.awaited = self.begins_without_draft(&inputs);
        if self.awaited {
            // Nothing moves yet, so nothing is waited for.
            self.pace.moved = Instant::now().checked_sub(REST).unwrap_or(self.pace.moved);
        } else {
            self.draw_draft(&inputs)?;
        }
        self.drawn = Some(inputs);
        self.legend = self.whole_legend();
        self.recorded.changed = false;
        self.pace.drafted = true;
        ctx.request_repaint_after(match self.pace.phase {
            RestPhase::Collects => Duration::ZERO,
            _ => REST,
        });
        Ok(())
    }

    /// Begins to wait for rest. If only colors have changed, a static picture that is being made goes
    /// on; and a recording that is played does not put it off.
    fn note_change(&mut self, state: &State, inputs: &PictureInputs) {
        let key = StaticKey::new(inputs);
        let same = self.shape == Some(key);
        if same && self.pace.phase == RestPhase::Collects {
            return;
        }
        if !same {
            self.leave_static();
            self.shape = Some(key);
        }
        if !same || !state.playback.playing {
            self.pace.moved = Instant::now();
        }
        self.pace.phase = RestPhase::Waits;
        self.resting = None;
        self.progressive.stop();
    }

    /// Draws a draft, in exploration mode if possible.
    pub(super) fn draw_draft(&mut self, inputs: &PictureInputs) -> Result<(), DeviceError> {
        let mut params = inputs.params;
        let budget = self.explorer.budget();
        let fine = self.fine(true);
        let explorer = match explorable(&params) {
            true => {
                let (gpu, content, instances) =
                    (&self.gpu, &self.content, self.on_device.instances);
                let upload = Some(DRAFT_UPLOAD);
                self.explorer
                    .exploration(gpu, content, instances, budget, &fine, upload)
            }
            false => None,
        };
        self.pace.explored = explorer.is_some();
        let key = inputs.markers;
        if let Some(source) = explorer {
            let mut finer: Option<&mut dyn VertexSource> = None;
            if !fine.is_empty() {
                self.adaptive.set_settings(AdaptiveSettings {
                    lod: inputs.detail.lod(),
                    smallest: inputs.detail.smallest,
                    ..AdaptiveSettings::default()
                });
                self.adaptive.set_only(Some(fine));
                finer = Some(&mut self.adaptive);
            }
            let markers = self.markers.drawn(key, 1.0, Some(budget));
            let mut source = Combined::new(source)
                .with_finer(finer)
                .with_markers(markers)
                .with_meshes(self.meshes.drawn());
            self.progressive.draft(&self.gpu, &mut source, &params)?;
            self.count_markers(&params, key, Some(budget));
            return Ok(());
        }
        self.adaptive.set_only(None);
        self.adaptive.set_settings(AdaptiveSettings {
            // Leaves out no patches that are drawn at rest, since holes that come and go would look
            // broken.
            lod: inputs.detail.lod().coarser(self.pace.coarser),
            smallest: inputs.detail.smallest,
            wireframe: params.look.wire > 0.0,
            ..AdaptiveSettings::default()
        });
        let halved = self.pace.coarser > HALF_FROM;
        if halved {
            params.size = params.size.map(|n| n.div_ceil(2));
            params.look.least_width *= 0.5;
        }
        let sub_pixels = if halved { 0.5 } else { 1.0 };
        let markers = self.markers.drawn(key, sub_pixels, Some(budget));
        let mut source = Combined::new(&mut self.adaptive)
            .with_markers(markers)
            .with_meshes(self.meshes.drawn());
        self.progressive.draft(&self.gpu, &mut source, &params)?;
        self.count_markers(&inputs.params, key, Some(budget));
        Ok(())
    }

    fn set_instances(&mut self, state: &State, key: InstancesKey) {
        self.content.instances = content::instances(state, &self.content.sources);
        let (templates, _) = self.adaptive.take_scene().into_parts();
        let instances = content::device_instances(&self.content.instances);
        match Scene::new(templates, instances) {
            Ok(scene) => self.adaptive.set_scene(scene),
            // Placements are always valid; if one should not be, everything is rebuilt.
            Err(_) => (self.on_device.colors, self.on_device.checked) = (None, None),
        }
        self.instances_are(key);
    }

    /// Notes the key of the content's instances.
    pub(super) fn instances_are(&mut self, key: InstancesKey) {
        self.on_device.shows = self.content.instances.iter().map(|s| !s.hidden).collect();
        self.on_device.instances = Some(key);
        self.rebuilds.instances += 1;
    }

    pub(super) fn set_states(&mut self, state: &State, key: StatesKey) {
        let mut states = content::states(&state.document);
        for neuron in state.document.neurons.selected().iter() {
            states[neuron] |= OUTLINED;
        }
        self.progressive.set_states(states);
        self.on_device.states = Some(key);
        self.rebuilds.states += 1;
    }

    /// Makes drafts coarser if they take too long, and finer if there is time.
    pub(super) fn keep_up(&mut self) {
        let took = self.progressive.last_ms();
        self.note_frame(took);
        if self.pace.explored {
            self.explorer.keep_up(took, DRAFT_MS);
        } else if took > 1.5 * DRAFT_MS {
            self.pace.coarser = (self.pace.coarser * 2.0).min(32.0);
        } else if took < 0.4 * DRAFT_MS {
            self.pace.coarser = (self.pace.coarser / 1.4).max(1.0);
        }
    }

    pub(super) fn note_frame(&mut self, took: f64) {
        self.pace.frames.push_back(took as f32);
        if self.pace.frames.len() > FRAMES {
            self.pace.frames.pop_front();
        }
    }
}
