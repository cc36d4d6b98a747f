//! Distance from round cones: the solid that a traced segment stands for.

use glam::DVec3;

/// A sphere at either end and the cone that touches both (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RoundCone {
    pub(crate) a: DVec3,
    pub(crate) b: DVec3,
    pub(crate) radius_a: f64,
    pub(crate) radius_b: f64,
    /// Center and radius of a bounding sphere.
    middle: DVec3,
    reach: f64,
}

impl RoundCone {
    pub(crate) fn new([a, b]: [DVec3; 2], [radius_a, radius_b]: [f64; 2]) -> Self {
        Self {
            a,
            b,
            radius_a,
            radius_b,
            middle: 0.5 * (a + b),
            reach: 0.5 * a.distance(b) + radius_a.max(radius_b),
        }
    }

    /// Cones of the segments of a path, by their first points.
    pub(crate) fn along(
        centers: &[DVec3],
        radii: &[f64],
        segments: impl Iterator<Item = usize>,
    ) -> Vec<Self> {
        segments
            .map(|i| Self::new([centers[i], centers[i + 1]], [radii[i], radii[i + 1]]))
            .collect()
    }

    /// Signed distance (µm) of a point from the surface, negative inside: I. Quilez, "Round cone",
    /// whose three regions are the two spheres and the cone between their circles of contact.
    pub(crate) fn distance(&self, p: DVec3) -> f64 {
        let axis = self.b - self.a;
        let length2 = axis.length_squared();
        let step = self.radius_a - self.radius_b;
        let slant2 = length2 - step * step;
        let to_a = p - self.a;
        if length2 < 1e-18 || slant2 <= 0.0 {
            // One sphere holds the other.
            return (to_a.length() - self.radius_a).min(p.distance(self.b) - self.radius_b);
        }
        let along = to_a.dot(axis);
        let beyond = along - length2;
        let across2 = (to_a * length2 - axis * along).length_squared();
        let (along2, beyond2) = (along * along * length2, beyond * beyond * length2);
        let k = step.signum() * step * step * across2;
        if beyond.signum() * slant2 * beyond2 > k {
            (across2 + beyond2).sqrt() / length2 - self.radius_b
        } else if along.signum() * slant2 * along2 < k {
            (across2 + along2).sqrt() / length2 - self.radius_a
        } else {
            ((across2 * slant2 / length2).sqrt() + along * step) / length2 - self.radius_a
        }
    }
}

/// Signed distance (µm) from the union of cones. Fastest where the nearest are in the middle of the list:
/// of most others only the bounding spheres are looked at.
pub(crate) fn distance(cones: &[RoundCone], p: DVec3) -> f64 {
    let (before, after) = cones.split_at(cones.len() / 2);
    let mut least = f64::INFINITY;
    for cone in after.iter().chain(before.iter().rev()) {
        let nearer = least + cone.reach;
        if nearer > 0.0 && p.distance_squared(cone.middle) < nearer * nearer {
            least = least.min(cone.distance(p));
        }
    }
    least
}

/// Step of differences, in radii of what stands there.
const STEP: f64 = 1e-3;

/// Unit direction in which the distance from the union grows where something of this radius (µm) stands.
pub(crate) fn outwards(cones: &[RoundCone], p: DVec3, radius: f64) -> DVec3 {
    let step = STEP * radius;
    let slope = |axis: DVec3| distance(cones, p + axis * step) - distance(cones, p - axis * step);
    let gradient = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
    gradient.try_normalize().unwrap_or(DVec3::Y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cone() -> RoundCone {
        RoundCone::new([DVec3::ZERO, DVec3::new(10.0, 0.0, 0.0)], [2.0, 1.0])
    }

    #[test]
    fn ends_are_spheres() {
        assert!((cone().distance(DVec3::new(-5.0, 0.0, 0.0)) - 3.0).abs() < 1e-12);
        assert!((cone().distance(DVec3::new(13.0, 0.0, 0.0)) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn middle_is_the_common_tangent_cone() {
        let slant = (100.0_f64 - 1.0).sqrt();
        // Half-way between the circles of contact, which lie off the centers by r·step/length.
        let x = 5.0 + 0.5 * (2.0 + 1.0) * 0.1;
        let radius = 1.5 * slant / 10.0;
        assert!(cone().distance(DVec3::new(x, radius, 0.0)).abs() < 1e-12);
        let n = outwards(&[cone()], DVec3::new(x, radius, 0.0), 0.1);
        assert!((n.x - 0.1).abs() < 1e-6, "{n}");
    }

    #[test]
    fn sphere_within_the_other_does_not_count() {
        let cone = RoundCone::new([DVec3::ZERO, DVec3::new(0.5, 0.0, 0.0)], [2.0, 1.0]);
        assert!((cone.distance(DVec3::new(0.0, 5.0, 0.0)) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_union_is_as_far_as_its_nearest_cone() {
        let centers: Vec<DVec3> = (0..12)
            .map(f64::from)
            .map(|i| DVec3::new(3.0 * i, 4.0 * (0.7 * i).sin(), (2.3 * i).cos()))
            .collect();
        let radii: Vec<f64> = (0..12).map(|i| 0.4 + 0.3 * f64::from(i % 4)).collect();
        let cones = RoundCone::along(&centers, &radii, 0..11);
        for i in 0..2000 {
            let [x, y, z] = [0.618, 0.755, 0.569].map(|step| (step * f64::from(i)).fract());
            let p = DVec3::new(50.0 * x - 8.0, 20.0 * y - 10.0, 12.0 * z - 6.0);
            let each = cones.iter().map(|cone| cone.distance(p));
            assert_eq!(distance(&cones, p), each.fold(f64::INFINITY, f64::min));
        }
        assert_eq!(distance(&[], DVec3::ZERO), f64::INFINITY);
    }
}
