//! Clamped neurons: drawn finely in both modes, also while the camera moves.
//!
//! Where the rest of the scene is drawn within a budget of triangles, they are left out there and refined, as a full
//! picture refines all neurons. They have a budget of their own.

use std::sync::Arc;

use neurotess::render::DeviceError;

use super::Stage;
use crate::model::revision::Revision;
use crate::model::state::State;
use crate::scene::content::InstancesKey;

/// Most patches of the clamped neurons that are drawn finely, by software. A cell of 2,000 points has some 9,000.
const SOFTWARE_PATCHES: u64 = 100_000;
/// The same on a graphics card.
const CARD_PATCHES: u64 = 1_000_000;

/// The clamped neurons that are drawn finely.
#[derive(Default)]
pub(super) struct Clamped {
    /// What they were found for.
    key: Option<(Revision, InstancesKey)>,
    /// Their indices, ascending.
    pub(super) fine: Arc<[usize]>,
}

impl Stage {
    /// Finds out which clamped neurons the budget has room for: those first in the list.
    ///
    /// # Errors
    /// The device reports an error.
    pub(super) fn update_clamped(
        &mut self,
        state: &mut State,
        instances: InstancesKey,
    ) -> Result<(), DeviceError> {
        let neurons = &state.document.neurons;
        let key = Some((neurons.revisions().clamped, instances));
        if self.clamped.key != key {
            let most = match self.gpu.adapter.software {
                true => SOFTWARE_PATCHES,
                false => CARD_PATCHES,
            };
            let patches = |index: usize| {
                let instance = self.content.instances.get(index)?;
                let source = self.content.sources.get(instance.source)?;
                let patches = source.generated.mesh.patches.len() as u64;
                (!instance.hidden).then_some(patches)
            };
            let clamped = neurons.clamped().iter();
            let shown = clamped.filter_map(|index| Some((index, patches(index)?)));
            self.clamped = Clamped {
                key,
                fine: fitting(shown, most).into(),
            };
            if !self.clamped.fine.is_empty() {
                self.bring(&[])?;
            }
        }
        let all = state.document.neurons.clamped().len();
        state.drawing.counters.clamped = [self.clamped.fine.len(), all];
        Ok(())
    }

    /// The clamped neurons that are drawn finely beside those that are explored, or none.
    pub(super) fn fine(&self, explored: bool) -> Arc<[usize]> {
        match explored {
            true => Arc::clone(&self.clamped.fine),
            false => Arc::default(),
        }
    }
}

/// Those that have room, each with its patches, within so many.
fn fitting(all: impl Iterator<Item = (usize, u64)>, most: u64) -> Vec<usize> {
    let mut left = most;
    let mut fits = |&(_, patches): &(usize, u64)| {
        let rest = left.checked_sub(patches);
        left = rest.unwrap_or(left);
        rest.is_some()
    };
    all.filter(|one| fits(one))
        .map(|(index, _)| index)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_that_have_room_are_fine() {
        let all = [(2, 40), (3, 70), (7, 60), (9, 0)];
        assert_eq!(fitting(all.into_iter(), 100), [2, 7, 9]);
        assert_eq!(fitting(all.into_iter(), 39), [9]);
        assert_eq!(fitting(all.into_iter(), 1000), [2, 3, 7, 9]);
    }
}
