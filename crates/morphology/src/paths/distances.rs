//! Distances along a tracing, from one location to all points.

use super::links::{point_before, soma_of};
use super::location::Location;
use crate::Morphology;

/// Length (µm) of the path from a location to each point; none where there is no path. Linear in
/// the points.
///
/// # Panics
/// If the location is not on the tracing.
pub fn path_distances(morphology: &Morphology, from: Location) -> Vec<Option<f64>> {
    let mut distances = vec![None; morphology.points.len()];
    let from = from.at_point(morphology);
    let at = |point: u32| morphology.points[point as usize].position.as_dvec3();
    // Upwards: the points between the location and the soma.
    let mut soma = match from {
        Location::Soma(soma) => Some((soma, 0.0)),
        Location::Neurite { .. } => None,
    };
    if let Location::Neurite { point, .. } = from {
        let mut here = from.center(morphology);
        distances[point as usize] = Some(here.distance(at(point)));
        let mut length = 0.0;
        let mut next = match from == Location::of_point(point) {
            true => Some(point),
            false => point_before(morphology, point),
        };
        let mut first = point;
        while let Some(above) = next {
            length += here.distance(at(above));
            distances[above as usize] = Some(length);
            (here, first) = (at(above), above);
            next = point_before(morphology, above);
        }
        if let Some(of) = soma_of(morphology, first) {
            let center = Location::Soma(of).center(morphology);
            soma = Some((of, length + here.distance(center)));
        }
    }
    // Downwards: parents come before their children.
    for section in &morphology.sections {
        for point in section.first..section.end {
            if distances[point as usize].is_some() {
                continue;
            }
            distances[point as usize] = match point_before(morphology, point) {
                Some(before) => {
                    distances[before as usize].map(|d| d + at(before).distance(at(point)))
                }
                None => soma.and_then(|(of, length)| {
                    let center = Location::Soma(of).center(morphology);
                    (soma_of(morphology, point) == Some(of))
                        .then(|| length + center.distance(at(point)))
                }),
            };
        }
    }
    distances
}
