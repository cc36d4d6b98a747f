//! Sections as the file of a tracing has them, beside ours.
//!
//! **Theory.** Other programs number sections by the file: by the order in which their first samples stand there. Ours
//! stand depth first, and an only child of its parent's type continues its section, so neither order nor number of both
//! lists need be the same. **Practice.** A point keeps the section of the file that it is from. Formats without sections,
//! as SWC, have ours, in the order of their first rows.

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::num::NonZeroU32;
use std::ops::Range;

use crate::{Attachment, Morphology, NeuriteKind, Node, SectionId};

/// The sections of a file, and which points are from which.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileSections {
    /// In the order of the file. Those whose points were taken away by an edit stay, so that the others keep their numbers.
    pub sections: Vec<FileSection>,
    /// By point: index in `sections`. Empty where a morphology was not made from nodes: then sections of the file are
    /// ours.
    pub of_points: Vec<u32>,
    /// Whether the format has sections; otherwise they are ours, in the order of their first samples in the file.
    pub told: bool,
}

/// Index of a section in the file that a node is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileSectionId(NonZeroU32);

impl FileSectionId {
    /// The section of this index; none of the last number that 32 bits hold.
    pub fn new(index: u32) -> Option<Self> {
        NonZeroU32::new(index.wrapping_add(1)).map(Self)
    }

    /// Index in [`FileSections::sections`].
    pub fn index(self) -> usize {
        self.0.get() as usize - 1
    }
}

/// A section as the file has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileSection {
    /// Its type.
    pub kind: NeuriteKind,
    /// Index of the file's section that it hangs on; none on a soma, or on nothing.
    pub parent: Option<u32>,
    /// Whether it has no point but a copy of the one that it branches from.
    pub empty: bool,
}

/// A stretch of one of our sections that is, or belongs to, one section of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Our section.
    pub section: SectionId,
    /// Index in [`FileSections::sections`].
    pub file_section: u32,
    /// Its points; never empty.
    pub points: Range<usize>,
}

impl Piece {
    /// Index of the point that it branches from, or continues.
    pub fn branch_point(&self, morphology: &Morphology) -> Option<usize> {
        let section = &morphology.sections[self.section.index()];
        if self.points.start > section.range().start {
            return Some(self.points.start - 1);
        }
        let parent = section.parent()?;
        Some(morphology.sections[parent.index()].range().end - 1)
    }

    /// What it hangs on, if that is no other piece.
    pub fn attachment(&self, morphology: &Morphology) -> Option<Attachment> {
        let section = &morphology.sections[self.section.index()];
        let begins = self.points.start == section.range().start && section.parent().is_none();
        begins.then_some(section.attachment)
    }
}

