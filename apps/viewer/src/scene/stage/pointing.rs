//! What is under the cursor, and the outlines around what is pointed at and selected.

use std::time::Duration;

use eframe::egui;
use neurotess::render::outline::Outlines;
use neurotess::render::pick::{PickHit, PickId, PickResolver, ProxyPickResolver};
use neurotess::render::{DeviceError, ViewParams};

use super::Stage;
use crate::model::revision::Revision;
use crate::model::state::{Picked, State};
use crate::scene::content;
use crate::scene::picks::{CursorHit, Picks, seen};

/// Wider lines would drown thin neurites.
pub(crate) const OUTLINES: Outlines = Outlines {
    width: 1,
    selected: content::SELECTION,
    // No palette has it: types of neurites are blue, red, purple, green and gray.
    hovered: [0, 190, 170],
};

/// What ids mean.
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

/// What outlines depend on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MaskKey {
    hovered: Option<Picked>,
    picked: Option<Picked>,
    members: Revision,
    selection: Revision,
    params: ViewParams,
}

impl Stage {
    /// What is seen at a pixel. Nothing while things move.
    pub fn hit_at(&self, x: f32, y: f32) -> Option<CursorHit> {
        self.picks.as_ref()?.at(x, y)
    }

    /// Whether it is known what is where.
    pub fn can_pick(&self) -> bool {
        self.picks.is_some() && !self.picks_stale
    }

    pub(super) fn take_ids(&mut self, ctx: &egui::Context) -> Result<(), DeviceError> {
        if self.resolver.is_none() {
            return Ok(());
        }
        // Polls the device.
        let _ = self.progressive.is_busy(&self.gpu);
        let Some((size, ids)) = self.progressive.ids()? else {
            ctx.request_repaint_after(Duration::from_millis(5));
            return Ok(());
        };
        let Some(resolver) = self.resolver.take() else {
            return Ok(());
        };
        let content = &self.content;
        self.picks_stale = false;
        self.picks = Some(Picks::new(size, &ids, |id| {
            let hit = resolver.resolve(id)?;
            let instance = content.instances.get(hit.instance as usize)?;
            let source = content.sources.get(instance.source)?;
            seen(hit, &source.generated.mesh, &instance.placement)
        }));
        ctx.request_repaint();
        Ok(())
    }

    /// Outlines around what is selected and hovered, when that has changed.
    pub(super) fn outline(&mut self, state: &State) {
        let (Some(picks), Some(drawn), false) = (&self.picks, &self.drawn, self.picks_stale) else {
            return;
        };
        let revisions = state.document.neurons.revisions();
        let key = MaskKey {
            hovered: state.hovered,
            picked: state.picked,
            members: revisions.members,
            selection: revisions.selection,
            params: drawn.params,
        };
        if self.mask.as_ref() == Some(&key) {
            return;
        }
        let facts = |neuron: usize, section: u32| {
            let source = state.source_of(neuron)?;
            source.sections.get(section as usize).copied()
        };
        let mask = picks.mask(&state.document, state.hovered, state.picked, facts);
        self.progressive
            .set_outlines(&self.gpu, OUTLINES, Some((picks.size(), &mask)));
        self.progressive.show(&self.gpu);
        self.mask = Some(key);
    }
}
