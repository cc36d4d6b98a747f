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

mod center_line;
mod corner;
mod edges;
mod profile;

use glam::Vec3;
use neurotess_mesh::PatchKind;

use crate::{Caps, Path, RefineOptions};
pub(crate) use center_line::{CenterLine, MAX_SWAY, hermite_tangents};
pub(crate) use corner::{Corner, Jet};
pub use edges::SOMA_FILLET;
pub(crate) use edges::{
    EdgeCurve, EdgeKind, EdgeNormals, MAX_OFFSET, edge, loft_controls, soma_controls,
};
use edges::{OverLength, cubic, first_leg, longer, mix, most_squared};
use profile::Share;
pub(crate) use profile::{Profile, STEEPEST_PROFILE};

/// A patch ready to be evaluated inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchShape {
    pub(crate) kind: PatchKind,
    pub(crate) corners: [Corner; 4],
    /// By side: the kind of its edge, and whether the edge runs against the patch's coordinate.
    pub(crate) sides: [(EdgeKind, bool); 4],
}

/// Corners at the start and end of each side, along the patch's coordinates: sides 0 and 2 along x
/// at y = 0 and 1, sides 1 and 3 along y at x = 1 and 0.
pub(crate) const SIDES: [(usize, usize); 4] = [(0, 1), (1, 2), (3, 2), (0, 3)];

/// A patch ready to be evaluated row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchRows<'s> {
    shape: &'s PatchShape,
    options: &'s RefineOptions,
    /// Of a lateral patch: what all rows have in common.
    tube: Option<Tube>,
}

/// A tube's center line, and what its corners' offsets and radials change by along it, at x = 0 and 1.
#[derive(Clone, Copy, Debug)]
struct Tube {
    line: CenterLine,
    profile: Profile,
    offset_y: [Vec3; 2],
    radial_y: [Vec3; 2],
    /// The longest offset of the corners of each ring.
    longest: [f32; 2],
}

/// A tube at some y: its center, and the offsets and radials at x = 0 and 1.
#[derive(Clone, Copy, Debug)]
struct TubeRow {
    tube: Tube,
    center: Jet,
    offsets: [Vec3; 2],
    radials: [Vec3; 2],
    most_squared: f32,
    share: Share,
}

impl<'s> PatchRows<'s> {
    /// The points inside at this y ∈ (0, 1).
    pub(crate) fn at(&self, y: f32) -> PatchRow<'s> {
        PatchRow {
            shape: self.shape,
            options: self.options,
            y,
            tube: self.tube.map(|tube| TubeRow::new(self.shape, tube, y)),
        }
    }
}

/// Points of a patch with the same y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchRow<'s> {
    shape: &'s PatchShape,
    options: &'s RefineOptions,
    y: f32,
    /// Of a lateral patch.
    tube: Option<TubeRow>,
}

impl PatchRow<'_> {
    /// A point inside with its normal, x ∈ (0, 1).
    pub(crate) fn point(&self, x: f32) -> (Vec3, Vec3) {
        let Self { shape, options, .. } = self;
        match shape.kind {
            PatchKind::Lateral => {
                let tube = self.tube.as_ref();
                let tube = tube.expect("rows of lateral patches are those of a tube");
                tube.point(&shape.corners[0], x)
            }
            PatchKind::Soma => shape.coons(x, self.y),
            PatchKind::Loft => shape.loft(options.path, x, self.y),
            PatchKind::Cap => shape.cap(options.caps, x, self.y),
        }
    }
}

impl PatchRow<'_> {
    /// The radius of the tube (µm) here; linear between corners of other patches.
    pub(crate) fn radius(&self, x: f32) -> f32 {
        if let Some(tube) = &self.tube {
            return tube.tube.profile.radius(self.y);
        }
        let radii = self.shape.corners.map(|corner| corner.radius);
        (radii[0] * (1.0 - x) + radii[1] * x) * (1.0 - self.y)
            + (radii[3] * (1.0 - x) + radii[2] * x) * self.y
    }
}

impl Tube {
    fn new(shape: &PatchShape, path: Path) -> Self {
        let [a, b, c, d] = &shape.corners;
        let line = CenterLine::new(a, d, path);
        Self {
            line,
            profile: Profile::new(a, d, &line),
            offset_y: [d.offset - a.offset, c.offset - b.offset],
            radial_y: [d.radial - a.radial, c.radial - b.radial],
            longest: [longer(a.offset, b.offset), longer(d.offset, c.offset)],
        }
    }
}

impl TubeRow {
    fn new(shape: &PatchShape, tube: Tube, y: f32) -> Self {
        let [a, b, c, d] = &shape.corners;
        Self {
            tube,
            center: tube.line.at(y),
            offsets: [mix(a.offset, d.offset, y), mix(b.offset, c.offset, y)],
            radials: [mix(a.radial, d.radial, y), mix(b.radial, c.radial, y)],
            most_squared: most_squared(tube.longest[0], tube.longest[1], y),
            share: tube.profile.share(y),
        }
    }

