//! Insertion quads: which quad of the sphere each neurite takes, and room for all of them.

use std::f64::consts::PI;

use glam::{DMat3, DQuat, DVec3};

use super::sphere::Sphere;
use crate::soma::site;

/// Where a neurite leaves the soma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Insertion {
    /// Unit direction of the first ring's center from the soma's.
    pub(crate) direction: DVec3,
    /// Unit normal of the ring's plane, away from the soma: the neurite's direction, as far as the ring may lean.
    pub(crate) axis: DVec3,
    /// Unit direction of where the neurite leaves the surface: of an inset, under its ring.
    pub(crate) foot: DVec3,
    /// Distance of the first ring's center from the soma's.
    pub(crate) distance: f64,
    /// Radius of the first ring.
    pub(crate) radius: f64,
    /// Whether the ring stands over its quad, which stays in the surface, instead of taking its corners.
    pub(crate) inset: bool,
    /// Distance up to which such a ring may be raised, where others pull the surface out.
    pub(crate) highest: f64,
}

/// Distance of the corners of an inset's quad from its neurite's axis, in radii of the neurite: half the
/// quad is 1.7 radii wide.
pub(super) const QUAD_REACH: f64 = 2.4;

impl Insertion {
    /// Angle that the ring's radius takes seen from the soma's center.
    pub(crate) fn angle(&self) -> f64 {
        (self.radius / self.distance).atan()
    }

    /// Angle that an inset's quad takes.
    pub(crate) fn quad_angle(&self) -> f64 {
        (QUAD_REACH * self.radius / self.distance).atan()
    }

    /// The ring's center, relative to the soma's.
    pub(crate) fn center(&self) -> DVec3 {
        self.direction * self.distance
    }

    /// Turns all of it about the soma's center.
    fn turn(&mut self, axis: DVec3, angle: f64) {
        let turn = DQuat::from_axis_angle(axis, angle);
        self.direction = turn.mul_vec3(self.direction);
        self.axis = turn.mul_vec3(self.axis);
        self.foot = turn.mul_vec3(self.foot);
    }

    /// Raises an inset's ring over the surface, as far as it may. `quad`: distances of the corners of its quad from the
    /// soma's center.
    pub(crate) fn raise(&mut self, quad: [f64; 4]) {
        let middle = quad.iter().sum::<f64>() / 4.0;
        let slope = quad.into_iter().fold(middle, f64::max) - middle;
        let over = site::over_surface(middle + slope / QUAD_REACH, self.radius);
        self.distance = over.min(self.highest).max(self.distance);
    }

    /// Angle that nothing else may be in.
    fn taken(&self) -> f64 {
        match self.inset {
            true => self.quad_angle() / GAP,
            false => self.angle(),
        }
    }
}

/// Largest angle that a ring may take: beyond, the soma is but a swelling of its neurite.
const WIDEST: f64 = 0.6;
/// Free angle between two rings, as a share of the sum of their own.
pub(super) const GAP: f64 = 1.25;
/// Free angle between two rings, however thin (radians).
pub(crate) const MIN_GAP: f64 = 0.05;
/// A crowded ring is made smaller down to this share before directions give way.
const SMALLEST: f64 = 0.55;

/// Makes rings small enough, and moves their directions apart, until none touch. Returns how many
/// became smaller and how many turned by more than a degree. `gap`: free angle between two rings
/// besides their own share (radians).
pub(crate) fn make_room(insertions: &mut [Insertion], gap: f64) -> (usize, usize) {
    let traced = insertions.to_vec();
    for insertion in insertions.iter_mut() {
        insertion.radius = insertion.radius.min(insertion.distance * WIDEST.tan());
    }
    shrink_crowded(insertions, gap);
    for _ in 0..200 {
        if !push_apart(insertions, gap) {
            break;
        }
    }
    shrink_to_total(insertions);
    let smaller = insertions
        .iter()
        .zip(&traced)
        .filter(|(a, b)| a.radius < 0.999 * b.radius);
    let turned = insertions.iter().zip(&traced);
    let turned = turned.filter(|(a, b)| a.direction.dot(b.direction) < 1_f64.to_radians().cos());
    (smaller.count(), turned.count())
}

fn needed(a: &Insertion, b: &Insertion, gap: f64) -> f64 {
    GAP * (a.taken() + b.taken()) + gap
}

fn between(a: &Insertion, b: &Insertion) -> f64 {
    a.foot.angle_between(b.foot)
}

