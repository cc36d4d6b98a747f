//! Facets of a refined surface, and whether two of them cross.
//!
//! In single precision, and without the exact predicates of [`neurotess_mesh::self_intersections`], which
//! has the last word.

use glam::Vec3;

/// Facets folded by more than this count: cosine of 120°.
const FOLDED: f32 = -0.5;

/// A triangle of a refined surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    /// Vertices' numbers.
    pub(crate) corners: [u32; 3],
    points: [Vec3; 3],
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
    /// Unit, or zero where the facet has no area.
    normal: Vec3,
}

impl Facet {
    pub(crate) fn new(corners: [u32; 3], points: [Vec3; 3]) -> Self {
        let [a, b, c] = points;
        Self {
            corners,
            points,
            low: a.min(b).min(c),
            high: a.max(b).max(c),
            normal: (b - a).cross(c - a).normalize_or_zero(),
        }
    }

    /// Whether two facets that share an edge are folded over.
    pub(crate) fn folds(&self, other: &Self) -> bool {
        self.normal.dot(other.normal) < FOLDED
    }

    /// Whether two facets cross. Those with a common edge do not: they may be folded.
    pub(crate) fn crosses(&self, other: &Self) -> bool {
        let overlap = self.low.cmple(other.high) & other.low.cmple(self.high);
        if !overlap.all() {
            return false;
        }
        let common = self.corners.iter().filter(|c| other.corners.contains(c));
        if common.count() > 1 {
            return false;
        }
        self.is_passed_by(other) || other.is_passed_by(self)
    }

    /// Height of a point over the facet's plane.
    fn height(&self, p: Vec3) -> f32 {
        (p - self.points[0]).dot(self.normal)
    }

    /// Whether a segment, whose ends are at these heights, passes through.
    fn is_passed(&self, [p, q]: [Vec3; 2], [from, to]: [f32; 2]) -> bool {
        if from * to >= 0.0 {
            return false;
        }
        let at = p + (q - p) * (from / (from - to));
        let inside = |k: usize| {
            let (a, b) = (self.points[k], self.points[(k + 1) % 3]);
            (b - a).cross(at - a).dot(self.normal)
        };
        (0..3).all(|k| inside(k) > 0.0)
    }

    /// Whether an edge of `other` passes through; a vertex that both have is on the plane.
    fn is_passed_by(&self, other: &Self) -> bool {
        let mut heights = other.points.map(|p| self.height(p));
        // Most lie on one side. That common vertices count as on the plane would not change it.
        if heights.iter().all(|&h| h > 0.0) || heights.iter().all(|&h| h < 0.0) {
            return false;
        }
        for (height, corner) in heights.iter_mut().zip(other.corners) {
            if self.corners.contains(&corner) {
                *height = 0.0;
            }
        }
        (0..3).any(|k| {
            let next = (k + 1) % 3;
            let edge = [other.points[k], other.points[next]];
            self.is_passed(edge, [heights[k], heights[next]])
        })
    }
}
