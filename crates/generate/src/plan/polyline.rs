//! A path of the tracing by arc length, with its radii.

use glam::DVec3;

use super::cone::RoundCone;

/// A path by arc length (µm).
#[derive(Clone, Debug)]
pub(crate) struct Polyline {
    pub(crate) centers: Vec<DVec3>,
    pub(crate) radii: Vec<f64>,
    /// Arc length of each point.
    pub(crate) arcs: Vec<f64>,
}

impl Polyline {
    /// # Panics
    /// Without points.
    pub(crate) fn new(centers: Vec<DVec3>, radii: Vec<f64>) -> Self {
        let mut arcs = vec![0.0];
        for pair in centers.windows(2) {
            arcs.push(arcs[arcs.len() - 1] + pair[0].distance(pair[1]));
        }
        assert!(!centers.is_empty(), "a path has points");
        Self {
            centers,
            radii,
            arcs,
        }
    }

    pub(crate) fn length(&self) -> f64 {
        self.arcs[self.arcs.len() - 1]
    }

    /// The segment that holds an arc length, and the share of it.
    fn locate(&self, arc: f64) -> (usize, f64) {
        let last = self.arcs.len() - 1;
        if last == 0 {
            return (0, 0.0);
        }
        let i = self.arcs.partition_point(|&a| a <= arc).clamp(1, last) - 1;
        (i, self.share(i, arc))
    }

    /// Share of a segment at which an arc length is.
    fn share(&self, segment: usize, arc: f64) -> f64 {
        let length = self.arcs[segment + 1] - self.arcs[segment];
        if length > 0.0 {
            ((arc - self.arcs[segment]) / length).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// [`Polyline::at`] for arc lengths that grow from one call to the next: no segment is searched for.
    pub(crate) fn walk(&self) -> impl FnMut(f64) -> DVec3 {
        let mut segment = 0;
        move |arc| {
            while segment + 2 < self.arcs.len() && self.arcs[segment + 1] <= arc {
                segment += 1;
            }
            match self.centers.get(segment + 1) {
                Some(&next) => self.centers[segment].lerp(next, self.share(segment, arc)),
                None => self.centers[0],
            }
        }
    }

    pub(crate) fn at(&self, arc: f64) -> DVec3 {
        let (i, t) = self.locate(arc);
        let next = (i + 1).min(self.centers.len() - 1);
        self.centers[i].lerp(self.centers[next], t)
    }

    pub(crate) fn radius(&self, arc: f64) -> f64 {
        let (i, t) = self.locate(arc);
        let next = (i + 1).min(self.radii.len() - 1);
        self.radii[i] * (1.0 - t) + self.radii[next] * t
    }

    /// Direction of the path over `width` (µm) to either side.
    pub(crate) fn tangent(&self, arc: f64, width: f64) -> DVec3 {
        let width = width.max(1e-9);
        let way = self.at(arc + width) - self.at(arc - width);
        way.try_normalize().unwrap_or(DVec3::Y)
    }

    /// The point within `range` of arc lengths whose cone is nearest to `p`.
    pub(crate) fn foot(&self, p: DVec3, range: [f64; 2]) -> f64 {
        let mut best = (f64::INFINITY, range[0]);
        for i in self.segments(range) {
            let (a, b) = (self.centers[i], self.centers[i + 1]);
            let axis = b - a;
            let t =
                ((p - a).dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let radius = self.radii[i] * (1.0 - t) + self.radii[i + 1] * t;
            let distance = p.distance(a + axis * t) - radius;
            if distance < best.0 {
                best = (
                    distance,
                    self.arcs[i] + t * (self.arcs[i + 1] - self.arcs[i]),
                );
            }
        }
        best.1.clamp(range[0], range[1])
    }

    /// Cones of the segments that reach into `range`.
    pub(crate) fn cones(&self, range: [f64; 2]) -> Vec<RoundCone> {
        RoundCone::along(&self.centers, &self.radii, self.segments(range))
    }

    fn segments(&self, range: [f64; 2]) -> std::ops::Range<usize> {
        let last = self.arcs.len() - 1;
        let before = self.arcs.partition_point(|&a| a < range[0]).max(1) - 1;
        let first = before.min(last.saturating_sub(1));
        let after = self.arcs.partition_point(|&a| a <= range[1]);
        first..after.max(first + 1).min(last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> Polyline {
        let centers = (0..5).map(|i| DVec3::X * f64::from(i)).collect();
        Polyline::new(centers, vec![1.0, 1.0, 1.0, 0.5, 0.5])
    }

    #[test]
    fn arc_lengths_are_found_again() {
        let line = line();
        assert_eq!(line.at(2.25), DVec3::X * 2.25);
        assert_eq!(line.at(-1.0), DVec3::ZERO);
        assert_eq!(line.at(9.0), DVec3::X * 4.0);
        let mut walk = line.walk();
        for arc in [-1.0, 0.0, 0.4, 1.0, 1.1, 3.7, 4.0, 9.0] {
            assert_eq!(walk(arc), line.at(arc), "{arc}");
        }
        let point = Polyline::new(vec![DVec3::ONE], vec![1.0]);
        assert_eq!(point.walk()(2.0), DVec3::ONE);
        assert!((line.radius(2.5) - 0.75).abs() < 1e-12);
        assert!((line.foot(DVec3::new(1.3, 4.0, 0.0), [0.0, 4.0]) - 1.3).abs() < 1e-12);
    }

    #[test]
    fn ranges_name_the_segments_that_reach_into_them() {
        let line = line();
        assert_eq!(line.segments([0.0, 4.0]), 0..4);
        assert_eq!(line.segments([1.5, 2.5]), 1..3);
        assert_eq!(line.segments([-3.0, -1.0]), 0..1);
        assert_eq!(line.segments([8.0, 9.0]).end, 4);
    }
}
