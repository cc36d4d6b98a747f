//! Places where the surfaces of cells cross themselves, for a list that flies to each.

use std::sync::Arc;

use neurotess::union::{Kin, Place};

use crate::model::ids::SourceId;
use crate::model::revision::Revision;

/// A place where a cell's surface crosses itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The cell's tracing.
    pub source: SourceId,
    /// The place, in the tracing's own coordinates.
    pub place: Place,
}

impl Crossing {
    /// Branches through one another first, then bends and forks; each the deepest first.
    pub(crate) fn sort(list: &mut [Self]) {
        list.sort_by(|a, b| {
            let near = |c: &Self| c.place.kin == Kin::Near;
            let depths = b.place.depth.total_cmp(&a.place.depth);
            near(a).cmp(&near(b)).then(depths)
        });
    }

    /// Radius (µm) of what there is to see of it.
    pub(crate) fn reach(&self) -> f64 {
        self.place.depth.max(0.5)
    }
}

/// All crossings of some cells.
pub type Crossings = Arc<Vec<Crossing>>;

/// What a list of crossings depends on: the tracings, and the revision of their meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossingKey {
    pub(crate) sources: Vec<SourceId>,
    pub(crate) geometry: Revision,
}

/// The crossings of the selected cells, once they are found.
#[derive(Clone, Debug, Default)]
pub struct CrossingList {
    /// Whether they are asked for.
    pub open: bool,
    /// The newest list and what it is of, or why there is none.
    pub(crate) found: Option<(CrossingKey, Result<Crossings, String>)>,
    /// The one that was flown to last.
    pub(crate) pointed: Option<usize>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn branches_come_before_bends_and_the_deepest_first() {
        let crossing = |kin, depth| Crossing {
            source: SourceId(0),
            place: Place {
                position: glam::DVec3::ZERO,
                pairs: 1,
                points: [1, 2],
                sections: [1, 1],
                depth,
                relative_depth: 1.0,
                kin,
            },
        };
        let mut list = [
            crossing(Kin::Near, 3.0),
            crossing(Kin::Apart, 0.2),
            crossing(Kin::Apart, 1.0),
            crossing(Kin::Near, 4.0),
        ];
        Crossing::sort(&mut list);
        let depths = list.map(|c| c.place.depth);
        assert_eq!(depths, [1.0, 0.2, 4.0, 3.0]);
    }
}
