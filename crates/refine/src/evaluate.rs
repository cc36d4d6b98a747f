//! The refined surface as a function: edges, patches, normals.
//!
//! **Theory.** García-Cantero et al. 2017, eq. 1 and 2: a point of a tube is `v = c + r n̂`, with
//! the center c on a cubic Hermite curve between two tracing points, r and n̂ interpolated and n̂
//! renormalized so that the tube does not pinch. We interpolate the offsets d = v − c of the four
//! corners and divide by the length of the interpolated unit normals,
//!
//! `v(x, y) = c(y) + Σ wᵢ dᵢ / |Σ wᵢ n̂ᵢ|`,
//!
//! which is the same for circles and makes a quarter of an ellipse where a joint's vertices lie
//! at different distances. Along the tube the second term is multiplied so that the radius is not linear but a
//! monotone cubic (`profile.rs`): so its slope does not jump at tracing points. Somata are bilinearly blended Coons patches over four cubics made from
//! the corners' positions and normals (Vlachos et al., Curved PN triangles, 2001, for the cubics).
//!
//! Around an inset, where a branch leaves a quad of its trunk, lie four lofts: at each x a cubic that
//! leaves the trunk's side within the trunk's tangent plane and arrives at the inset's side along the
//! branch. So the branch meets its trunk in a fillet, whatever the angle between them.
//!
//! **Conformity.** A point of an edge depends on the edge alone: two corners and their tracing
//! points, always taken in the edge's own direction. So faces that share an edge agree to the bit.

mod border;
mod center_line;
mod corner;
mod edges;
mod four;
mod profile;
mod tube;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind};

use crate::fours::four;
use crate::{Caps, Path, RefineOptions};
pub(crate) use border::{
    BORDER_CUBIC, CLEAR_OF_ROWS, LEAST_LIFT, along_border, loft_border, shift,
};
pub(crate) use center_line::{CenterLines, MAX_SWAY, hermite_tangents};
pub(crate) use corner::{Corners, Jets};
pub use edges::SOMA_FILLET;
pub(crate) use edges::{
    EdgeCurves, EdgeKind, EdgeNormals, MAX_OFFSET, loft_controls, soma_controls,
};
use edges::{OverLength, cubic, first_leg, mix};
pub(crate) use four::{F32x4, Vec3x4};
pub(crate) use profile::{Profiles, STEEPEST_PROFILE};
pub(crate) use tube::Tubes;

/// A patch ready to be evaluated inside, at four points at once. Lateral ones are [`Tubes`], of which four patches are
/// evaluated at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchShape {
    pub(crate) kind: PatchKind,
    /// Each four times.
    pub(crate) corners: [Corners; 4],
    /// By side: the kind of its edge, and whether the edge runs against the patch's coordinate.
    pub(crate) sides: [(EdgeKind, bool); 4],
    /// The mean of the corners' normals.
    mean_normal: Vec3x4,
}

/// Corners at the start and end of each side, along the patch's coordinates: sides 0 and 2 along x
/// at y = 0 and 1, sides 1 and 3 along y at x = 1 and 0.
pub(crate) const SIDES: [(usize, usize); 4] = [(0, 1), (1, 2), (3, 2), (0, 3)];

/// Four points inside patches, or on sides, with their normals.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points {
    pub(crate) position: Vec3x4,
    pub(crate) normal: Vec3x4,
}

/// What the points of a patch with the same four x have in common.
#[derive(Clone, Copy, Debug)]
enum Columns {
    /// Points of sides 0 and 2.
    Coons([Points; 2]),
    /// Controls of the cubics from side 0 to side 2, and their derivatives by x.
    Loft {
        across: [Vec3x4; 4],
        by_x: [Vec3x4; 4],
    },
}

/// What the points with the same y have in common, of four of them: of a Coons patch, points of sides 3 and 1.
type Rows = Option<[Points; 2]>;

impl PatchShape {
    pub(crate) fn new(mesh: &CoarseMesh, patch: usize, sides: [(EdgeKind, bool); 4]) -> Self {
        let neurotess_mesh::Patch { kind, corners } = mesh.patches[patch];
        Self::of_corners(kind, corners.map(|v| Corners::new(mesh, [v; 4])), sides)
    }

    fn of_corners(kind: PatchKind, corners: [Corners; 4], sides: [(EdgeKind, bool); 4]) -> Self {
        let sum = corners.iter().fold(Vec3x4::ZERO, |sum, k| sum + k.normal);
        Self {
            kind,
            corners,
            sides,
            mean_normal: sum.normalize_or(Vec3x4::splat(Vec3::Y)),
        }
    }

