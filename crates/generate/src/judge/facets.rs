//! Facets of a refined surface, and whether two of them cross.
//!
//! In single precision, and without the exact predicates of [`neurotess_mesh::self_intersections`], which
//! has the last word.

use glam::{Vec3, Vec3A};

/// Facets folded by more than this count: cosine of 120°.
const FOLDED: f32 = -0.5;

/// A triangle of a refined surface.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Facet {
    /// Vertices' numbers.
    pub(crate) corners: [u32; 3],
    points: [Vec3A; 3],
    pub(crate) bounds: Bounds,
    /// Unit, or zero where the facet has no area.
    pub(crate) normal: Vec3A,
}

/// A box along the axes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounds {
    pub(crate) low: Vec3A,
    pub(crate) high: Vec3A,
}

impl Bounds {
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (self.low.cmple(other.high) & other.low.cmple(self.high)).all()
    }

    pub(crate) fn with(&self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

impl Facet {
    pub(crate) fn new(corners: [u32; 3], points: [Vec3; 3]) -> Self {
        let points = points.map(Vec3A::from);
        let [a, b, c] = points;
        Self {
            corners,
            points,
            bounds: Bounds {
                low: a.min(b).min(c),
                high: a.max(b).max(c),
            },
            normal: (b - a).cross(c - a).normalize_or_zero(),
        }
    }

    /// Whether two facets that share an edge are folded over.
    pub(crate) fn folds(&self, other: &Self) -> bool {
        self.normal.dot(other.normal) < FOLDED
    }

    /// Whether two facets cross. Those with a common edge do not: they may be folded.
    pub(crate) fn crosses(&self, other: &Self) -> bool {
        if !self.bounds.overlaps(&other.bounds) {
            return false;
        }
        let common = self.corners.iter().filter(|c| other.corners.contains(c));
        if common.count() > 1 {
            return false;
        }
        // Nearly all pairs end here: the line in which their planes meet lies in both, or they do not cross.
        let others = self.heights(other);
        if is_one_sided(others) {
            return false;
        }
        let own = other.heights(self);
        !is_one_sided(own) && (self.is_passed_by(other, others) || other.is_passed_by(self, own))
    }

    /// Heights of the corners of another facet over this one's plane; a vertex that both have is on it.
    fn heights(&self, other: &Self) -> [f32; 3] {
        let mut heights = other.points.map(|p| (p - self.points[0]).dot(self.normal));
        for (height, corner) in heights.iter_mut().zip(other.corners) {
            if self.corners.contains(&corner) {
                *height = 0.0;
            }
        }
        heights
    }

    /// Whether a segment, whose ends are at these heights, passes through.
    fn is_passed(&self, [p, q]: [Vec3A; 2], [from, to]: [f32; 2]) -> bool {
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

    /// Whether an edge of `other`, whose corners are at these heights, passes through.
    fn is_passed_by(&self, other: &Self, heights: [f32; 3]) -> bool {
        (0..3).any(|k| {
            let next = (k + 1) % 3;
            let edge = [other.points[k], other.points[next]];
            self.is_passed(edge, [heights[k], heights[next]])
        })
    }
}

/// Whether heights over a plane are on one side of it, or touch it. Where all are zero the plane is that of a
/// facet without area, or both facets are in it.
fn is_one_sided([a, b, c]: [f32; 3]) -> bool {
    let (least, most) = (a.min(b).min(c), a.max(b).max(c));
    (least >= 0.0) != (most <= 0.0)
}
