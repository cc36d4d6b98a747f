//! Components of the surface that are no part of the union, or of no use.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::arrange::winding::{Query, windings};
use crate::report::{Part, Why};
use crate::surface::work::{Work, components};

/// A component, with sums over its faces.
#[derive(Clone, Default)]
struct Component {
    volume: f64,
    /// Volumes are taken about it: far from the origin little would be left of a small one.
    base: DVec3,
    /// Sum of the corners of all faces.
    corners: DVec3,
    faces: f64,
    /// The component's face that a ray along x leaves most safely, and how safely.
    face: u32,
    safety: f64,
    /// Components of the input that its faces come from.
    parts: BTreeSet<u32>,
}

/// Components of the surface: for each face its number, and what each is.
fn survey(work: &Work) -> (Vec<u32>, Vec<Component>) {
    let numbers = components(work.vertices.len(), &work.triangles);
    let count = numbers.iter().max().map_or(0, |&last| last as usize + 1);
    let mut found = vec![Component::default(); count];
    for (face, &number) in (0..).zip(&numbers) {
        let component = &mut found[number as usize];
        let [a, b, c] = work.corners(face);
        if component.faces == 0.0 {
            component.base = a;
        }
        let base = component.base;
        component.volume += (a - base).dot((b - base).cross(c - base)) / 6.0;
        component.corners += a + b + c;
        component.faces += 1.0;
        component.parts.insert(work.parts[face as usize]);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let safety = (b - a).cross(c - a).x.abs() / longest.max(f64::MIN_POSITIVE);
        if safety > component.safety {
            (component.face, component.safety) = (face, safety);
        }
    }
    (numbers, found)
}

/// Leaves out components that cross nothing and are no boundary of the union: those inside others and those
/// turned inside out. `pairs` are the faces that cross.
pub(crate) fn drop_hidden(work: &mut Work, pairs: &[[u32; 2]]) -> Vec<Part> {
    let (numbers, found) = survey(work);
    let mut crosses = vec![false; found.len()];
    for &face in pairs.iter().flatten() {
        crosses[numbers[face as usize] as usize] = true;
    }
    let free: Vec<usize> = (0..found.len()).filter(|&n| !crosses[n]).collect();
    if free.is_empty() || (found.len() == 1 && found[0].volume > 0.0) {
        return Vec::new();
    }
    let query = |&n: &usize| Query {
        point: work.corners(found[n].face).iter().sum::<DVec3>() / 3.0,
        without: vec![found[n].face],
    };
    let queries: Vec<Query> = free.iter().map(query).collect();
    let beside = windings(|face| work.corners(face), work.triangles.len(), &queries);
    let mut why: BTreeMap<u32, Why> = BTreeMap::new();
    for (&n, winding) in free.iter().zip(beside) {
        let [a, b, c] = work.corners(found[n].face);
        let rises = (b - a).cross(c - a).x > 0.0;
        // The side of the normal has one less than the side behind.
        let outside = if rises { winding } else { winding - 1 };
        if outside != 0 {
            let why_ = if found[n].volume > 0.0 {
                Why::Inside
            } else {
                Why::Inverted
            };
            why.insert(n as u32, why_);
        }
    }
    leave_out(work, &numbers, &found, &why)
}

/// What [`drop_splinters`] has found.
pub(crate) struct Splinters {
    pub(crate) dropped: Vec<Part>,
    pub(crate) cut_off: Vec<Part>,
}

/// Leaves out cavities and splinters that cuts made. The largest component of each component of the input
/// stays whatever its size; further ones with a volume stay too, and are told as cut off.
pub(crate) fn drop_splinters(work: &mut Work, least: f64) -> Splinters {
    let (numbers, found) = survey(work);
    let heirs = heirs(&found);
    let mut why: BTreeMap<u32, Why> = BTreeMap::new();
    let mut cut_off = Vec::new();
    for (n, component) in (0..).zip(&found).filter(|(n, _)| !heirs.contains(n)) {
        if component.volume <= 0.0 {
            why.insert(n, Why::Cavity);
        } else if component.volume < least {
            why.insert(n, Why::Tiny);
        } else {
            cut_off.push(part(work, component, Why::CutOff));
        }
    }
    Splinters {
        dropped: leave_out(work, &numbers, &found, &why),
        cut_off,
    }
}

/// The largest component of each component of the input.
fn heirs(found: &[Component]) -> BTreeSet<u32> {
    let mut heirs: BTreeMap<u32, u32> = BTreeMap::new();
    for (n, component) in (0..).zip(found) {
        for &part in &component.parts {
            let heir = heirs.entry(part).or_insert(n);
            if component.volume > found[*heir as usize].volume {
                *heir = n;
            }
        }
    }
    heirs.into_values().collect()
}

/// For each face the number of its component, and the numbers of those that were cut off, with a component of the
/// input that each is of.
pub(crate) fn cut_off(work: &Work) -> (Vec<u32>, Vec<(u32, u32)>) {
    let (numbers, found) = survey(work);
    let heirs = heirs(&found);
    let others = (0..).zip(&found).filter(|(n, _)| !heirs.contains(n));
    let others = others.filter_map(|(n, component)| Some((n, *component.parts.first()?)));
    (numbers, others.collect())
}

/// Components that are cut off, as they are told.
pub(crate) fn still_cut_off(work: &Work) -> Vec<Part> {
    let (_, found) = survey(work);
    let heirs = heirs(&found);
    let others = (0..).zip(&found).filter(|(n, _)| !heirs.contains(n));
    let parts = others.map(|(_, component)| part(work, component, Why::CutOff));
    parts.collect()
}

fn leave_out(
    work: &mut Work,
    numbers: &[u32],
    found: &[Component],
    why: &BTreeMap<u32, Why>,
) -> Vec<Part> {
    let parts = why
        .iter()
        .map(|(&n, &why)| part(work, &found[n as usize], why))
        .collect();
    if !why.is_empty() {
        work.retain(|face| !why.contains_key(&numbers[face]));
    }
    parts
}

fn part(work: &Work, component: &Component, why: Why) -> Part {
    let corner = work.triangles[component.face as usize][0];
    Part {
        position: work.place(component.corners / (3.0 * component.faces)),
        volume: component.volume,
        point: work.vertices[corner as usize].point,
        why,
    }
}

/// The volume (µm³) below which a component is a splinter: half a cube of the median radius, between 10⁻⁷ and
/// 10⁻⁴ of the whole.
pub(crate) fn least_volume(work: &Work, whole: f64) -> f64 {
    let mut radii: Vec<f32> = work.vertices.iter().map(|vertex| vertex.radius).collect();
    let middle = radii.len() / 2;
    let median = if radii.is_empty() {
        0.0
    } else {
        f64::from(*radii.select_nth_unstable_by(middle, f32::total_cmp).1)
    };
    let whole = whole.abs();
    (0.5 * median.powi(3)).clamp(1e-7 * whole, 1e-4 * whole)
}
