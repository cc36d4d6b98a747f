//! How a soma was traced, and the sphere that stands for it.
//!
//! The rules follow what readers do with files of NeuroMorpho.Org, Allen and Blue Brain; see
//! `docs/conventions.md` for how they differ from MorphIO's and NeuroM's.
//!
//! **The sphere of an outline.** An outline of area A and perimeter P (its ends joined) that goes once
//! around something has the radius of equal area, √(A/π), about its centroid. One that is a needle, open or
//! crosses itself encloses next to nothing, and a sphere of that would be far too small: where
//! 4πA < P²/4 (a circle has 4πA = P², an ellipse of ten to one P²/4), and where it is not nearly flat, the
//! sphere is the mean of the samples with their mean distance from it, as in NeuroM. Outlines of some
//! width have about the same radius by either rule.
//!
//! Samples without any thickness, two or more, are an outline in whatever order they hang: cylinders of no
//! radius are none.

use std::f64::consts::PI;

use glam::DVec3;

use crate::{Soma, SomaKind, SomaSample};

/// Relative tolerance of the three-point soma: files round coordinates to two decimals.
const THREE_POINT_TOLERANCE: f64 = 0.01;
/// Greatest gap between a contour's ends, as a part of its length. By eye: 0.02 in C210401C.
const CONTOUR_GAP: f64 = 0.2;
/// An outline whose area is less than this part of that of a circle of its perimeter has no area worth the
/// name. By eye, between the held outlines of real cells (0.4 and more) and needles.
const CONTOUR_ROUNDNESS: f64 = 0.25;
/// Greatest distance of a contour from its plane, as a part of its radius. By eye.
const CONTOUR_BULGE: f64 = 0.25;
/// A contour's constant radius is thinner than this part of its own radius. By eye.
const CONTOUR_THICKNESS: f64 = 0.05;

impl Soma {
    /// Recognises how the samples trace a soma and finds its sphere.
    ///
    /// # Panics
    /// If there is no sample, or a parent is not among the samples.
    pub fn from_samples(samples: Vec<SomaSample>) -> Self {
        assert!(!samples.is_empty(), "a soma has at least one sample");
        let positions: Vec<DVec3> = samples.iter().map(|s| s.position.as_dvec3()).collect();
        let (kind, center, radius) = if samples.len() == 1 {
            (SomaKind::Point, positions[0], f64::from(samples[0].radius))
        } else if let Some(root) = three_point_root(&samples, &positions) {
            (
                SomaKind::ThreePoint,
                mean(&positions),
                f64::from(samples[root].radius),
            )
        } else if let Some((centroid, radius)) = contour(&samples, &positions) {
            (SomaKind::Contour, centroid, radius)
        } else if let Some((center, radius)) = without_thickness(&samples, &positions) {
            (SomaKind::Contour, center, radius)
        } else {
            (
                SomaKind::Cylinders,
                mean(&positions),
                cylinders_radius(&samples),
            )
        };
        Self {
            kind,
            samples,
            center: center.as_vec3(),
            radius: radius as f32,
        }
    }

    /// The soma that one outline or several, stacked, trace.
    ///
    /// An outline begins at the first sample and at each that does not hang on the one before.
    /// The sphere is that of the outline with the greatest one. Where none is nearly flat, it is the mean
    /// of the samples with their mean distance from it. A single sample is a sphere.
    ///
    /// # Panics
    /// If there is no sample.
    pub fn from_outlines(samples: Vec<SomaSample>) -> Self {
        if samples.len() < 2 {
            return Self::from_samples(samples);
        }
        let positions: Vec<DVec3> = samples.iter().map(|s| s.position.as_dvec3()).collect();
        let follows = |i: usize| samples[i].parent == Some(i as u32 - 1);
        let starts: Vec<usize> = (0..samples.len())
            .filter(|&i| i == 0 || !follows(i))
            .collect();
        let ends = starts.iter().skip(1).copied().chain([samples.len()]);
        let largest = starts
            .iter()
            .zip(ends)
            .filter_map(|(&start, end)| flat_outline(&positions[start..end]))
            .reduce(|best, other| if other.1 > best.1 { other } else { best });
        let (center, radius) = largest.unwrap_or_else(|| spread(&positions));
        Self {
            kind: SomaKind::Contour,
            samples,
            center: center.as_vec3(),
            radius: radius as f32,
        }
    }

    /// The first sample that two others hang on, if any.
    pub(crate) fn fork(&self) -> Option<u32> {
        let counts = child_counts(&self.samples);
        counts.iter().position(|&count| count > 1).map(|i| i as u32)
    }
}