    /// A point inside with its normal, x and y ∈ (0, 1).
    pub(crate) fn interior(&self, options: &RefineOptions, x: f32, y: f32) -> (Vec3, Vec3) {
        let [x, y] = [x, y].map(F32x4::splat);
        let Points { position, normal } = match self.kind {
            PatchKind::Lateral => Tubes::new(&self.corners, options.path).row(y).points(x),
            _ => {
                let columns = self.columns(options.path, x);
                self.points(options.caps, (&columns, x), (&self.rows(y), y, 0))
            }
        };
        (position.each()[0], normal.each()[0])
    }

    /// The radius of the tube (µm) here; linear between corners of other patches.
    pub(crate) fn radius(&self, options: &RefineOptions, x: f32, y: f32) -> f32 {
        let [x, y] = [x, y].map(F32x4::splat);
        let radius = match self.kind {
            PatchKind::Lateral => Tubes::new(&self.corners, options.path).radius(y),
            _ => {
                let [near, far] = self.radii(x);
                near * (1.0 - y) + far * y
            }
        };
        radius.x
    }

    /// The y from which on vertices of a loft of so many rows show the branch.
    pub(crate) fn border(&self, x: F32x4, rows: u32) -> F32x4 {
        let [a, b, c, d] = &self.corners;
        loft_border([a, b, c, d], x) + shift(a, c, rows as f32)
    }

    /// The radii at sides 0 and 2.
    fn radii(&self, x: F32x4) -> [F32x4; 2] {
        let [a, b, c, d] = four(|k| self.corners[k].radius);
        [a * (1.0 - x) + b * x, d * (1.0 - x) + c * x]
    }

    /// Calls `put` with column i, row j, the points and the radii (µm) there for all columns i to i + 3 and rows inside
    /// a grid of `nx` by `ny` cells. Columns from `nx` on are none of the grid. Not for lateral patches.
    pub(crate) fn for_each_inside(
        &self,
        options: &RefineOptions,
        [nx, ny]: [u32; 2],
        mut put: impl FnMut([u32; 2], Points, F32x4),
    ) {
        let from =
            |first: u32, n: u32| F32x4::from_array(four(|k| (first + k as u32) as f32 / n as f32));
        for i in (1..nx).step_by(4) {
            let x = from(i, nx);
            let columns = self.columns(options.path, x);
            let [near, far] = self.radii(x);
            for first in (1..ny).step_by(4) {
                let rows = self.rows(from(first, ny));
                for j in first..ny.min(first + 4) {
                    let y = F32x4::splat(j as f32 / ny as f32);
                    let row = (&rows, y, (j - first) as usize);
                    let points = self.points(options.caps, (&columns, x), row);
                    put([i, j], points, near * (1.0 - y) + far * y);
                }
            }
        }
    }

    fn columns(&self, path: Path, x: F32x4) -> Columns {
        match self.kind {
            PatchKind::Loft => self.loft(path, x),
            _ => Columns::Coons([0, 2].map(|side| self.coons_side(side, x))),
        }
    }

    fn rows(&self, y: F32x4) -> Rows {
        (self.kind != PatchKind::Loft).then(|| [3, 1].map(|side| self.coons_side(side, y)))
    }

    /// At four x, and the same y four times, which is the k-th of `rows`.
    fn points(
        &self,
        caps: Caps,
        (columns, x): (&Columns, F32x4),
        (rows, y, k): (&Rows, F32x4, usize),
    ) -> Points {
        match (columns, rows) {
            (Columns::Coons([near, far]), Some([left, right])) => {
                let [left, right] = [left, right].map(|side| Points {
                    position: side.position.only(k),
                    normal: side.normal.only(k),
                });
                let position = self.coons([near, &right, far, &left].map(|p| p.position), x, y);
                match self.kind {
                    PatchKind::Cap => self.cap(caps, position),
                    _ => {
                        let normal = mix(near.normal, far.normal, y) * (x * (1.0 - x))
                            + mix(left.normal, right.normal, x) * (y * (1.0 - y));
                        Points {
                            position,
                            normal: normal.normalize_or(self.mean_normal),
                        }
                    }
                }
            }
            (Columns::Loft { across, by_x }, _) => {
                let (across, by_x) = (cubic(*across, y), cubic(*by_x, y));
                let normal = by_x.position.cross(across.derivative);
                Points {
                    position: across.position,
                    normal: normal.normalize_or(self.mean_normal),
                }
            }
            (Columns::Coons(_), None) => unreachable!("Coons patches have rows"),
        }
    }

