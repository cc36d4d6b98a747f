//! Sections of the file, collected while points are appended to a morphology.

use std::ops::Range;

use super::Node;
use crate::file_sections::parents_first;
use crate::{FileSection, FileSectionId, FileSections, Section, SectionId};

/// Collects sections of the file while points are appended to a morphology, section by section.
pub(super) struct Collector<'a> {
    known: &'a [FileSection],
    of_points: Vec<u32>,
    /// Of each of our sections with points that name no section of the file: its first node, and its index.
    untold: Vec<(u32, u32)>,
}

/// A point whose node names no section of the file.
const UNTOLD: u32 = u32::MAX;

impl<'a> Collector<'a> {
    /// `known`: the sections that nodes name. `points`: about how many there will be.
    pub(super) fn new(known: &'a [FileSection], points: usize) -> Self {
        Self {
            known,
            of_points: Vec::with_capacity(points),
            untold: Vec::new(),
        }
    }

    /// A point is appended.
    pub(super) fn push(&mut self, node: &Node) {
        let named = node.section.map(FileSectionId::index);
        let named = named.filter(|&named| named < self.known.len());
        self.of_points
            .push(named.map_or(UNTOLD, |named| named as u32));
    }

    /// One of our sections is complete. `first`: its first node.
    pub(super) fn end_section(&mut self, section: SectionId, points: Range<usize>, first: u32) {
        if self.of_points[points].contains(&UNTOLD) {
            self.untold.push((first, section.0));
        }
    }

    /// Sections that no node tells of come after the others, in the order of their first nodes, but none before its parent,
    /// as SONATA asks for.
    pub(super) fn finish(mut self, ours: &[Section]) -> FileSections {
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

    fn untold_in_file_order(&self, ours: &[Section]) -> Vec<u32> {
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
    use crate::file_sections::Piece;
    use crate::{Morphology, NeuriteKind};

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