/// Area (µm²) and volume (µm³) of a soma: of its sphere, but of cylinders the sum of their frusta
/// without caps.
pub fn soma_area_volume(soma: &Soma) -> (f64, f64) {
    if soma.kind == SomaKind::Cylinders {
        let links = || links(&soma.samples);
        return (
            links().map(|(a, b)| area(a, b)).sum(),
            links().map(|(a, b)| volume(a, b)).sum(),
        );
    }
    let r = f64::from(soma.radius).max(0.0);
    (4.0 * PI * r * r, 4.0 / 3.0 * PI * r * r * r)
}

fn mean(positions: &[DVec3]) -> DVec3 {
    positions.iter().copied().sum::<DVec3>() / positions.len() as f64
}

/// The mean of the positions and their mean distance from it.
fn spread(positions: &[DVec3]) -> (DVec3, f64) {
    let center = mean(positions);
    let distances = positions.iter().map(|p| p.distance(center));
    (center, distances.sum::<f64>() / positions.len() as f64)
}

fn child_counts(samples: &[SomaSample]) -> Vec<u32> {
    let mut counts = vec![0; samples.len()];
    for parent in samples.iter().filter_map(|s| s.parent) {
        counts[parent as usize] += 1;
    }
    counts
}

/// NeuroMorpho.Org's convention: two samples on opposite sides of the root, one radius away.
/// The direction is free: files have been turned and scaled since.
fn three_point_root(samples: &[SomaSample], positions: &[DVec3]) -> Option<usize> {
    if samples.len() != 3 {
        return None;
    }
    let root = samples.iter().position(|s| s.parent.is_none())?;
    let (a, b) = ((root + 1) % 3, (root + 2) % 3);
    let linked = [a, b]
        .iter()
        .all(|&i| samples[i].parent == Some(root as u32));
    let r = f64::from(samples[root].radius);
    let near = |x: f64, y: f64| (x - y).abs() <= THREE_POINT_TOLERANCE * r;
    let center = positions[root];
    let fits = linked
        && r > 0.0
        && [a, b]
            .iter()
            .all(|&i| near(f64::from(samples[i].radius), r))
        && [a, b]
            .iter()
            .all(|&i| near(positions[i].distance(center), r))
        && near((positions[a] + positions[b]).distance(2.0 * center), 0.0);
    fits.then_some(root)
}

/// Centroid and radius of equal area, if the samples are a closed, thin outline.
fn contour(samples: &[SomaSample], positions: &[DVec3]) -> Option<(DVec3, f64)> {
    let outline: Vec<DVec3> = chain(samples)?.into_iter().map(|i| positions[i]).collect();
    let (first, last) = (*outline.first()?, *outline.last()?);
    let length: f64 = outline.windows(2).map(|w| w[0].distance(w[1])).sum();
    if outline.len() < 4 || first.distance(last) > CONTOUR_GAP * length {
        return None;
    }
    flat_outline(&outline).filter(|&(_, radius)| thin(samples, radius))
}

/// The sphere of samples that have no thickness at all: their outline if they are in a row, else what
/// they spread over. None if they are in one place.
fn without_thickness(samples: &[SomaSample], positions: &[DVec3]) -> Option<(DVec3, f64)> {
    if samples.iter().any(|sample| sample.radius > 0.0) {
        return None;
    }
    let outline = chain(samples).map(|order| order.into_iter().map(|i| positions[i]).collect());
    let outline: Option<Vec<DVec3>> = outline;
    let sphere = outline.and_then(|outline| flat_outline(&outline));
    let sphere = sphere.unwrap_or_else(|| spread(positions));
    (sphere.1 > 0.0).then_some(sphere)
}

/// The sphere of an outline that is nearly flat: see the head of the file.
fn flat_outline(outline: &[DVec3]) -> Option<(DVec3, f64)> {
    let middle = mean(outline);
    let corners = || outline.iter().zip(outline.iter().cycle().skip(1));
    let normal: DVec3 = corners()
        .map(|(&a, &b)| (a - middle).cross(b - middle))
        .sum();
    let radius = (normal.length() / 2.0 / PI).sqrt();
    let normal = normal.try_normalize()?;
    let bulge = outline
        .iter()
        .map(|&p| (p - middle).dot(normal).abs())
        .fold(0.0, f64::max);
    let perimeter: f64 = corners().map(|(&a, &b)| a.distance(b)).sum();
    let round = 2.0 * PI * radius / perimeter;
    if round * round < CONTOUR_ROUNDNESS {
        return Some(spread(outline));
    }
    if bulge > CONTOUR_BULGE * radius {
        return None;
    }
    let weighted = |(&a, &b): (&DVec3, &DVec3)| {
        let twice_area = (a - middle).cross(b - middle).dot(normal);
        (a + b - 2.0 * middle) / 3.0 * twice_area
    };
    let moment: DVec3 = corners().map(weighted).sum();
    Some((middle + moment / (2.0 * PI * radius * radius), radius))
}

