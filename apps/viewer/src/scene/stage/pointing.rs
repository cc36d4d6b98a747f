//! What is under the cursor, and the outlines around what is pointed at and selected.

use std::time::Duration;

use eframe::egui;
use neurotess::render::outline::Outlines;
use neurotess::render::pick::{PickHit, PickId, PickResolver, ProxyPickResolver};
use neurotess::render::{DeviceError, Look, ViewParams};

use super::Stage;
use crate::model::markers::MarkerRef;
use crate::model::revision::Revision;
use crate::model::state::{Picked, State};
use crate::scene::content;
use crate::scene::picks::{CursorHit, HitTarget, Picks, seen};

/// How outlines look: wider ones would hide thin neurites.
pub(crate) const OUTLINES: Outlines = Outlines {
    width: 1,
    selected: content::SELECTION,
    opacity: 1.0,
    // A color that no palette has for types of neurites: those are blue, red, purple, green and
    // gray.
    hovered: [0, 190, 170],
};

/// Opacity of outlines around neurons whose neurites are as thin as a pixel: full ones, on both sides of each, would
/// be all that one sees of their colors.
const THIN: f32 = 0.35;
/// Diameter (µm) of a usual neurite.
const USUAL: f64 = 1.0;
/// Pixels of its diameter from which outlines are full.
const WIDE: f64 = 5.0;

/// How outlines look in a view of so many neurons. Those in a crowd are full, since they must be found.
pub(super) fn outlines(params: &ViewParams, neurons: usize) -> Outlines {
    let pixel = params.camera.pixel_at_target(f64::from(params.size[1]));
    let share = ((USUAL / pixel - 1.0) / (WIDE - 1.0)).clamp(0.0, 1.0) as f32;
    let opacity = match neurons > Look::CROWD {
        true => 1.0,
        false => THIN + (1.0 - THIN) * share,
    };
    Outlines {
        opacity,
        ..OUTLINES
    }
}

/// Resolves picking ids of the picture that was drawn.
pub(super) enum Resolver {
    Refined(PickResolver),
    Explored(ProxyPickResolver),
}

impl Resolver {
    fn resolve(&self, id: PickId) -> Option<PickHit> {
        match self {
            Self::Refined(resolver) => resolver.resolve(id),
            Self::Explored(resolver) => resolver.resolve(id),
        }
    }
}

/// What is under the cursor, and outlined.
#[derive(Default)]
pub(super) struct Pointing {
    pub(super) picks: Option<Picks>,
    /// Whether `picks` belong to an earlier picture.
    pub(super) stale: bool,
    /// Whether they do not show what the current picture would, which has been passed over.
    pub(super) elsewhere: bool,
    /// Of ids that are still to arrive from the device.
    pub(super) resolver: Option<Resolver>,
    /// What outlines were drawn for.
    pub(super) mask: Option<MaskKey>,
}

/// What outlines depend on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MaskKey {
    hovered: Option<Picked>,
    picked: Option<Picked>,
    markers: [Option<MarkerRef>; 2],
    members: Revision,
    selection: Revision,
    params: ViewParams,
}

impl Stage {
    /// What is at a pixel. Nothing while something moves.
    pub fn hit_at(&self, x: f32, y: f32) -> Option<CursorHit> {
        let picks = self
            .pointing
            .picks
            .as_ref()
            .filter(|_| !self.pointing.elsewhere)?;
        picks.at(x, y)
    }

    /// The name of the opaque mesh at a pixel, where nothing else is. Nothing while something moves.
    pub fn mesh_at(&self, x: f32, y: f32) -> Option<&str> {
        let picks = self
            .pointing
            .picks
            .as_ref()
            .filter(|_| !self.pointing.stale)?;
        let shown = self.meshes.shown().get(picks.mesh_at(x, y)?)?;
        Some(shown.name())
    }

    /// Whether it is known what is at each pixel of the current picture.
    pub fn can_pick(&self) -> bool {
        self.pointing.picks.is_some() && !self.pointing.stale && !self.pointing.elsewhere
    }

    pub(super) fn take_ids(&mut self, ctx: &egui::Context) -> Result<(), DeviceError> {
        if self.pointing.resolver.is_none() {
            return Ok(());
        }
        // Called to poll the device, so that ids arrive.
        let _ = self.progressive.is_busy(&self.gpu);
        let Some((size, ids)) = self.progressive.ids()? else {
            ctx.request_repaint_after(Duration::from_millis(5));
            return Ok(());
        };
        let Some(resolver) = self.pointing.resolver.take() else {
            return Ok(());
        };
        let (content, markers, meshes) = (&self.content, &self.markers, &self.meshes);
        self.pointing.stale = false;
        let resolve = |id| {
            if let Some((marker, place)) = markers.picked(id) {
                let target = HitTarget::Marker(marker);
                return Some(CursorHit { target, place });
            }
            let hit = resolver.resolve(id)?;
            let instance = content.instances.get(hit.instance as usize)?;
            let source = content.sources.get(instance.source)?;
            seen(hit, &source.generated.mesh, &instance.placement)
        };
        self.pointing.picks = Some(Picks::new(size, &ids, resolve, |id| meshes.picked(id)));
        ctx.request_repaint();
        Ok(())
    }

    /// Updates the outlines around selected neurons and the part under the cursor, if those have
    /// changed.
    pub(super) fn outline(&mut self, state: &State) {
        let (Some(picks), Some(drawn), false) =
            (&self.pointing.picks, &self.drawn, self.pointing.stale)
        else {
            return;
        };
        let revisions = state.document.neurons.revisions();
        let key = MaskKey {
            hovered: state.pointing.hovered,
            picked: state.pointing.picked,
            markers: [state.pointing.hovered_marker, state.pointing.picked_marker],
            members: revisions.members,
            selection: revisions.selection,
            params: drawn.params,
        };
        if self.pointing.mask.as_ref() == Some(&key) {
            return;
        }
        let facts = |neuron: usize, section: u32| {
            let source = state.source_of(neuron)?;
            source.sections.get(section as usize).copied()
        };
        let mask = picks.mask(
            &state.document,
            [key.hovered, key.picked],
            key.markers,
            facts,
        );
        self.progressive.set_outlines(
            &self.gpu,
            outlines(&key.params, state.shown()),
            Some((picks.size(), &mask)),
        );
        self.progressive.show(&self.gpu);
        self.pointing.mask = Some(key);
    }
}
