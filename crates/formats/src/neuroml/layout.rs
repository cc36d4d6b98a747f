//! How the segments of a cell hang together.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use neurotess_morphology::NeuriteKind;

use super::joints::{self, Joint};
use super::kinds;
use super::records::{Records, Segment};
use crate::Fault;
use crate::sample::Sample;
use crate::text::Located;

/// How segments hang together, by their index.
pub(super) struct Layout {
    /// Each one's parent.
    pub(super) parents: Vec<Option<usize>>,
    /// Parents before children.
    pub(super) order: Vec<usize>,
    pub(super) kinds: Vec<NeuriteKind>,
    /// Where each one begins and ends.
    pub(super) ends: Vec<[Sample; 2]>,
    /// How each one begins.
    pub(super) joints: Vec<Joint>,
    /// Where, within each one, others begin: sorted, neither 0 nor 1.
    pub(super) inner: Vec<Vec<f64>>,
    /// Line of the first that begins apart from its parent, and how many do.
    pub(super) gaps: Option<(u64, u64)>,
}

impl Layout {
    pub(super) fn of(records: &Records) -> Located<Self> {
        let parents = parents(&records.segments)?;
        let order = order(&records.segments, &parents)?;
        let mut layout = Self {
            kinds: kinds::kinds(records, &parents),
            ends: Vec::with_capacity(order.len()),
            joints: vec![Joint::None; order.len()],
            inner: vec![Vec::new(); order.len()],
            parents,
            order,
            gaps: None,
        };
        layout.join(&records.segments)?;
        Ok(layout)
    }

    /// Finds where segments begin.
    fn join(&mut self, segments: &[Segment]) -> Located<()> {
        let mut ends: Vec<Option<[Sample; 2]>> = vec![None; segments.len()];
        for &i in &self.order {
            let segment = &segments[i];
            let missing = |end| {
                let id = segment.id;
                (segment.line, Fault::NoEnd { id, end })
            };
            let distal = segment.distal.ok_or_else(|| missing("distal"))?;
            let parent = self.parents[i].and_then(|p| ends[p].map(|ends| (p, ends)));
            let Some((p, parents_ends)) = parent else {
                let proximal = segment.proximal.ok_or_else(|| missing("proximal"))?;
                ends[i] = Some([proximal, distal]);
                continue;
            };
            let named = segment.parent.map_or(1.0, |(_, along)| along);
            let kinds = [self.kinds[p], self.kinds[i]];
            let joint = joints::joint(parents_ends, named, segment.proximal, kinds);
            match joint {
                Joint::Along(along) if along > 0.0 && along < 1.0 => self.inner[p].push(along),
                Joint::Along(_) => {}
                Joint::None => {
                    let (first, count) = self.gaps.unwrap_or((segment.line, 0));
                    self.gaps = Some((first.min(segment.line), count + 1));
                }
            }
            self.joints[i] = joint;
            let [start, end] = parents_ends;
            let there = joints::along(&start, &end, named);
            ends[i] = Some([segment.proximal.unwrap_or(there), distal]);
        }
        for places in &mut self.inner {
            places.sort_by(f64::total_cmp);
            places.dedup();
        }
        self.ends = ends.into_iter().flatten().collect();
        Ok(())
    }
}

/// Index of each segment's parent.
fn parents(segments: &[Segment]) -> Located<Vec<Option<usize>>> {
    let mut index = HashMap::new();
    for (i, segment) in segments.iter().enumerate() {
        if let Some(first) = index.insert(segment.id, i) {
            let first_line = segments[first].line;
            let id = segment.id;
            return Err((segment.line, Fault::RepeatedSegment { id, first_line }));
        }
    }
    let parent = |segment: &Segment| {
        let Some((parent, _)) = segment.parent else {
            return Ok(None);
        };
        let id = segment.id;
        let unknown = (segment.line, Fault::UnknownSegment { id, parent });
        index.get(&parent).copied().map(Some).ok_or(unknown)
    };
    segments.iter().map(parent).collect()
}

/// Segments in the order of the file, which numbers sections, but none before its parent.
fn order(segments: &[Segment], parents: &[Option<usize>]) -> Located<Vec<usize>> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); segments.len()];
    for (i, parent) in parents.iter().enumerate() {
        if let Some(parent) = parent {
            children[*parent].push(i);
        }
    }
    let roots = (0..segments.len()).filter(|&i| parents[i].is_none());
    let mut open: BinaryHeap<Reverse<usize>> = roots.map(Reverse).collect();
    let mut order = Vec::with_capacity(segments.len());
    while let Some(Reverse(i)) = open.pop() {
        order.push(i);
        open.extend(children[i].iter().map(|&child| Reverse(child)));
    }
    if order.len() < segments.len() {
        let mut reached = vec![false; segments.len()];
        order.iter().for_each(|&i| reached[i] = true);
        let lost = reached.iter().position(|r| !r).unwrap_or(0);
        return Err((segments[lost].line, Fault::OwnAncestor));
    }
    Ok(order)
}