impl Morphology {
    /// Its [`file_sections`](Self::file_sections); its own sections where a file gave none.
    pub fn known_file_sections(&self) -> Cow<'_, FileSections> {
        if self.file_sections.of_points.len() == self.points.len() {
            return Cow::Borrowed(&self.file_sections);
        }
        let own = |section: &crate::Section| FileSection {
            kind: section.kind,
            parent: section.parent().map(|parent| parent.0),
            empty: false,
        };
        let of_points = (0..).zip(&self.sections);
        Cow::Owned(FileSections {
            sections: self.sections.iter().map(own).collect(),
            of_points: of_points
                .flat_map(|(index, section)| section.range().map(move |_| index))
                .collect(),
            told: false,
        })
    }

    /// Takes its own sections, depth first, for those of a file: for what is grown, not read.
    pub fn number_sections_depth_first(&mut self) {
        self.file_sections = FileSections::default();
        self.file_sections = self.known_file_sections().into_owned();
    }

    /// The pieces of our sections, in the order of the points.
    pub fn pieces(&self) -> Vec<Piece> {
        let known = self.known_file_sections();
        let of_section = |(index, section): (usize, &crate::Section)| {
            let range = section.range();
            let runs = known.of_points[range.clone()].chunk_by(|a, b| a == b);
            let mut start = range.start;
            let piece = move |run: &[u32]| {
                let points = start..start + run.len();
                start = points.end;
                Piece {
                    section: SectionId(index as u32),
                    file_section: run[0],
                    points,
                }
            };
            runs.map(piece).collect::<Vec<_>>()
        };
        self.sections
            .iter()
            .enumerate()
            .flat_map(of_section)
            .collect()
    }

    /// The pieces in the order in which the file has them, but parents before what hangs on them: the order in which a file
    /// that is written numbers them as the one that was read.
    pub fn pieces_in_file_order(&self) -> Vec<Piece> {
        let pieces = self.pieces();
        let mut ending_at = vec![u32::MAX; self.points.len()];
        for (piece, index) in pieces.iter().zip(0..) {
            ending_at[piece.points.end - 1] = index;
        }
        let parent = |piece: &Piece| piece.branch_point(self).map(|point| ending_at[point]);
        let parents: Vec<Option<u32>> = pieces.iter().map(parent).collect();
        let keys: Vec<u32> = pieces.iter().map(|piece| piece.file_section).collect();
        let order = parents_first(&keys, &parents);
        let mut pieces: Vec<Option<Piece>> = pieces.into_iter().map(Some).collect();
        let take = |&piece: &u32| pieces[piece as usize].take();
        order.iter().filter_map(take).collect()
    }
}

/// Indices of a forest, of all whose parents were taken the one with the least key, then the first, next.
fn parents_first(keys: &[u32], parents: &[Option<u32>]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..keys.len() as u32).collect();
    let in_order = |(child, parent): (&u32, &Option<u32>)| {
        parent.is_none_or(|parent| keys[parent as usize] <= *child)
    };
    if keys.iter().zip(parents).all(in_order) {
        order.sort_by_key(|&index| keys[index as usize]);
        return order;
    }
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); keys.len()];
    let mut open = BinaryHeap::new();
    let key = |index: u32| Reverse((keys[index as usize], index));
    for (index, &parent) in (0..).zip(parents) {
        match parent {
            Some(parent) => children[parent as usize].push(index),
            None => open.push(key(index)),
        }
    }
    order.clear();
    while let Some(Reverse((_, index))) = open.pop() {
        order.push(index);
        open.extend(children[index as usize].iter().map(|&child| key(child)));
    }
    order
}

/// Collects sections of the file while points are appended to a morphology, section by section.
pub(crate) struct Collector<'a> {
    known: &'a [FileSection],
    of_points: Vec<u32>,
    /// Of each of our sections with points that name no section of the file: its first node, and its index.
    untold: Vec<(u32, u32)>,
}

/// A point whose node names no section of the file.
const UNTOLD: u32 = u32::MAX;

impl<'a> Collector<'a> {
    /// `known`: the sections that nodes name. `points`: about how many there will be.
    pub(crate) fn new(known: &'a [FileSection], points: usize) -> Self {
        Self {
            known,
            of_points: Vec::with_capacity(points),
            untold: Vec::new(),
        }
    }

    /// A point is appended.
    pub(crate) fn push(&mut self, node: &Node) {
        let named = node.section.map(FileSectionId::index);
        let named = named.filter(|&named| named < self.known.len());
        self.of_points
            .push(named.map_or(UNTOLD, |named| named as u32));
    }

    /// One of our sections is complete. `first`: its first node.
    pub(crate) fn end_section(&mut self, section: SectionId, points: Range<usize>, first: u32) {
        if self.of_points[points].contains(&UNTOLD) {
            self.untold.push((first, section.0));
        }
    }