fn shrink_crowded(insertions: &mut [Insertion], gap: f64) {
    let factors: Vec<f64> = (0..insertions.len())
        .map(|i| {
            let others = (0..insertions.len()).filter(|&j| j != i);
            let room = others.map(|j| {
                let (a, b) = (&insertions[i], &insertions[j]);
                between(a, b) / needed(a, b, gap)
            });
            room.fold(1.0, f64::min).max(SMALLEST)
        })
        .collect();
    for (insertion, factor) in insertions.iter_mut().zip(factors) {
        insertion.radius *= factor;
    }
}

fn push_apart(insertions: &mut [Insertion], gap: f64) -> bool {
    let mut moved = false;
    for i in 0..insertions.len() {
        for j in i + 1..insertions.len() {
            let (a, b) = (insertions[i], insertions[j]);
            let lack = needed(&a, &b, gap) - between(&a, &b);
            if lack <= 1e-6 {
                continue;
            }
            moved = true;
            let axis = a.foot.cross(b.foot);
            let axis = axis
                .try_normalize()
                .unwrap_or_else(|| a.foot.any_orthonormal_vector());
            // The thinner one gives way more.
            let share = b.radius / (a.radius + b.radius);
            insertions[i].turn(axis, -0.5 * lack * share);
            insertions[j].turn(axis, 0.5 * lack * (1.0 - share));
        }
    }
    moved
}

/// Last resort, for somata with more neurites than fit.
fn shrink_to_total(insertions: &mut [Insertion]) {
    for i in 0..insertions.len() {
        for j in i + 1..insertions.len() {
            let (a, b) = (insertions[i], insertions[j]);
            let (have, need) = (between(&a, &b), a.angle() + b.angle());
            if have < GAP * need && need > 0.0 {
                let factor = (have / (GAP * need)).max(0.02);
                insertions[i].radius *= factor;
                insertions[j].radius *= factor;
            }
        }
    }
}

/// The quads taken and the rotation of the sphere that serves them best.
#[derive(Clone, Debug)]
pub(crate) struct InsertionQuads {
    /// Rotates the sphere before use.
    pub(crate) rotation: DMat3,
    /// Quad of each insertion.
    pub(crate) quads: Vec<usize>,
    /// Largest angle between an insertion and its quad's center.
    pub(crate) worst: f64,
}

/// Steps of the sequence of rotations: powers of the root of x⁴ = x + 1, inverted.
const WEYL: [f64; 3] = [0.819_172_513, 0.671_043_607, 0.549_700_478];
/// Number of rotations tried.
const ROTATIONS: usize = 48;

/// Gives every insertion a quad that shares no vertex with another's: greedily, thickest first,
/// then by exchanges that lower the cost, for the best of a fixed set of rotations of the sphere.
/// `None` if the sphere has too few quads. `directions`: where on the sphere the insertions are.
pub(crate) fn assign(
    sphere: &Sphere,
    insertions: &[Insertion],
    directions: &[DVec3],
) -> Option<InsertionQuads> {
    let centers: Vec<DVec3> = sphere
        .quads
        .iter()
        .map(|q| {
            q.map(|v| sphere.nodes[v as usize])
                .iter()
                .sum::<DVec3>()
                .normalize_or_zero()
        })
        .collect();
    let mut order: Vec<usize> = (0..insertions.len()).collect();
    order.sort_by(|&a, &b| insertions[b].angle().total_cmp(&insertions[a].angle()));
    let usable: Vec<bool> = sphere
        .quads
        .iter()
        .map(|q| square_enough(sphere, *q))
        .collect();
    let mut best: Option<InsertionQuads> = None;
    let mut best_cost = f64::INFINITY;
    for trial in 0..ROTATIONS {
        let rotation = rotation(trial);
        let local: Vec<DVec3> = directions
            .iter()
            .map(|&direction| rotation.transpose() * direction)
            .collect();
        let Some(mut quads) = greedy(sphere, &centers, &usable, &order, &local) else {
            continue;
        };
        exchange(&centers, &local, &mut quads);
        let errors = quads
            .iter()
            .zip(&local)
            .map(|(&q, d)| centers[q].angle_between(*d));
        let (cost, worst) = errors.fold((0.0, 0.0_f64), |(c, w), e| (c + e * e, w.max(e)));
        if cost < best_cost {
            best_cost = cost;
            best = Some(InsertionQuads {
                rotation,
                quads,
                worst,
            });
        }
    }
    best
}

