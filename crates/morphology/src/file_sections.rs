//! Sections as the file of a tracing has them, beside ours.
//!
//! **Theory.** Other programs number sections by the file: by the order in which their first samples stand there. Ours
//! stand depth first, and an only child of its parent's type continues its section, so neither order nor number of both
//! lists need be the same. **Practice.** A point keeps the section of the file that it is from. Formats without sections,
//! as SWC, have ours, in the order of their first rows.

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use crate::{Attachment, FileSection, FileSections, Morphology, SectionId};

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
pub(crate) fn parents_first(keys: &[u32], parents: &[Option<u32>]) -> Vec<u32> {
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
