//! What a face shows of the cell: the one rule by which files and tables give a face a type, a section
//! and a tracing point.
//!
//! **The rule.** Corners know their tracing points; a face takes all three from one of its corners. With a corner
//! on a soma (section 0) that is this one. Otherwise it is a corner of the highest section, since sections are
//! numbered from the soma on, and the first rows of a branch are the branch's: so the area of a section is about what shows
//! of its cones. Refinement shifts the borders of lofts by half a row for this (`refine/src/evaluate/border.rs`). If all corners are of one section, it is the tracing point of two or three of
//! them; if these are three points, the first corner's.
//!
//! **Why not** the majority alone: a quad between two rings is two triangles, one with two corners on
//! the first ring, one with two on the second. The border between two sections would be a saw. By the
//! section it runs along a ring.

use std::borrow::Cow;

use crate::SurfaceVertex;

/// The section of somata.
const SOMA: i32 = 0;

/// What a face shows of the cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaceLabel {
    /// The file's own number of the tracing point.
    pub point: i32,
    /// Section: that of the morphology plus one; 0 for the soma.
    pub section: i32,
    /// SWC type.
    pub kind: i32,
}

impl FaceLabel {
    /// The label of a triangle; see the rule above. Quads have one for each of their two triangles.
    pub fn of(corners: [&SurfaceVertex; 3]) -> Self {
        let [a, b, c] = corners.map(|v| Self {
            point: v.point,
            section: v.section,
            kind: v.kind,
        });
        let shown = section_of([a, b, c].map(|label| label.section));
        if a.section == b.section && b.section == c.section && b == c {
            return b;
        }
        let first = [a, b, c].into_iter().find(|label| label.section == shown);
        first.unwrap_or(a)
    }
}

/// The section of a face whose corners are of these sections; those of walls are negative.
pub(crate) fn section_of<const N: usize>(corners: [i32; N]) -> i32 {
    let [low, high] = [i32::min, i32::max].map(|of| corners.into_iter().reduce(of).unwrap_or(SOMA));
    if low <= SOMA { low } else { high }
}

/// The type of walls within a cell, as SWC types are given.
pub const WALL: i32 = -1_000_000;

/// Codes from here on stand for types that are no positive numbers.
const FIRST_OTHER: i32 = 1_000_000;

/// The code of a type in files whose codes are positive: physical groups of Gmsh, facet markers of
/// TetGen. That is the SWC type itself; 1,000,000 for type 0 (undefined), and 1,000,000 + n for a
/// negative type −n.
pub fn region_code(kind: i32) -> i32 {
    match kind {
        1.. => kind,
        _ => FIRST_OTHER.saturating_add_unsigned(kind.unsigned_abs()),
    }
}

/// The SWC type of a code, the inverse of [`region_code`] for types below a million.
pub fn type_of_region(code: i32) -> i32 {
    match code {
        FIRST_OTHER.. => FIRST_OTHER - code,
        _ => code,
    }
}

/// The name of a type, as `--types` and `info` know it.
pub fn region_name(kind: i32) -> Cow<'static, str> {
    match kind {
        0 => "undefined".into(),
        1 => "soma".into(),
        2 => "axon".into(),
        3 => "basal_dendrite".into(),
        4 => "apical_dendrite".into(),
        WALL => "wall".into(),
        custom => format!("custom_{custom}").into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(section: i32, point: i32) -> SurfaceVertex {
        SurfaceVertex {
            section,
            point,
            kind: section + 1,
            ..SurfaceVertex::default()
        }
    }

    fn label(corners: [(i32, i32); 3]) -> (i32, i32, i32) {
        let [a, b, c] = corners.map(|(section, point)| vertex(section, point));
        let label = FaceLabel::of([&a, &b, &c]);
        (label.section, label.point, label.kind)
    }

    #[test]
    fn borders_belong_to_somata_and_to_children() {
        assert_eq!(label([(3, 9), (0, 1), (3, 9)]), (0, 1, 1));
        assert_eq!(label([(3, 9), (2, 8), (2, 7)]), (3, 9, 4));
        assert_eq!(label([(3, 9), (3, 9), (2, 7)]), (3, 9, 4));
    }

    #[test]
    fn walls_are_told_by_any_corner() {
        assert_eq!(label([(3, 9), (-1, 1), (0, 9)]), (-1, 1, 0));
    }

    #[test]
    fn within_a_section_most_corners_decide() {
        assert_eq!(label([(2, 5), (2, 6), (2, 6)]), (2, 6, 3));
        assert_eq!(label([(2, 6), (2, 5), (2, 6)]), (2, 6, 3));
        assert_eq!(label([(2, 5), (2, 6), (2, 7)]), (2, 5, 3));
    }

    #[test]
    fn codes_are_positive_and_come_back() {
        for kind in [-7, -1, 0, 1, 2, 4, 5, 16, 999_999] {
            assert!(region_code(kind) > 0);
            assert_eq!(type_of_region(region_code(kind)), kind);
        }
        assert!(region_code(i32::MIN) > 0);
    }
}