/// Whether (nearly) all radii are zero, or all the same and tiny.
fn thin(samples: &[SomaSample], contour_radius: f64) -> bool {
    let zero = samples.iter().filter(|s| s.radius == 0.0).count();
    let same = samples.iter().all(|s| s.radius == samples[0].radius);
    let thickest = samples
        .iter()
        .map(|s| f64::from(s.radius))
        .fold(0.0, f64::max);
    let tiny = thickest <= CONTOUR_THICKNESS * contour_radius;
    tiny && (same || zero * 10 >= samples.len() * 9)
}

/// The samples from the root on, if none has two children.
fn chain(samples: &[SomaSample]) -> Option<Vec<usize>> {
    let mut next = vec![None; samples.len()];
    for (i, sample) in samples.iter().enumerate() {
        if let Some(parent) = sample.parent
            && next[parent as usize].replace(i).is_some()
        {
            return None;
        }
    }
    let root = samples.iter().position(|s| s.parent.is_none());
    let chain: Vec<usize> = std::iter::successors(root, |&i| next[i]).collect();
    (chain.len() == samples.len()).then_some(chain)
}

/// Radius of the sphere with the frusta's area; where they have none, the thickest sample's.
fn cylinders_radius(samples: &[SomaSample]) -> f64 {
    let lateral: f64 = links(samples).map(|(a, b)| area(a, b)).sum();
    if lateral > 0.0 {
        return (lateral / 4.0 / PI).sqrt();
    }
    samples
        .iter()
        .map(|s| f64::from(s.radius))
        .fold(0.0, f64::max)
}

fn links(samples: &[SomaSample]) -> impl Iterator<Item = (&SomaSample, &SomaSample)> {
    samples
        .iter()
        .filter_map(|s| Some((&samples[s.parent? as usize], s)))
}

fn area(a: &SomaSample, b: &SomaSample) -> f64 {
    let length = a.position.as_dvec3().distance(b.position.as_dvec3());
    crate::frustum::frustum_area(a.radius, b.radius, length)
}

