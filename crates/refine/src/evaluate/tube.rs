//! Lateral patches, which are quarters of tubes: four at once, of one tube or of several.

use super::Points;
use super::center_line::CenterLines;
use super::corner::{Corners, Jets};
use super::edges::{OverLength, longer, mix, most_squared};
use super::four::{F32x4, Vec3x4};
use super::profile::{Profiles, Shares};
use crate::Path;

/// Four lateral patches ready to be evaluated row by row: their center lines, and what their corners' offsets and
/// radials change by along them, at x = 0 and 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tubes<'c> {
    corners: &'c [Corners; 4],
    line: CenterLines,
    profile: Profiles,
    offset_y: [Vec3x4; 2],
    radial_y: [Vec3x4; 2],
    /// The longest offset of the corners of each ring.
    longest: [F32x4; 2],
}

/// The points of four lateral patches with the same y: their centers, and the offsets and radials at x = 0 and 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TubeRow<'t> {
    tubes: &'t Tubes<'t>,
    center: Jets,
    offsets: [Vec3x4; 2],
    radials: [Vec3x4; 2],
    most_squared: F32x4,
    share: Shares,
}

impl<'c> Tubes<'c> {
    /// Of patches with these corners.
    #[inline(always)]
    pub(crate) fn new(corners: &'c [Corners; 4], path: Path) -> Self {
        let [a, b, c, d] = corners;
        let line = CenterLines::new(a, d, path);
        Self {
            corners,
            line,
            profile: Profiles::new(a, d, &line),
            offset_y: [d.offset - a.offset, c.offset - b.offset],
            radial_y: [d.radial - a.radial, c.radial - b.radial],
            longest: [longer(a.offset, b.offset), longer(d.offset, c.offset)],
        }
    }

    /// The points inside at this y ∈ (0, 1).
    #[inline(always)]
    pub(crate) fn row(&self, y: F32x4) -> TubeRow<'_> {
        let [a, b, c, d] = self.corners;
        TubeRow {
            tubes: self,
            center: self.line.at(y),
            offsets: [mix(a.offset, d.offset, y), mix(b.offset, c.offset, y)],
            radials: [mix(a.radial, d.radial, y), mix(b.radial, c.radial, y)],
            most_squared: most_squared(self.longest[0], self.longest[1], y),
            share: self.profile.share(y),
        }
    }

    /// The radii of the tubes (µm).
    #[inline(always)]
    pub(crate) fn radius(&self, y: F32x4) -> F32x4 {
        self.profile.radius(y)
    }
}

impl TubeRow<'_> {
    /// Points inside with their normals, x ∈ (0, 1).
    #[inline(always)]
    pub(crate) fn points(&self, x: F32x4) -> Points {
        let blend = |[at_0, at_1]: [Vec3x4; 2]| mix(at_0, at_1, x);
        let change = |[at_0, at_1]: [Vec3x4; 2]| at_1 - at_0;
        let (offset, radial) = (blend(self.offsets), blend(self.radials));
        let over = OverLength::of(radial);
        let most = self.most_squared;
        let around = over.jet(offset, change(self.offsets), change(self.radials));
        let around = around.within(most).around(self.share);
        let along = over.jet(
            offset,
            blend(self.tubes.offset_y),
            blend(self.tubes.radial_y),
        );
        let along = along.within(most).along(self.share);
        let normal = around
            .derivative
            .cross(self.center.derivative + along.derivative)
            .normalize_or_zero();
        Points {
            position: self.center.position + around.position,
            normal: self.outwards(normal, radial),
        }
    }

    /// Where a sharp bend folds the surface over, it gets the normal of a tube without the fold.
    #[inline(always)]
    fn outwards(&self, normal: Vec3x4, radial: Vec3x4) -> Vec3x4 {
        let is_outwards = normal.dot(radial).cmpgt(F32x4::ZERO);
        // Nearly always.
        if is_outwards.all() {
            return normal;
        }
        unfolded(normal, radial, self.tubes.corners[0].normal)
    }
}

/// `fallback`: for points without a radial.
#[cold]
fn unfolded(normal: Vec3x4, radial: Vec3x4, fallback: Vec3x4) -> Vec3x4 {
    let outwards = Vec3x4::select(radial.is_zero(), fallback, radial);
    let is_outwards = normal.dot(outwards).cmpgt(F32x4::ZERO);
    Vec3x4::select(is_outwards, normal, outwards.normalize_or(fallback))
}
