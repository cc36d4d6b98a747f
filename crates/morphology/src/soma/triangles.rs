//! The body of a surface of triangles, as of a soma from a stack of images or from electron microscopy.
//!
//! **Theory.** A surface is star-shaped about a center if each ray from there meets it once. Points from which this holds are
//! behind the planes of all triangles; one is searched for from the centroid on by stepping behind the plane that is
//! farthest in front (relaxation: Agmon 1954; Motzkin and Schoenberg 1954, Canadian Journal of Mathematics 6).
//! Where a ray meets the surface more than once, the outermost crossing counts; where it meets nothing, as where a neurite
//! was cut off, the distance is that of the directions around.
//!
//! **Practice.** Distances are taken once, on a grid of directions, and are bilinear in between: 2° apart, they follow what
//! the mesh of a soma can. A surface of 50,000 triangles takes a tenth of a second.

use std::f64::consts::FRAC_2_PI;

use glam::DVec3;

use super::directions::{ByDirection, Directions, place_on_cube};

/// Grid cells along an edge of the cube of directions.
const CELLS: u32 = 44;
/// Cells along an edge of the cube that triangles are sorted into: 6° wide, a few triangles of a soma's mesh in each.
const BINS: u32 = 16;
/// Share of what is within the outermost crossings that may be outside of the mesh: of more, the distances describe
/// another body. Two knobs on necks have 0.6 %, a tube bent into an S 15 %.
const MAX_HIDDEN: f64 = 0.05;
/// Share of directions that may meet nothing: five neurites of a third of the soma's radius leave 14 %.
const MAX_OPEN: f64 = 0.2;
/// Steps towards a center that all triangles face away from. Convex ones take fewer than ten.
const STEPS: u32 = 200;
/// Crossings nearer to each other than this share of their distance are one, at an edge between triangles.
const ONE_CROSSING: f64 = 1e-9;

/// What the center of a mesh does not see: the surface turns away there, and the shape holds what is outside of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hidden {
    /// Share of the shape's volume that is outside of the mesh.
    pub share: f64,
    /// Where it is deepest (µm).
    pub place: DVec3,
}

/// Why a surface of triangles is not taken as a soma's. Places are in the coordinates of the surface (µm).
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SomaMeshError {
    /// There are fewer than four triangles with an area.
    #[error("it has no surface: at least four triangles are needed")]
    Empty,
    /// A triangle names a vertex that is not there or not finite.
    #[error("vertex {index} (counted from 0) is missing or not finite")]
    BadVertex {
        /// The vertex.
        index: u32,
    },
    /// Too much of it is open.
    #[error(
        "it goes around nothing: {:.0} % of the directions from its middle meet no triangle: close it",
        100.0 * share
    )]
    Open {
        /// Share of all directions.
        share: f64,
    },
    /// No point within sees enough of it.
    #[error(
        "it is not star-shaped: seen from its middle it holds {:.0} % of outside, most of it near \
         ({:.2}, {:.2}, {:.2}) µm: cut off what belongs to neurites there",
        100.0 * .0.share, .0.place.x, .0.place.y, .0.place.z
    )]
    NotStarShaped(Hidden),
}

/// Distances by direction.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Triangles(ByDirection);

/// What was found along the rays of a surface.
pub(super) struct Cast {
    pub(super) center: DVec3,
    pub(super) body: Triangles,
    pub(super) hidden: Option<Hidden>,
}

