//! A round cone: the convex hull of the spheres at both ends of a link.

use glam::DVec3;

/// A link as a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoundCone {
    pub(super) from: DVec3,
    pub(super) to: DVec3,
    /// Of the spheres at both ends.
    pub(super) radii: [f64; 2],
}

impl RoundCone {
    /// Least and greatest corners of its box.
    pub(super) fn bounds(&self) -> [DVec3; 2] {
        let [a, b] = self.radii;
        [
            (self.from - a).min(self.to - b),
            (self.from + a).max(self.to + b),
        ]
    }

    /// Between which shares of the line from `start` to `start + along` it is inside; it is convex, so nowhere else.
    ///
    /// The ends of that are among the places where the line crosses a sphere or the cone that touches both, and all of
    /// these are of the body.
    pub(super) fn inside(&self, start: DVec3, along: DVec3) -> Option<[f64; 2]> {
        let [a, b] = self.radii;
        let mut crossed = Crossed(f64::INFINITY, f64::NEG_INFINITY);
        for (center, radius) in [(self.from, a), (self.to, b)] {
            let from = start - center;
            let square = [
                from.length_squared() - radius * radius,
                2.0 * from.dot(along),
                along.length_squared(),
            ];
            for at in roots(square) {
                crossed.add(at);
            }
        }
        let length = self.from.distance(self.to);
        let sine = (b - a) / length;
        if sine.abs() < 1.0 {
            let axis = (self.to - self.from) / length;
            let from = start - self.from;
            let (height, rise) = (from.dot(axis), along.dot(axis));
            let cosine = 1.0 - sine * sine;
            // cos² |x|² − y² − 2 a sin y − a² at a place x of the height y.
            let square = [
                cosine * from.length_squared() - height * (height + 2.0 * a * sine) - a * a,
                2.0 * (cosine * from.dot(along) - rise * (height + a * sine)),
                cosine * along.length_squared() - rise * rise,
            ];
            for at in roots(square) {
                let height = height + at * rise;
                if (-a * sine..=length - b * sine).contains(&height) && a + height * sine >= 0.0 {
                    crossed.add(at);
                }
            }
        }
        (crossed.0 < crossed.1).then_some([crossed.0, crossed.1])
    }
}

/// The least and the greatest of some places.
struct Crossed(f64, f64);

impl Crossed {
    fn add(&mut self, at: f64) {
        (self.0, self.1) = (self.0.min(at), self.1.max(at));
    }
}

/// Where c + b t + a t² is 0, of `[c, b, a]`.
fn roots([c, b, a]: [f64; 3]) -> impl Iterator<Item = f64> {
    let root = (b * b - 4.0 * a * c).sqrt();
    // Without the difference of numbers that are nearly the same.
    let half = -0.5 * (b + root.copysign(b));
    [half / a, c / half].into_iter().filter(|at| at.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance from its surface, below 0 inside: the least of its spheres'.
    fn distance(cone: &RoundCone, place: DVec3) -> f64 {
        let spheres = (0..=4000).map(|k| {
            let share = f64::from(k) / 4000.0;
            let radius = cone.radii[0] + share * (cone.radii[1] - cone.radii[0]);
            place.distance(cone.from.lerp(cone.to, share)) - radius
        });
        spheres.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn lines_enter_and_leave_where_the_distance_is_zero() {
        let mut hits = 0;
        for radii in [[1.0, 1.0], [1.0, 0.2], [0.3, 1.4], [2.0, 0.1]] {
            let cone = RoundCone {
                from: DVec3::new(0.2, -0.1, 0.0),
                to: DVec3::new(1.7, 0.4, 0.3),
                radii,
            };
            for k in 0..200 {
                let [u, v, w] = [0.618, 0.755, 0.569].map(|step| (f64::from(k) * step).fract());
                let start = 4.0 * (DVec3::new(u, v, w) - 0.5);
                let along = 6.0 * (DVec3::new(v, w, u) - DVec3::splat(0.5));
                let least = (0..=60)
                    .map(|at| distance(&cone, start + along * (f64::from(at) * 0.1 - 3.0)))
                    .fold(f64::INFINITY, f64::min);
                match cone.inside(start, along) {
                    Some(ends) => {
                        hits += 1;
                        for end in ends {
                            assert!(distance(&cone, start + along * end).abs() < 1e-5);
                        }
                        let middle = 0.5 * (ends[0] + ends[1]);
                        assert!(distance(&cone, start + along * middle) < 0.0);
                    }
                    None => assert!(least > -1e-5, "{radii:?} {k} {least}"),
                }
            }
        }
        assert!(hits > 100, "{hits}");
    }
}