fn volume(a: &SomaSample, b: &SomaSample) -> f64 {
    let length = a.position.as_dvec3().distance(b.position.as_dvec3());
    crate::frustum::frustum_volume(a.radius, b.radius, length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn soma(samples: &[(f32, f32, f32, f32, Option<u32>)]) -> Soma {
        let sample =
            |(i, &(x, y, z, radius, parent)): (usize, &(f32, f32, f32, f32, _))| SomaSample {
                id: i as i64 + 1,
                position: Vec3::new(x, y, z),
                radius,
                parent,
            };
        Soma::from_samples(samples.iter().enumerate().map(sample).collect())
    }

    #[test]
    fn three_points_in_any_direction_are_one_sphere() {
        let (c, s) = (3.0, 4.0); // radius 5
        let soma = soma(&[
            (1., 1., 1., 5., None),
            (4., 5., 1., 5., Some(0)),
            (-2., -3., 1., 5., Some(0)),
        ]);
        assert_eq!((soma.kind, soma.radius), (SomaKind::ThreePoint, 5.0));
        assert_eq!(soma.center, Vec3::ONE);
        assert_eq!(c * c + s * s, 25.0);
    }

    #[test]
    fn three_points_in_a_row_are_cylinders() {
        let soma = soma(&[
            (0., 0., 0., 5., None),
            (0., 5., 0., 5., Some(0)),
            (0., 9., 0., 5., Some(1)),
        ]);
        assert_eq!(soma.kind, SomaKind::Cylinders);
        assert!((soma.radius - (90.0_f32 / 4.0).sqrt()).abs() < 1e-5);
    }

    #[test]
    fn thin_closed_outline_is_a_contour_of_equal_area() {
        let soma = soma(&[
            (0., 0., 0., 0., None),
            (4., 0., 0., 0., Some(0)),
            (4., 2., 0., 0., Some(1)),
            (0., 2., 0., 0., Some(2)),
            (0., 1., 0., 0., Some(3)),
        ]);
        assert_eq!(
            (soma.kind, soma.center),
            (SomaKind::Contour, Vec3::new(2., 1., 0.))
        );
        assert!((soma.radius - (8.0 / PI as f32).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn thick_closed_outline_is_cylinders() {
        let corners =
            [(0., 0.), (4., 0.), (4., 2.), (0., 2.), (0., 1.)].map(|(x, y): (f32, f32)| (x, y));
        let samples: Vec<_> = (0..5)
            .map(|i| {
                (
                    corners[i].0,
                    corners[i].1,
                    0.,
                    1.0,
                    i.checked_sub(1).map(|p| p as u32),
                )
            })
            .collect();
        assert_eq!(soma(&samples).kind, SomaKind::Cylinders);
    }

    #[test]
    fn of_stacked_outlines_the_largest_counts() {
        let square = |half: f32, z: f32| {
            [(-1., -1.), (1., -1.), (1., 1.), (-1., 1.)]
                .map(|(x, y): (f32, f32)| Vec3::new(half * x, half * y, z))
        };
        let corners = [square(1., 0.), square(2., 3.), square(1.5, 6.)].concat();
        let sample = |(i, &position): (usize, &Vec3)| SomaSample {
            id: i as i64 + 1,
            position,
            radius: 1.0,
            parent: match i {
                0 => None,
                i if i % 4 == 0 => Some(i as u32 - 4),
                i => Some(i as u32 - 1),
            },
        };
        let soma = Soma::from_outlines(corners.iter().enumerate().map(sample).collect());
        assert_eq!(
            (soma.kind, soma.center),
            (SomaKind::Contour, Vec3::new(0., 0., 3.))
        );
        assert!((soma.radius - (16.0 / PI as f32).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn outlines_without_area_have_the_mean_distance() {
        let sample = |id, x, parent| SomaSample {
            id,
            position: Vec3::new(x, 0., 0.),
            radius: 0.1,
            parent,
        };
        let soma = Soma::from_outlines(vec![sample(1, 0., None), sample(2, 4., Some(0))]);
        assert_eq!(
            (soma.kind, soma.center, soma.radius),
            (SomaKind::Contour, Vec3::new(2., 0., 0.), 2.0)
        );
    }

    fn outline(points: &[(f32, f32)]) -> Soma {
        let sample = |(i, &(x, y)): (usize, &(f32, f32))| SomaSample {
            id: i as i64 + 1,
            position: Vec3::new(x, y, 0.0),
            radius: 0.0,
            parent: i.checked_sub(1).map(|p| p as u32),
        };
        Soma::from_outlines(points.iter().enumerate().map(sample).collect())
    }

    fn mean_distance(points: &[(f32, f32)]) -> f32 {
        let points: Vec<DVec3> = points
            .iter()
            .map(|&(x, y)| Vec3::new(x, y, 0.0).as_dvec3())
            .collect();
        spread(&points).1 as f32
    }

    #[test]
    fn outlines_that_enclose_next_to_nothing_have_their_mean_distance() {
        let needle = [(0., 0.), (10., 0.2), (20., 0.), (10., -0.2)];
        let open = [(0., 0.), (5., 0.4), (10., 0.6), (15., 0.4), (20., 0.1)];
        let eight = [(0., 0.), (8., 5.), (8., 0.), (0., 5.)];
        for points in [&needle[..], &open, &eight] {
            let soma = outline(points);
            assert_eq!(soma.kind, SomaKind::Contour);
            assert_eq!(soma.radius, mean_distance(points), "{points:?}");
        }
        // One that goes around something keeps the radius of equal area.
        let round = outline(&[(0., 0.), (4., 0.), (4., 2.), (0., 2.)]);
        assert!((round.radius - (8.0 / PI as f32).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn samples_without_thickness_are_an_outline_however_they_hang() {
        let ring = |parent: fn(u32) -> Option<u32>| {
            let sample = |i: u32| {
                let angle = f64::from(i) / 12.0 * 2.0 * PI * 0.7;
                SomaSample {
                    id: i64::from(i) + 1,
                    position: (4.4 * DVec3::new(angle.cos(), angle.sin(), 0.0)).as_vec3(),
                    radius: 0.0,
                    parent: parent(i),
                }
            };
            Soma::from_samples((0..12).map(sample).collect())
        };
        // A ring with a gap, and one whose samples all hang on the first.
        let in_a_row = ring(|i| i.checked_sub(1));
        let on_the_first = ring(|i| (i > 0).then_some(0));
        for soma in [in_a_row, on_the_first] {
            assert_eq!(soma.kind, SomaKind::Contour);
            assert!((3.5..5.0).contains(&soma.radius), "{}", soma.radius);
        }
        let in_one_place = soma(&[(1., 0., 0., 0., None), (1., 0., 0., 0., Some(0))]);
        assert_eq!(
            (in_one_place.kind, in_one_place.radius),
            (SomaKind::Cylinders, 0.0)
        );
    }

    #[test]
    fn coincident_samples_take_the_thickest() {
        let soma = soma(&[(1., 0., 0., 2., None), (1., 0., 0., 2., Some(0))]);
        assert_eq!((soma.kind, soma.radius), (SomaKind::Cylinders, 2.0));
    }
}