fn greedy(
    sphere: &Sphere,
    centers: &[DVec3],
    usable: &[bool],
    order: &[usize],
    directions: &[DVec3],
) -> Option<Vec<usize>> {
    let mut taken = vec![false; sphere.surface];
    let mut quads = vec![0; directions.len()];
    for &k in order {
        let mut nearest = (f64::NEG_INFINITY, usize::MAX);
        for (q, center) in centers.iter().enumerate() {
            let near = center.dot(directions[k]);
            if near > nearest.0 && usable[q] && sphere.quads[q].iter().all(|&v| !taken[v as usize])
            {
                nearest = (near, q);
            }
        }
        let quad = sphere.quads.get(nearest.1)?;
        quad.iter().for_each(|&v| taken[v as usize] = true);
        quads[k] = nearest.1;
    }
    Some(quads)
}

/// Lets pairs of insertions swap quads where that brings both together nearer.
fn exchange(centers: &[DVec3], directions: &[DVec3], quads: &mut [usize]) {
    let cost = |q: usize, k: usize| centers[q].angle_between(directions[k]).powi(2);
    for _ in 0..8 {
        let mut swapped = false;
        for i in 0..quads.len() {
            for j in i + 1..quads.len() {
                let now = cost(quads[i], i) + cost(quads[j], j);
                if cost(quads[j], i) + cost(quads[i], j) < now - 1e-12 {
                    quads.swap(i, j);
                    swapped = true;
                }
            }
        }
        if !swapped {
            return;
        }
    }
}

/// Whether no corner of a quad is nearly straight: the octahedron's six vertices join two quads
/// there that have 180° each, and a ring cannot be made of such.
fn square_enough(sphere: &Sphere, quad: [u32; 4]) -> bool {
    let p = |i: usize| sphere.nodes[quad[i % 4] as usize];
    (0..4).all(|i| (p(i + 1) - p(i)).angle_between(p(i + 3) - p(i)) < 2.4)
}

/// A fixed low-discrepancy set of rotations; the first is none (Shoemake, Uniform random rotations,
/// Graphics Gems III, with a Weyl sequence for the random numbers).
fn rotation(trial: usize) -> DMat3 {
    if trial == 0 {
        return DMat3::IDENTITY;
    }
    let [a, b, c] = WEYL.map(|step| (trial as f64 * step).fract());
    let (s, t) = ((1.0 - a).sqrt(), a.sqrt());
    let (b, c) = (2.0 * PI * b, 2.0 * PI * c);
    DMat3::from_quat(DQuat::from_xyzw(
        s * b.sin(),
        s * b.cos(),
        t * c.sin(),
        t * c.cos(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SphereKind;

    fn insertion(direction: DVec3, radius: f64) -> Insertion {
        let direction = direction.normalize_or_zero();
        Insertion {
            direction,
            axis: direction,
            foot: direction,
            distance: 1.2,
            radius,
            inset: false,
            highest: 1.2,
        }
    }

    #[test]
    fn crowded_insertions_find_room() {
        let mut crowd: Vec<Insertion> = (0..12)
            .map(|i| insertion(DVec3::new(0.02 * f64::from(i), 1.0, 0.0), 0.2))
            .collect();
        let (smaller, turned) = make_room(&mut crowd, MIN_GAP);
        assert!(smaller > 0 && turned > 0);
        for i in 0..crowd.len() {
            for j in 0..i {
                let (a, b) = (&crowd[i], &crowd[j]);
                assert!(between(a, b) > a.angle() + b.angle());
            }
        }
    }

    #[test]
    fn insertion_quads_share_no_vertex() {
        let sphere = Sphere::new(SphereKind::Cube, 8);
        let crowd: Vec<Insertion> = (0..9)
            .map(|i| {
                insertion(
                    DVec3::new(0.3 * f64::from(i % 3), 1.0, 0.3 * f64::from(i / 3)),
                    0.1,
                )
            })
            .collect();
        let directions: Vec<DVec3> = crowd.iter().map(|i| i.foot).collect();
        let insertion_quads = assign(&sphere, &crowd, &directions).unwrap();
        let mut vertices: Vec<u32> = insertion_quads
            .quads
            .iter()
            .flat_map(|&q| sphere.quads[q])
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        assert_eq!(vertices.len(), 36);
    }
}
