//! A closed body that stops a hole: an ellipsoid around a loop.

use glam::DVec3;

use crate::body::Body;

/// The least extent of a plug across, of its largest: flat ones would leave narrow faces.
const FLATTEST: f64 = 0.4;

/// An ellipsoid that holds a loop.
pub(super) struct Ellipsoid {
    center: DVec3,
    /// Half axes, at right angles to one another and in the order of a right hand.
    axes: [DVec3; 3],
}

impl Ellipsoid {
    /// `scale` times as large as it must be to hold the points, with half axes of `least` and more. None if the
    /// points are on a line.
    pub(super) fn around(points: &[DVec3], scale: f64, least: f64) -> Option<Self> {
        let center = points.iter().sum::<DVec3>() / points.len() as f64;
        let ways: Vec<DVec3> = points.iter().map(|point| point - center).collect();
        let longest = |ways: &[DVec3]| {
            let length = |way: &&DVec3| way.length_squared();
            ways.iter()
                .max_by(|a, b| length(a).total_cmp(&length(b)))
                .copied()
        };
        let first = longest(&ways)?.try_normalize()?;
        let across: Vec<DVec3> = ways
            .iter()
            .map(|way| way.reject_from_normalized(first))
            .collect();
        let second = longest(&across)?.try_normalize()?;
        let directions = [first, second, first.cross(second)];
        let extents = directions.map(|way| {
            let reach = ways.iter().map(|other| other.dot(way).abs());
            reach.fold(0.0, f64::max)
        });
        let flattest = FLATTEST * extents[0];
        let axes = [0, 1, 2].map(|n| extents[n].max(flattest) * directions[n]);
        let inside = Self { center, axes };
        let farthest = ways
            .iter()
            .map(|&way| inside.level(way))
            .fold(0.0, f64::max);
        Some(Self {
            center,
            axes: axes.map(|axis| {
                let length = scale * farthest * axis.length();
                axis * (length.max(least) / axis.length())
            }),
        })
    }

    /// 1 on the surface.
    fn level(&self, way: DVec3) -> f64 {
        let shares = self.axes.map(|axis| way.dot(axis) / axis.length_squared());
        DVec3::from(shares).length()
    }

    /// The ellipsoid with 32 flat faces.
    pub(super) fn body(&self) -> Body {
        let (directions, faces) = sphere();
        let point = |direction: DVec3| {
            let ways = [0, 1, 2].map(|n| direction[n] * self.axes[n]);
            self.center + ways.iter().sum::<DVec3>()
        };
        Body {
            points: directions.into_iter().map(point).collect(),
            faces,
        }
    }
}

/// A sphere of 18 points and 32 faces: an octahedron whose faces are divided once.
fn sphere() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut points = vec![
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::NEG_Z,
    ];
    let faces = [
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    let mut middles: Vec<([u32; 2], u32)> = Vec::new();
    let mut finer = Vec::new();
    for [a, b, c] in faces {
        let [d, e, f] = [[a, b], [b, c], [c, a]].map(|[from, to]: [u32; 2]| {
            let key = [from.min(to), from.max(to)];
            if let Some(&(_, middle)) = middles.iter().find(|(other, _)| *other == key) {
                return middle;
            }
            let sum = points[from as usize] + points[to as usize];
            points.push(sum.normalize_or(sum));
            middles.push((key, points.len() as u32 - 1));
            points.len() as u32 - 1
        });
        finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
    }
    (points, finer)
}

#[cfg(test)]
mod tests {
    use neurotess_mesh::{SurfaceMesh, SurfaceVertex, measure, topology};

    use super::*;
    use crate::surface::work::Work;

    #[test]
    fn a_body_holds_its_loop_and_looks_outwards() {
        // A crooked loop that is flat in no plane.
        let points: Vec<DVec3> = (0..9)
            .map(|n| {
                let angle = std::f64::consts::TAU * f64::from(n) / 9.0;
                DVec3::new(3.0 * angle.cos(), angle.sin(), 0.3 * (2.0 * angle).cos())
            })
            .collect();
        let tight = Ellipsoid::around(&points, 1.0, 0.0).expect("an extent");
        let levels = points
            .iter()
            .map(|&point| tight.level(point - tight.center));
        let farthest = levels.fold(0.0, f64::max);
        assert!((farthest - 1.0).abs() < 1e-9, "{farthest}");

        let mut mesh = SurfaceMesh::default();
        mesh.vertices
            .extend(points.iter().map(|point| SurfaceVertex {
                position: point.as_vec3(),
                section: 4,
                ..SurfaceVertex::default()
            }));
        let mut work = Work::new(&mesh).expect("a surface");
        let wide = Ellipsoid::around(&points, 1.3, 0.0).expect("an extent");
        let names = [0, 1, 2].map(|n| work.vertices[n]);
        let faces = wide.body().add(&mut work, &names, 0);
        assert_eq!(faces.len(), 32);
        let shape = topology(&work.positions(), &work.faces());
        assert!(shape.closed && shape.oriented && shape.genus == Some(0));
        assert!(measure(&work.positions(), &work.faces()).volume > 0.0);
        assert!(work.vertices.iter().all(|vertex| vertex.section == 4));
        // All points are behind all of its flat faces.
        for face in faces {
            let [a, b, c] = work.corners(face);
            let outwards = (b - a).cross(c - a);
            assert!(points.iter().all(|point| outwards.dot(*point - a) < 0.0));
        }
    }

    #[test]
    fn a_body_around_a_point_is_as_large_as_the_least() {
        let points = [DVec3::ZERO, 1e-3 * DVec3::X, 1e-3 * DVec3::Y];
        let body = Ellipsoid::around(&points, 1.3, 0.2).expect("an extent");
        for axis in body.axes {
            assert!((axis.length() - 0.2).abs() < 1e-12);
        }
        assert!(Ellipsoid::around(&[DVec3::ONE; 3], 1.3, 0.2).is_none());
    }
}
