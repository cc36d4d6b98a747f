//! Which boxes overlap: a tree of axis-aligned bounding boxes, halved at the median of the widest axis.

use std::ops::ControlFlow;

use glam::DVec3;

/// Boxes of a leaf.
const LEAF: usize = 4;

/// A box by its lowest and highest corner (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    /// Holds nothing.
    const EMPTY: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    /// Around two balls.
    pub(super) fn around(centers: [DVec3; 2], radius: f64) -> Self {
        Self {
            low: centers[0].min(centers[1]) - radius,
            high: centers[0].max(centers[1]) + radius,
        }
    }

    fn join(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }
}

/// A part of the tree.
#[derive(Debug)]
struct Part {
    bounds: Bounds,
    /// Where the tree goes on if this part is passed over: parts lie in the order of a walk.
    next: u32,
    /// The leaf's places in `order`; empty for a part of parts.
    leaf: std::ops::Range<u32>,
}

/// A tree of boxes.
#[derive(Debug, Default)]
pub(super) struct Boxes {
    bounds: Vec<Bounds>,
    order: Vec<u32>,
    parts: Vec<Part>,
}

impl Boxes {
    /// `listed`: numbers of the boxes that can be found.
    pub(super) fn new(bounds: Vec<Bounds>, listed: Vec<u32>) -> Self {
        let mut boxes = Self {
            bounds,
            order: listed,
            parts: Vec::new(),
        };
        if !boxes.order.is_empty() {
            boxes.build(0, boxes.order.len());
        }
        boxes
    }

    /// Adds the part of some places. Halves are within one of each other, so that this goes no deeper
    /// than the logarithm.
    fn build(&mut self, first: usize, end: usize) {
        let places = &self.order[first..end];
        let bound = |&i: &u32| self.bounds[i as usize];
        let whole = places.iter().map(bound).fold(Bounds::EMPTY, Bounds::join);
        let slot = self.parts.len();
        let is_leaf = end - first <= LEAF;
        self.parts.push(Part {
            bounds: whole,
            next: 0,
            leaf: if is_leaf {
                first as u32..end as u32
            } else {
                0..0
            },
        });
        if !is_leaf {
            let middle = (first + end) / 2;
            let axis = (whole.high - whole.low).max_position();
            let bounds = &self.bounds;
            self.order[first..end].select_nth_unstable_by(middle - first, |&a, &b| {
                let along = |i: u32| bounds[i as usize].middle()[axis];
                along(a).total_cmp(&along(b)).then(a.cmp(&b))
            });
            self.build(first, middle);
            self.build(middle, end);
        }
        self.parts[slot].next = self.parts.len() as u32;
    }

    pub(super) fn bounds(&self, number: u32) -> &Bounds {
        &self.bounds[number as usize]
    }

    /// Visits the boxes that overlap one, in an order that depends on the boxes alone, until told to stop.
    pub(super) fn overlapping(&self, with: &Bounds, mut visit: impl FnMut(u32) -> ControlFlow<()>) {
        let mut slot = 0;
        while let Some(part) = self.parts.get(slot) {
            if !part.bounds.overlaps(with) {
                slot = part.next as usize;
                continue;
            }
            let leaf = part.leaf.start as usize..part.leaf.end as usize;
            for &number in &self.order[leaf] {
                if self.bounds[number as usize].overlaps(with) && visit(number).is_break() {
                    return;
                }
            }
            slot += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;
    use proptest::prelude::*;

    use super::*;

    fn bounds() -> impl Strategy<Value = Bounds> {
        let point = || (-9.0..9.0, -9.0..9.0, -9.0..9.0).prop_map(|(x, y, z)| dvec3(x, y, z));
        (point(), point(), 0.0..2.0).prop_map(|(a, b, r)| Bounds::around([a, a + 0.3 * b], r))
    }

    proptest! {
        #[test]
        fn finds_what_a_look_at_each_finds(all in prop::collection::vec(bounds(), 1..80)) {
            let boxes = Boxes::new(all.clone(), (0..all.len() as u32).collect());
            for with in &all {
                let mut found = Vec::new();
                boxes.overlapping(with, |i| {
                    found.push(i);
                    ControlFlow::Continue(())
                });
                found.sort_unstable();
                let expected = (0..all.len() as u32).filter(|&i| all[i as usize].overlaps(with));
                prop_assert_eq!(found, expected.collect::<Vec<_>>());
            }
        }
    }
}
