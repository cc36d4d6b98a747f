//! Whether two rings of a path are in each other's way.

use glam::DVec3;

/// What is clear of something else is so by this factor: disks that follow one another, and a branch's rings of their trunk.
pub(super) const CLEAR: f64 = 1.05;
/// Free way between a ring and the joint, zone or inset before it, in radii.
pub(super) const FREE_WAY: f64 = 0.35;

/// The disk of a ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disk {
    pub(crate) center: DVec3,
    /// Unit, along the path.
    pub(crate) normal: DVec3,
    pub(crate) radius: f64,
}

impl Disk {
    /// Whether this disk and the next one of the path are clear of one another: each lies on its own side of the other's
    /// plane. For circles in planes across oᵢ and oⱼ, with w the way from i to j and γ the angle between the two
    /// normals, that is `w·oⱼ > rᵢ sin γ` and `w·oᵢ > rⱼ sin γ`.
    pub(crate) fn is_clear_of(&self, next: &Self) -> bool {
        let way = next.center - self.center;
        // Turned by more than a right angle, a disk reaches as far as its radius.
        let sin = match self.normal.dot(next.normal) < 0.0 {
            true => 1.0,
            false => self.normal.cross(next.normal).length(),
        };
        let is_ahead = |normal: DVec3, radius: f64| way.dot(normal) > CLEAR * radius * sin;
        is_ahead(next.normal, self.radius) && is_ahead(self.normal, next.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disks_around_a_bend_are_clear_where_their_planes_meet_beyond_them() {
        // Two disks of a bend of radius 3, a tenth of a turn apart.
        let disk = |turn: f64, radius: f64| Disk {
            center: 3.0 * DVec3::new(turn.sin(), turn.cos(), 0.0),
            normal: DVec3::new(turn.cos(), -turn.sin(), 0.0),
            radius,
        };
        for (radius, clear) in [(1.0, true), (2.8, true), (2.9, false), (4.0, false)] {
            let pair = [0.0, 0.63].map(|turn| disk(turn, radius));
            assert_eq!(pair[0].is_clear_of(&pair[1]), clear, "{radius}");
        }
        // The wrong way round they are not.
        assert!(!disk(0.63, 1.0).is_clear_of(&disk(0.0, 1.0)));
    }
}