impl Triangles {
    /// The distances of a surface about a point within it.
    pub(super) fn cast(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Cast, SomaMeshError> {
        let faces = faces(vertices, triangles)?;
        let (center, faces) = centered(faces);
        let directions = Directions::new(CELLS);
        let crossings = crossings(&faces, &directions.units);
        let open = crossings.iter().filter(|c| c.is_empty()).count() as f64;
        let open = open / crossings.len() as f64;
        if open > MAX_OPEN {
            return Err(SomaMeshError::Open { share: open });
        }
        let hidden = hidden(&crossings, &directions.units, center);
        if let Some(hidden) = hidden.filter(|hidden| hidden.share > MAX_HIDDEN) {
            return Err(SomaMeshError::NotStarShaped(hidden));
        }
        let met: Vec<(DVec3, f64)> = (directions.units.iter().zip(&crossings))
            .filter_map(|(&unit, crossings)| Some((unit, *crossings.last()?)))
            .collect();
        let distance = |(unit, crossings): (&DVec3, &Vec<f64>)| {
            let outermost = crossings.last().copied();
            outermost.unwrap_or_else(|| around(*unit, &met))
        };
        let distances = directions.units.iter().zip(&crossings);
        Ok(Cast {
            center,
            body: Self(ByDirection::new(CELLS, distances.map(distance).collect())),
            hidden,
        })
    }

    /// Distance of the surface along a unit direction.
    pub(super) fn distance(&self, direction: DVec3) -> f64 {
        self.0.at(direction)
    }
}

type Face = [DVec3; 3];

/// The triangles, facing outwards, without those that have no area.
fn faces(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<Face>, SomaMeshError> {
    let corner = |v: u32| {
        let vertex = vertices.get(v as usize).copied();
        let vertex = vertex.filter(|vertex| vertex.is_finite());
        vertex.ok_or(SomaMeshError::BadVertex { index: v })
    };
    let mut faces: Vec<Face> = Vec::with_capacity(triangles.len());
    for &[a, b, c] in triangles {
        let face = [corner(a)?, corner(b)?, corner(c)?];
        if vector_area(&face).length_squared() > 0.0 {
            faces.push(face);
        }
    }
    if faces.len() < 4 {
        return Err(SomaMeshError::Empty);
    }
    let middle = centroid_of_area(&faces);
    let volume: f64 = faces.iter().map(|face| six_volumes(face, middle)).sum();
    if volume < 0.0 {
        faces.iter_mut().for_each(|face| face.swap(1, 2));
    }
    Ok(faces)
}

/// The faces about the center that distances are from, and that center.
fn centered(mut faces: Vec<Face>) -> (DVec3, Vec<Face>) {
    let middle = centroid(&faces);
    let center = kernel(&faces, middle).unwrap_or(middle);
    let corners = faces.iter_mut().flatten();
    corners.for_each(|corner| *corner -= center);
    (center, faces)
}

fn vector_area([a, b, c]: &Face) -> DVec3 {
    (*b - *a).cross(*c - *a) * 0.5
}

fn six_volumes(face: &Face, about: DVec3) -> f64 {
    let [a, b, c] = face.map(|corner| corner - about);
    a.dot(b.cross(c))
}

fn centroid_of_area(faces: &[Face]) -> DVec3 {
    let (sum, all) = faces.iter().fold((DVec3::ZERO, 0.0), |(sum, all), face| {
        let area = vector_area(face).length();
        let middle = (face[0] + face[1] + face[2]) / 3.0;
        (sum + middle * area, all + area)
    });
    sum / all
}

/// The centroid of the volume.
fn centroid(faces: &[Face]) -> DVec3 {
    let middle = centroid_of_area(faces);
    let (sum, all) = faces.iter().fold((DVec3::ZERO, 0.0), |(sum, all), face| {
        let volume = six_volumes(face, middle);
        let corners = face.iter().map(|&corner| corner - middle);
        (sum + corners.sum::<DVec3>() * (volume / 4.0), all + volume)
    });
    match all > 0.0 {
        true => middle + sum / all,
        false => middle,
    }
}

/// A point behind the planes of all faces, if one is found from `start` on.
fn kernel(faces: &[Face], start: DVec3) -> Option<DVec3> {
    let planes: Vec<(DVec3, f64)> = (faces.iter())
        .map(|face| {
            let normal = vector_area(face).normalize_or_zero();
            (normal, normal.dot(face[0]))
        })
        .collect();
    let reach = |center: DVec3| {
        let corners = faces.iter().flatten();
        let square = corners.map(|corner| corner.distance_squared(center));
        square.fold(0.0, f64::max).sqrt()
    };
    // So far behind, so that a center on an edge is none.
    let behind = 0.02 * reach(start);
    let mut center = start;
    for _ in 0..STEPS {
        let ahead = |(normal, offset): &(DVec3, f64)| (normal.dot(center) - offset, *normal);
        let worst = planes.iter().map(ahead);
        let (ahead, normal) = worst.max_by(|a, b| a.0.total_cmp(&b.0))?;
        if ahead < 0.0 {
            return Some(center);
        }
        center -= normal * (ahead + behind);
    }
    None
}

/// Distances at which rays from the origin cross faces, each ray's nearest first.
fn crossings(faces: &[Face], units: &[DVec3]) -> Vec<Vec<f64>> {
    let bins = Directions::new(BINS);
    // Each direction belongs to the nearest corner of a coarser grid.
    let mut directions_of = vec![Vec::new(); bins.units.len()];
    let (mut bin_of, side) = (Vec::with_capacity(units.len()), BINS as usize + 1);
    for (index, &unit) in units.iter().enumerate() {
        let (face, place) = place_on_cube(unit);
        let [i, j] = place.map(|x| {
            let x = (0.5 + x.atan() * FRAC_2_PI) * f64::from(BINS);
            (x.round() as usize).min(side - 1)
        });
        let bin = (face * side + i) * side + j;
        directions_of[bin].push(index);
        bin_of.push(bin);
    }
    // Greatest angle between a direction and its bin.
    let off = units.iter().zip(&bin_of);
    let off = off.map(|(unit, &bin)| unit.dot(bins.units[bin]).min(1.0).acos());
    let off = off.fold(0.0, f64::max);
    let mut crossings = vec![Vec::new(); units.len()];
    for face in faces {
        let corners = face.map(DVec3::normalize_or_zero);
        let axis = (corners[0] + corners[1] + corners[2]).normalize_or_zero();
        let least = corners.map(|corner| corner.dot(axis).clamp(-1.0, 1.0));
        let angle = least.map(f64::acos).into_iter().fold(0.0, f64::max);
        // What reaches around more than a quarter is beside every direction.
        let least = match angle + off < std::f64::consts::FRAC_PI_2 {
            true => (angle + off).cos() - 1e-9,
            false => -1.0,
        };
        let near = bins.units.iter().zip(&directions_of);
        for (_, directions) in near.filter(|(bin, _)| bin.dot(axis) >= least) {
            for &index in directions {
                crossings[index].extend(crossing(face, units[index]));
            }
        }
    }
    for along in &mut crossings {
        along.sort_by(f64::total_cmp);
        along.dedup_by(|far, near| *far - *near <= ONE_CROSSING * *near);
    }
    crossings
}

/// Distance at which a ray from the origin crosses a face, on whichever side it comes.
fn crossing([a, b, c]: &Face, ray: DVec3) -> Option<f64> {
    let sides = [a.cross(*b), b.cross(*c), c.cross(*a)].map(|side| side.dot(ray));
    let within = sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0);
    let normal = (*b - *a).cross(*c - *a);
    let distance = a.dot(normal) / ray.dot(normal);
    (within && distance.is_finite() && distance > 0.0).then_some(distance)
}

/// What lies between crossings of rays that meet the surface more than once: how much of all that is within the outermost
/// ones, and where it is deepest.
fn hidden(crossings: &[Vec<f64>], units: &[DVec3], center: DVec3) -> Option<Hidden> {
    let cube = |r: &f64| r * r * r;
    let gaps = crossings.iter().flat_map(|along| along.chunks_exact(2));
    // A pair that ends a ray was left open.
    let outside: f64 = gaps.map(|pair| cube(&pair[1]) - cube(&pair[0])).sum();
    let within: f64 = crossings
        .iter()
        .filter_map(|along| along.last())
        .map(cube)
        .sum();
    let share = outside / within;
    let depth = |along: &[f64]| along.last().zip(along.first()).map_or(0.0, |(l, f)| l - f);
    let worst = crossings.iter().zip(units);
    let worst = worst.max_by(|(a, _), (b, _)| depth(a).total_cmp(&depth(b)));
    let (along, unit) = worst.filter(|(along, _)| along.len() > 1)?;
    Some(Hidden {
        share,
        place: center + *unit * *along.last()?,
    })
}

/// The distance in a direction that meets nothing: the mean of those that do, by the inverse fourth power of the angle.
fn around(unit: DVec3, met: &[(DVec3, f64)]) -> f64 {
    let (sum, all) = met
        .iter()
        .fold((0.0, 0.0), |(sum, all), (other, distance)| {
            let square = (1.0 - unit.dot(*other)).max(f64::MIN_POSITIVE);
            let weight = 1.0 / (square * square);
            (sum + weight * distance, all + weight)
        });
    sum / all
}

#[cfg(test)]
mod tests;
