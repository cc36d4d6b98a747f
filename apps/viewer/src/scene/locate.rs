//! Which location of a tracing is under the cursor.

use glam::DVec3;
use neurotess::morphology::paths::Location;
use neurotess::morphology::{Morphology, Point};

use crate::model::document::Anchor;
use crate::model::measuring::{Pointed, fork_near};
use crate::model::state::{CellPart, State};
use crate::scene::picks::CursorHit;

/// How much more being at the center of the patch counts than being at the ray: where a neurite
/// passes behind itself, both parts are at the ray.
const PATCH: f64 = 0.25;

/// The ray from the eye through a pixel, in the world (µm).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) eye: DVec3,
    /// A point on it in front of the eye.
    pub(crate) through: DVec3,
}

/// The location under the cursor: on the center line of the section, or the center of the soma that
/// was hit. `reach` (µm): how far from a fork the cursor is still near it.
pub(crate) fn pointed(state: &State, hit: &CursorHit, ray: Ray, reach: f64) -> Option<Pointed> {
    let picked = hit.picked()?;
    let neuron = picked.neuron;
    let source = state.source_of(neuron)?;
    let placement = *state.placements().get(neuron)?;
    let morphology = &source.morphology;
    let back = placement.rotation.inverse();
    let inverse = |p: DVec3| back * (p - placement.translation) / placement.scale;
    let ray = Ray {
        eye: inverse(ray.eye),
        through: inverse(ray.through),
    };
    let place = inverse(hit.place);
    let location = match picked.part {
        CellPart::Section(section) => nearest(morphology, section, ray, place)?,
        CellPart::Soma => nearest_soma(morphology, place)?,
        CellPart::Neurite(_) => return None,
    };
    let fork = fork_near(morphology, location, reach / placement.scale);
    Some(Pointed {
        at: Anchor::new(neuron, location, morphology)?,
        fork: fork.and_then(|fork| Anchor::new(neuron, fork, morphology)),
    })
}

fn nearest_soma(morphology: &Morphology, place: DVec3) -> Option<Location> {
    let away = |soma: u32| Location::Soma(soma).position(morphology).distance(place);
    let somata = 0..morphology.somata.len() as u32;
    let nearest = somata.min_by(|&a, &b| away(a).total_cmp(&away(b)))?;
    Some(Location::Soma(nearest))
}

/// The location of a section that is nearest to a ray, of those near `place`.
fn nearest(morphology: &Morphology, section: u32, ray: Ray, place: DVec3) -> Option<Location> {
    let points = morphology.sections.get(section as usize)?.range();
    let candidate = |point: usize| {
        let of = |fraction| {
            let point = point as u32;
            Location::Neurite { point, fraction }
        };
        let [a, b] = [of(0.0), of(1.0)].map(|end| end.position(morphology));
        let fraction = nearest_fraction(a, b, ray);
        let at = a.lerp(b, fraction);
        // From its first point on a thin branch lies within its thick trunk.
        let radius = |p: &Point| f64::from(p.radius).max(0.0);
        let inside = radius(&morphology.points[point]);
        let cost = (distance(at, ray) - inside).max(0.0) + PATCH * at.distance(place);
        (cost, of(fraction))
    };
    let nearest = points.map(candidate).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, location)| location)
}

/// Share of the way from `a` to `b` where the segment is nearest to a ray.
fn nearest_fraction(a: DVec3, b: DVec3, ray: Ray) -> f64 {
    let Some(direction) = (ray.through - ray.eye).try_normalize() else {
        return 1.0;
    };
    // Seen along the ray, it is the point of a segment that is nearest to a point.
    let flat = |v: DVec3| v - direction * v.dot(direction);
    let (link, from) = (flat(b - a), flat(ray.eye - a));
    match link.length_squared() {
        square if square > 1e-18 => (from.dot(link) / square).clamp(0.0, 1.0),
        _ => 1.0,
    }
}

fn distance(point: DVec3, ray: Ray) -> f64 {
    let direction = (ray.through - ray.eye).try_normalize().unwrap_or_default();
    let from = point - ray.eye;
    (from - direction * from.dot(direction)).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use neurotess::morphology::{NeuriteKind, Node};

    /// A dendrite that goes right at the front and comes back behind.
    fn hairpin() -> Morphology {
        let row = |id: i64, x: f64, z: f64, parent| Node {
            id,
            kind: NeuriteKind::BASAL_DENDRITE,
            position: DVec3::new(x, 0.0, z),
            radius: 1.0,
            parent,
            section: None,
        };
        let nodes = [
            row(1, 0.0, 0.0, None),
            row(2, 10.0, 0.0, Some(0)),
            row(3, 20.0, 0.0, Some(1)),
            row(4, 20.0, -30.0, Some(2)),
            row(5, 0.0, -30.0, Some(3)),
        ];
        let built = Morphology::from_nodes("hairpin", Vec::new(), &nodes);
        built.expect("built").morphology
    }

    #[test]
    fn the_part_in_front_is_found_where_the_ray_passes() {
        let cell = hairpin();
        let ray = Ray {
            eye: DVec3::new(12.5, 0.4, 100.0),
            through: DVec3::new(12.5, 0.4, 0.0),
        };
        let place = DVec3::new(15.0, 0.0, 0.0);
        let found = nearest(&cell, 0, ray, place).expect("a section");
        let at = found.position(&cell);
        assert!(at.distance(DVec3::new(12.5, 0.0, 0.0)) < 1e-9, "{at}");
        let behind = nearest(&cell, 0, ray, DVec3::new(10.0, 0.0, -30.0));
        let at = behind.expect("a section").position(&cell);
        assert!((at.z + 30.0).abs() < 1e-9, "{at}");
        assert_eq!(nearest(&cell, 7, ray, place), None);
    }
}