    /// Points of a side.
    pub(crate) fn side(&self, side: usize, path: Path, t: F32x4) -> Jets {
        let (from, to) = SIDES[side];
        let (a, b) = (&self.corners[from], &self.corners[to]);
        let (kind, reversed) = self.sides[side];
        if reversed {
            let jets = EdgeCurves::new(kind, b, a, path).at(1.0 - t);
            Jets {
                derivative: -jets.derivative,
                ..jets
            }
        } else {
            EdgeCurves::new(kind, a, b, path).at(t)
        }
    }

    /// At each x a cubic from the trunk's side to the inset's: [`loft_controls`] between points of the
    /// two sides, with its derivatives.
    fn loft(&self, path: Path, x: F32x4) -> Columns {
        let [a, b, c, _] = &self.corners;
        let (near, far) = (self.side(0, path, x), self.side(2, path, x));
        let way = far.position - near.position;
        let way_x = far.derivative - near.derivative;
        let mixed = mix(a.cubic_normal(), b.cubic_normal(), x);
        let mixed_x = b.cubic_normal() - a.cubic_normal();
        let normal = OverLength::of(mixed).jet(mixed, mixed_x, mixed_x);
        let rise = way.dot(normal.position);
        let rise_x = way_x.dot(normal.position) + way.dot(normal.derivative);
        let over = way - normal.position * rise;
        let over_x = way_x - normal.derivative * rise - normal.position * rise_x;
        let (share, share_x) = first_leg(a, c, over, over_x);
        let (leave, leave_x) = (over * share, over_x * share + over * share_x);
        let third = way.length() / 3.0;
        let arrive = c.tangent * c.collar.max(-third).min(third);
        let third_x = way.dot(way_x) / (9.0 * third).max(F32x4::splat(f32::MIN_POSITIVE));
        let arrive_x = Vec3x4::select(
            third.cmplt(c.collar.abs()),
            c.tangent * (third_x * c.collar.signum()),
            Vec3x4::ZERO,
        );
        Columns::Loft {
            across: [
                near.position,
                near.position + leave,
                far.position - arrive,
                far.position,
            ],
            by_x: [
                near.derivative,
                near.derivative + leave_x,
                far.derivative - arrive_x,
                far.derivative,
            ],
        }
    }

    /// Bilinearly blended Coons patch between points of its sides. Its normal is that of the sides, the nearer one
    /// more: that of the surface jumps at the sides, which shows as lines where a ring pulls a soma out.
    fn coons(&self, [near, right, far, left]: [Vec3x4; 4], x: F32x4, y: F32x4) -> Vec3x4 {
        let [a, b, c, d] = four(|k| self.corners[k].position);
        mix(near, far, y) + mix(left, right, x) - mix(mix(a, b, x), mix(d, c, x), y)
    }

    /// Points of a side of a Coons patch, with normals where it needs them: that of a cap has its own.
    fn coons_side(&self, side: usize, t: F32x4) -> Points {
        let jets = self.side(side, Path::Hermite, t);
        Points {
            position: jets.position,
            normal: match self.kind {
                PatchKind::Cap => Vec3x4::ZERO,
                _ => self.side_normal(side, &jets, t),
            },
        }
    }

    fn side_normal(&self, side: usize, jets: &Jets, t: F32x4) -> Vec3x4 {
        let (from, to) = SIDES[side];
        let (kind, _) = self.sides[side];
        EdgeNormals::new(kind, &self.corners[from], &self.corners[to]).at(jets.derivative, t)
    }

    /// The end of a tube: a disk, or the half sphere over it, whose polar angle grows with the
    /// distance from the disk's center.
    fn cap(&self, caps: Caps, flat: Vec3x4) -> Points {
        let [a, b, _, d] = &self.corners;
        let tangent = a.tangent;
        let outwards = (b.offset - a.offset).cross(d.offset - a.offset);
        let is_against = outwards.dot(tangent).cmplt(F32x4::ZERO);
        let axis = Vec3x4::select(is_against, -tangent, tangent);
        if caps == Caps::Flat {
            return Points {
                position: flat,
                normal: axis,
            };
        }
        let radius = a.offset.length();
        let across = flat - a.center;
        let share = across.length() / radius.max(F32x4::splat(f32::MIN_POSITIVE));
        let share = share.min(F32x4::ONE);
        let angle = share * std::f32::consts::FRAC_PI_2;
        // Of libm, since those of platforms differ in the last bit.
        let each = |of: fn(f32) -> f32| F32x4::from_array(angle.to_array().map(of));
        let stretch = F32x4::select(
            share.cmpgt(F32x4::splat(1e-4)),
            each(libm::sinf) / share,
            F32x4::splat(std::f32::consts::FRAC_PI_2),
        );
        let dome = across * stretch + axis * (radius * each(libm::cosf));
        Points {
            position: a.center + dome,
            normal: dome.normalize_or(axis),
        }
    }
}

#[cfg(test)]
mod tests;