    /// `a`: the patch's first corner.
    fn point(&self, a: &Corner, x: f32) -> (Vec3, Vec3) {
        let blend = |[at_0, at_1]: [Vec3; 2]| mix(at_0, at_1, x);
        let change = |[at_0, at_1]: [Vec3; 2]| at_1 - at_0;
        let (offset, radial) = (blend(self.offsets), blend(self.radials));
        let over = OverLength::of(radial);
        let most = self.most_squared;
        let around = over.jet(offset, change(self.offsets), change(self.radials));
        let around = around.within(most).around(self.share);
        let along = over.jet(offset, blend(self.tube.offset_y), blend(self.tube.radial_y));
        let along = along.within(most).along(self.share);
        let normal = around
            .derivative
            .cross(self.center.derivative + along.derivative)
            .normalize_or_zero();
        let outwards = if radial == Vec3::ZERO {
            a.normal
        } else {
            radial
        };
        // Where a sharp bend folds the surface over, it gets the normal of a tube without the fold.
        let normal = if normal.dot(outwards) > 0.0 {
            normal
        } else {
            outwards.normalize_or(a.normal)
        };
        (self.center.position + around.position, normal)
    }
}

impl PatchShape {
    /// The points inside, row by row.
    pub(crate) fn rows<'s>(&'s self, options: &'s RefineOptions) -> PatchRows<'s> {
        let is_tube = self.kind == PatchKind::Lateral;
        PatchRows {
            shape: self,
            options,
            tube: is_tube.then(|| Tube::new(self, options.path)),
        }
    }

    /// A point inside with its normal, x and y ∈ (0, 1).
    pub(crate) fn interior(&self, options: &RefineOptions, x: f32, y: f32) -> (Vec3, Vec3) {
        self.rows(options).at(y).point(x)
    }

    pub(crate) fn side(&self, side: usize, path: Path, t: f32) -> Jet {
        let (from, to) = SIDES[side];
        let (a, b) = (&self.corners[from], &self.corners[to]);
        let (kind, reversed) = self.sides[side];
        if reversed {
            let jet = edge(kind, b, a, path, 1.0 - t);
            Jet {
                derivative: -jet.derivative,
                ..jet
            }
        } else {
            edge(kind, a, b, path, t)
        }
    }

    /// At each x a cubic from the trunk's side to the inset's: [`loft_controls`] between points of the
    /// two sides, with its derivatives.
    fn loft(&self, path: Path, x: f32, y: f32) -> (Vec3, Vec3) {
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
        let third_x = way.dot(way_x) / (9.0 * third).max(f32::MIN_POSITIVE);
        let arrive_x = if third < c.collar.abs() {
            c.tangent * (third_x * c.collar.signum())
        } else {
            Vec3::ZERO
        };
        let across = cubic(
            [
                near.position,
                near.position + leave,
                far.position - arrive,
                far.position,
            ],
            y,
        );
        let by_x = cubic(
            [
                near.derivative,
                near.derivative + leave_x,
                far.derivative - arrive_x,
                far.derivative,
            ],
            y,
        );
        let normal = by_x.position.cross(across.derivative);
        (across.position, normal.normalize_or(self.mean_normal()))
    }

    fn mean_normal(&self) -> Vec3 {
        let sum: Vec3 = self.corners.iter().map(|k| k.normal).sum();
        sum.normalize_or(Vec3::Y)
    }

    /// Bilinearly blended Coons patch. Its normal is that of the sides, the nearer one more: that of the surface
    /// jumps at the sides, which shows as lines where a ring pulls a soma out.
    fn coons(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let [near, right, far, left] = [
            self.side(0, Path::Hermite, x),
            self.side(1, Path::Hermite, y),
            self.side(2, Path::Hermite, x),
            self.side(3, Path::Hermite, y),
        ];
        let [a, b, c, d] = self.corners.map(|k| k.position);
        let position = mix(near.position, far.position, y) + mix(left.position, right.position, x)
            - mix(mix(a, b, x), mix(d, c, x), y);
        let [along_near, along_right, along_far, along_left] = [
            self.side_normal(0, &near, x),
            self.side_normal(1, &right, y),
            self.side_normal(2, &far, x),
            self.side_normal(3, &left, y),
        ];
        let normal = mix(along_near, along_far, y) * (x * (1.0 - x))
            + mix(along_left, along_right, x) * (y * (1.0 - y));
        (position, normal.normalize_or(self.mean_normal()))
    }

    fn side_normal(&self, side: usize, jet: &Jet, t: f32) -> Vec3 {
        let (from, to) = SIDES[side];
        let (kind, _) = self.sides[side];
        EdgeNormals::new(kind, &self.corners[from], &self.corners[to]).at(jet.derivative, t)
    }

    /// The end of a tube: a disk, or the half sphere over it, whose polar angle grows with the
    /// distance from the disk's center.
    fn cap(&self, caps: Caps, x: f32, y: f32) -> (Vec3, Vec3) {
        let (flat, _) = self.coons(x, y);
        let [a, b, _, d] = &self.corners;
        let tangent = a.tangent;
        let outwards = (b.offset - a.offset).cross(d.offset - a.offset);
        let axis = if outwards.dot(tangent) < 0.0 {
            -tangent
        } else {
            tangent
        };
        if caps == Caps::Flat {
            return (flat, axis);
        }
        let radius = a.offset.length();
        let across = flat - a.center;
        let share = (across.length() / radius.max(f32::MIN_POSITIVE)).min(1.0);
        let angle = share * std::f32::consts::FRAC_PI_2;
        let stretch = if share > 1e-4 {
            angle.sin() / share
        } else {
            std::f32::consts::FRAC_PI_2
        };
        let dome = across * stretch + axis * (radius * angle.cos());
        (a.center + dome, dome.normalize_or(axis))
    }
}

#[cfg(test)]
mod tests;
