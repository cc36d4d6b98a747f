//! Where surfaces cross, told by what the vertices know of the tracing.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use neurotess_mesh::Forest;

use crate::report::{Kin, Place};
use crate::surface::work::Work;

/// The places of pairs of faces that cross.
pub(crate) fn places(work: &Work, pairs: &[[u32; 2]]) -> Vec<Place> {
    if pairs.is_empty() {
        return Vec::new();
    }
    let mut clusters: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
    let mut forest = connected(work, pairs);
    for &pair in pairs {
        let corner = work.triangles[pair[0] as usize][0];
        clusters.entry(forest.root(corner)).or_default().push(pair);
    }
    let neighbors = neighbors(work);
    let found = clusters
        .into_values()
        .map(|pairs| place(work, &pairs, &neighbors));
    let mut places = joined(found);
    places.sort_by(|a, b| {
        let key = |p: &Place| (p.points, p.position.to_array().map(f64::to_bits));
        key(a).cmp(&key(b))
    });
    places
}

/// Vertices that hang together by faces that cross.
fn connected(work: &Work, pairs: &[[u32; 2]]) -> Forest {
    let mut forest = Forest::new(work.vertices.len());
    for pair in pairs {
        let [a, b] = pair.map(|face| work.triangles[face as usize]);
        for corner in [a[1], a[2], b[0], b[1], b[2]] {
            forest.unite(a[0], corner);
        }
    }
    forest
}

/// Sections that share a face, lower first.
fn neighbors(work: &Work) -> BTreeSet<[i32; 2]> {
    let mut pairs = BTreeSet::new();
    for face in &work.triangles {
        let [a, b, c] = face.map(|corner| work.vertices[corner as usize].section);
        for (a, b) in [(a, b), (b, c), (c, a)] {
            if a != b {
                pairs.insert([a.min(b), a.max(b)]);
            }
        }
    }
    pairs
}

/// A ball whose skin a vertex is.
struct Ball {
    center: DVec3,
    radius: f64,
    point: i32,
    section: i32,
}

/// The two balls furthest apart of those that the corners of a face are on: on a tube, a piece of its axis.
fn axis(work: &Work, face: u32) -> [Ball; 2] {
    let [a, b, c] = work.triangles[face as usize].map(|corner| {
        let vertex = &work.vertices[corner as usize];
        let radius = f64::from(vertex.radius);
        Ball {
            center: vertex.position.as_dvec3() - radius * vertex.normal.as_dvec3(),
            radius,
            point: vertex.point,
            section: vertex.section,
        }
    });
    let far = |a: &Ball, b: &Ball| a.center.distance_squared(b.center);
    let lengths = [far(&a, &b), far(&b, &c), far(&c, &a)];
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    if lengths[0] == longest {
        [a, b]
    } else if lengths[1] == longest {
        [b, c]
    } else {
        [c, a]
    }
}

/// Where two segments are closest, as shares of their ways (C. Ericson, Real-Time Collision Detection, 2005,
/// 5.1.9).
fn closest([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> [f64; 2] {
    let (along, across, from) = (q - p, s - r, p - r);
    let (a, e, f) = (along.dot(along), across.dot(across), across.dot(from));
    let (b, c) = (along.dot(across), along.dot(from));
    let share = |of: f64, by: f64| {
        if by > 0.0 {
            (of / by).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let on_first = share(b * f - c * e, a * e - b * b);
    let on_second = share(b * on_first + f, e);
    [share(b * on_second - c, a), on_second]
}

/// A place, and how wide (µm) both surfaces are there together.
fn place(work: &Work, pairs: &[[u32; 2]], neighbors: &BTreeSet<[i32; 2]>) -> (Place, f64) {
    let mut sum = DVec3::ZERO;
    let mut width = 0.0_f64;
    let mut deepest: Option<(f64, f64, [i32; 2], [i32; 2])> = None;
    for &[a, b] in pairs {
        for face in [a, b] {
            sum += work.corners(face).iter().sum::<DVec3>() / 3.0;
        }
        let [one, other] = [axis(work, a), axis(work, b)];
        let places = closest(
            one.each_ref().map(|ball| ball.center),
            other.each_ref().map(|ball| ball.center),
        );
        let at = |[from, to]: &[Ball; 2], share: f64| {
            let center = from.center.lerp(to.center, share);
            (center, from.radius + share * (to.radius - from.radius))
        };
        let ((center, radius), (far, wide)) = (at(&one, places[0]), at(&other, places[1]));
        let thinner = radius.min(wide).max(0.0);
        width = width.max(2.0 * (radius + wide));
        let depth = (radius + wide - center.distance(far)).clamp(0.0, 2.0 * thinner);
        if deepest.is_none_or(|(most, ..)| depth > most) {
            let nearest = |ends: &[Ball; 2], share: f64| {
                let end = &ends[usize::from(share > 0.5)];
                (end.point, end.section)
            };
            let (first, second) = (nearest(&one, places[0]), nearest(&other, places[1]));
            let (points, sections) = ([first.0, second.0], [first.1, second.1]);
            deepest = Some((depth, thinner, points, sections));
        }
    }
    let (depth, thinner, points, sections) = deepest.unwrap_or_default();
    let [a, b] = sections;
    let near = a == b || neighbors.contains(&[a.min(b), a.max(b)]);
    let place = Place {
        position: work.place(sum / (2.0 * pairs.len() as f64)),
        pairs: pairs.len(),
        points,
        sections,
        depth,
        relative_depth: if thinner > 0.0 { depth / thinner } else { 0.0 },
        kin: if near { Kin::Near } else { Kin::Apart },
    };
    (place, width)
}

/// Places put together where a branch enters another and leaves it: of the same two sections, no further apart
/// than both are wide.
fn joined(places: impl Iterator<Item = (Place, f64)>) -> Vec<Place> {
    let mut by_sections: BTreeMap<[i32; 2], Vec<(Place, f64)>> = BTreeMap::new();
    for (place, width) in places {
        let [a, b] = place.sections;
        let same = by_sections.entry([a.min(b), a.max(b)]).or_default();
        let near = |(other, widest): &&mut (Place, f64)| {
            place.position.distance(other.position) < width.max(*widest)
        };
        match same.iter_mut().find(near) {
            Some(other) => *other = (together(other.0, place), width.max(other.1)),
            None => same.push((place, width)),
        }
    }
    by_sections
        .into_values()
        .flatten()
        .map(|(place, _)| place)
        .collect()
}

fn together(a: Place, b: Place) -> Place {
    let deeper = if b.depth > a.depth { b } else { a };
    let pairs = a.pairs + b.pairs;
    let weighted = a.pairs as f64 * a.position + b.pairs as f64 * b.position;
    Place {
        position: weighted / pairs as f64,
        pairs,
        ..deeper
    }
}