    /// Sections that no node tells of come after the others, in the order of their first nodes, but none before its parent,
    /// as SONATA asks for.
    pub(crate) fn finish(mut self, ours: &[crate::Section]) -> FileSections {
        let untold = self.untold_in_file_order(ours);
        let mut sections = self.known.to_vec();
        for &section in &untold {
            let section = &ours[section as usize];
            let index = sections.len() as u32;
            for of_point in &mut self.of_points[section.range()] {
                if *of_point == UNTOLD {
                    *of_point = index;
                }
            }
            sections.push(FileSection {
                kind: section.kind,
                parent: None,
                empty: false,
            });
        }
        for (own, &section) in (self.known.len()..).zip(&untold) {
            let parent = ours[section as usize].parent();
            let last = parent.map(|parent| ours[parent.index()].range().end - 1);
            sections[own].parent = last.map(|last| self.of_points[last]);
        }
        FileSections {
            sections,
            of_points: self.of_points,
            told: !self.known.is_empty(),
        }
    }

    fn untold_in_file_order(&self, ours: &[crate::Section]) -> Vec<u32> {
        let mut place = vec![u32::MAX; ours.len()];
        for (&(_, section), index) in self.untold.iter().zip(0..) {
            place[section as usize] = index;
        }
        let parent = |&(_, section): &(u32, u32)| {
            let parent = ours[section as usize].parent()?;
            Some(place[parent.index()]).filter(|&place| place != u32::MAX)
        };
        let parents: Vec<Option<u32>> = self.untold.iter().map(parent).collect();
        let firsts: Vec<u32> = self.untold.iter().map(|&(first, _)| first).collect();
        let order = parents_first(&firsts, &parents).into_iter();
        order.map(|index| self.untold[index as usize].1).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn cell(rows: &[(i64, i32, Option<u32>)]) -> Morphology {
        let node = |(i, &(id, kind, parent)): (usize, &(i64, i32, Option<u32>))| Node {
            id,
            kind: NeuriteKind(kind),
            position: DVec3::new(i as f64, 0.0, 0.0),
            radius: 1.0,
            parent,
            section: None,
        };
        let nodes: Vec<Node> = rows.iter().enumerate().map(node).collect();
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        built.expect("a cell").morphology
    }

    #[test]
    fn sections_of_rows_stand_in_the_order_of_their_first_rows() {
        // A soma, a trunk that forks, and the children's points row by row.
        let breadth_first = cell(&[
            (1, 1, None),
            (2, 3, Some(0)),
            (3, 3, Some(1)),
            (4, 3, Some(1)),
            (5, 3, Some(2)),
            (6, 3, Some(3)),
            (7, 3, Some(4)),
            (8, 3, Some(4)),
        ]);
        assert_eq!(breadth_first.sample_ids, [2, 3, 5, 7, 8, 4, 6]);
        assert_eq!(breadth_first.file_sections.of_points, [0, 1, 1, 3, 4, 2, 2]);
        let ids = |pieces: Vec<Piece>| -> Vec<Vec<i64>> {
            let ids = |piece: Piece| breadth_first.sample_ids[piece.points].to_vec();
            pieces.into_iter().map(ids).collect()
        };
        let expected = [&[2][..], &[3, 5], &[4, 6], &[7], &[8]];
        assert_eq!(ids(breadth_first.pieces_in_file_order()), expected);
        let parents = breadth_first
            .file_sections
            .sections
            .iter()
            .map(|s| s.parent);
        assert_eq!(
            parents.collect::<Vec<_>>(),
            [None, Some(0), Some(0), Some(1), Some(1)]
        );
    }

    #[test]
    fn parents_come_first_where_the_file_has_them_later() {
        // The child's row stands above its parent's.
        let late = cell(&[
            (9, 3, Some(1)),
            (4, 3, None),
            (7, 3, Some(1)),
            (8, 3, Some(0)),
        ]);
        assert_eq!(late.file_sections.of_points, [0, 1, 1, 2]);
        let sections = late.pieces_in_file_order();
        let order: Vec<u32> = sections.iter().map(|piece| piece.file_section).collect();
        assert_eq!(order, [0, 1, 2]);
    }
}
