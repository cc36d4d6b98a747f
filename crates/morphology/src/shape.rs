//! Shape of the trees, section by section: orders, lengths, areas, distances, contraction, forks.
//!
//! Every function is linear in its input and gives one value per section, in the order of
//! [`Morphology::sections`], unless it says otherwise.

use glam::DVec3;

use crate::frustum::{distance, frustum_area, frustum_volume};
use crate::{Attachment, Morphology, Point, SectionId};

/// Consecutive points of a section, from the point that it branches from on; that point is left
/// out where it is a soma's, or where there is none.
pub fn links(
    morphology: &Morphology,
    id: SectionId,
) -> impl Iterator<Item = (&Point, &Point)> + Clone {
    let section = &morphology.sections[id.index()];
    let own = &morphology.points[section.range()];
    let branch_link = branch_point(morphology, id).zip(own.first());
    branch_link
        .into_iter()
        .chain(own.windows(2).map(|w| (&w[0], &w[1])))
}

/// The point that a section branches from: the last one of its parent section.
pub fn branch_point(morphology: &Morphology, id: SectionId) -> Option<&Point> {
    let parent = morphology.sections[id.index()].parent()?;
    morphology.section_points(parent).last()
}

/// Number of child sections.
pub fn child_counts(morphology: &Morphology) -> Vec<u32> {
    let mut counts = vec![0; morphology.sections.len()];
    for parent in morphology
        .sections
        .iter()
        .filter_map(crate::Section::parent)
    {
        counts[parent.index()] += 1;
    }
    counts
}

/// Number of the neurite that each section belongs to, from 0 in the order of the tracing.
pub fn neurites(morphology: &Morphology) -> Vec<u32> {
    let mut count = 0;
    let mut neurites: Vec<u32> = Vec::with_capacity(morphology.sections.len());
    for section in &morphology.sections {
        neurites.push(match section.parent() {
            Some(parent) => neurites[parent.index()],
            None => {
                count += 1;
                count - 1
            }
        });
    }
    neurites
}

/// Number of forks between the neurite's start and the section; a change of type is none.
pub fn branch_orders(morphology: &Morphology) -> Vec<u32> {
    let children = child_counts(morphology);
    let mut orders = vec![0; children.len()];
    for (index, section) in morphology.sections.iter().enumerate() {
        if let Attachment::Section(parent) = section.attachment {
            let fork = u32::from(children[parent.index()] > 1);
            orders[index] = orders[parent.index()] + fork;
        }
    }
    orders
}

/// Strahler order: 1 of an end; of a fork the greatest of its children's, and one more if two of them have it
/// (Strahler, Quantitative Analysis of Watershed Geomorphology, 1957). A change of type is no fork.
pub fn strahler_orders(morphology: &Morphology) -> Vec<u32> {
    let mut orders = vec![1; morphology.sections.len()];
    // Of the children so far: the greatest order, and how many have it.
    let mut greatest = vec![(0_u32, 0_u32); orders.len()];
    for (index, section) in morphology.sections.iter().enumerate().rev() {
        orders[index] = match greatest[index] {
            (0, _) => 1,
            (order, 1) => order,
            (order, _) => order + 1,
        };
        if let Some(parent) = section.parent() {
            let (order, count) = &mut greatest[parent.index()];
            match orders[index].cmp(order) {
                std::cmp::Ordering::Greater => (*order, *count) = (orders[index], 1),
                std::cmp::Ordering::Equal => *count += 1,
                std::cmp::Ordering::Less => {}
            }
        }
    }
    orders
}

/// Length (µm) of each section along its points.
pub fn section_lengths(morphology: &Morphology) -> Vec<f64> {
    let length = |id| links(morphology, id).map(|(a, b)| distance(a, b)).sum();
    ids(morphology).map(length).collect()
}

/// Area (µm²) of each section's frusta, without caps.
pub fn section_areas(morphology: &Morphology) -> Vec<f64> {
    let area = |(a, b): (&Point, &Point)| frustum_area(a.radius, b.radius, distance(a, b));
    let areas = ids(morphology).map(|id| links(morphology, id).map(area).sum());
    areas.collect()
}

/// Volume (µm³) of each section's frusta.
pub fn section_volumes(morphology: &Morphology) -> Vec<f64> {
    let volume = |(a, b): (&Point, &Point)| frustum_volume(a.radius, b.radius, distance(a, b));
    let volumes = ids(morphology).map(|id| links(morphology, id).map(volume).sum());
    volumes.collect()
}

/// Distance (µm) of each section's last point from a place, given in the file's coordinates.
pub fn end_distances(morphology: &Morphology, from: DVec3) -> Vec<f64> {
    let from = from - morphology.origin;
    let last = |section: &crate::Section| morphology.points[section.end as usize - 1];
    let ends = morphology.sections.iter().map(last);
    ends.map(|point| point.position.as_dvec3().distance(from))
        .collect()
}

/// Length (µm) of the way from the neurite's first point to the section's end.
pub fn path_lengths(morphology: &Morphology) -> Vec<f64> {
    let mut lengths = section_lengths(morphology);
    for (index, section) in morphology.sections.iter().enumerate() {
        if let Some(parent) = section.parent() {
            lengths[index] += lengths[parent.index()];
        }
    }
    lengths
}

/// Distance of a section's ends by its length, in [0, 1]: 1 is straight. The inverse is called
/// tortuosity. `None` where the section has no length.
pub fn contractions(morphology: &Morphology) -> Vec<Option<f64>> {
    let contraction = |id| {
        let mut links = links(morphology, id);
        let (from, mut to) = links.next()?;
        let mut length = distance(from, to);
        for (a, b) in links {
            length += distance(a, b);
            to = b;
        }
        (length > 0.0).then(|| distance(from, to) / length)
    };
    ids(morphology).map(contraction).collect()
}

/// The sections that branch from the end of a section.
pub fn children(morphology: &Morphology, parent: SectionId) -> Vec<SectionId> {
    let hangs = |id: &SectionId| morphology.sections[id.index()].parent() == Some(parent);
    ids(morphology).filter(hangs).collect()
}

/// Angle (radians, in [0, π]) between two sections that branch from the same point, measured to the
/// points `reach` µm along them (or to their ends); `None` where a section has no direction. With
/// [`LOCAL`] and [`REMOTE`] it is NeuroM's local and remote bifurcation angle.
pub fn angle_between(morphology: &Morphology, [a, b]: [SectionId; 2], reach: f64) -> Option<f64> {
    let direction = |id| leaving(morphology, id, reach);
    Some(angle(direction(a)?, direction(b)?))
}

/// Reach of an angle that is measured to the first points that are elsewhere than the fork.
pub const LOCAL: f64 = f64::MIN_POSITIVE;

/// Reach of an angle that is measured to the ends of sections.
pub const REMOTE: f64 = f64::INFINITY;

/// Angle (radians, in [0, π]) between the two children of a section, measured to the points
/// `reach` µm along them (or to their ends); `None` where there are not two.
pub fn fork_angles(morphology: &Morphology, reach: f64) -> Vec<Option<f64>> {
    let mut directions: Vec<Vec<DVec3>> = vec![Vec::new(); morphology.sections.len()];
    for id in ids(morphology) {
        if let Some(parent) = morphology.sections[id.index()].parent()
            && let Some(direction) = leaving(morphology, id, reach)
        {
            directions[parent.index()].push(direction);
        }
    }
    let pair = |children: &Vec<DVec3>| match children[..] {
        [a, b] => Some(angle(a, b)),
        _ => None,
    };
    directions.iter().map(pair).collect()
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos()
}

/// Unit direction from the branch point to the point `reach` µm along the section.
pub fn leaving(morphology: &Morphology, id: SectionId, reach: f64) -> Option<DVec3> {
    let from = branch_point(morphology, id)?.position.as_dvec3();
    let mut length = 0.0;
    let mut to = from;
    for (a, b) in links(morphology, id) {
        length += distance(a, b);
        to = b.position.as_dvec3();
        if length >= reach {
            break;
        }
    }
    (to - from).try_normalize()
}

/// Partition asymmetry |n − m| / (n + m) of the numbers n and m of sections on the two children of a section, in
/// [0, 1), 0 where both are ends; `None` where there are not two children. As in the Petilla convention (Scorcioni,
/// Polavaram and Ascoli, L-Measure, 2008) and in NeuroM.
pub fn partition_asymmetries(morphology: &Morphology) -> Vec<Option<f64>> {
    let count = morphology.sections.len();
    let mut sizes = vec![1_u32; count];
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (index, section) in morphology.sections.iter().enumerate().rev() {
        if let Some(parent) = section.parent() {
            sizes[parent.index()] += sizes[index];
            children[parent.index()].push(sizes[index]);
        }
    }
    let asymmetry = |sizes: &Vec<u32>| match sizes[..] {
        [n, m] => Some(f64::from(n.abs_diff(m)) / (f64::from(n) + f64::from(m))),
        _ => None,
    };
    children.iter().map(asymmetry).collect()
}

pub(crate) fn ids(morphology: &Morphology) -> impl Iterator<Item = SectionId> + use<> {
    (0..morphology.sections.len() as u32).map(SectionId)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NeuriteKind, Node};

    /// A trunk that forks into an end and a branch that forks into two; the trunk's type changes half-way.
    fn cell() -> Morphology {
        let row = |id: i64, kind: i32, x: f64, y: f64, parent: Option<u32>| Node {
            id,
            kind: NeuriteKind(kind),
            position: DVec3::new(x, y, 0.0),
            radius: 1.0,
            parent,
            section: None,
        };
        let nodes = [
            row(1, 3, 0.0, 0.0, None),
            row(2, 3, 5.0, 0.0, Some(0)),
            row(3, 4, 10.0, 0.0, Some(1)),
            row(4, 4, 20.0, 0.0, Some(2)),
            row(5, 4, 10.0, 10.0, Some(2)),
            row(6, 4, 10.0, 20.0, Some(4)),
            row(7, 4, 20.0, 10.0, Some(4)),
        ];
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        built.expect("built").morphology
    }

    #[test]
    fn orders_and_partitions_are_those_of_the_literature() {
        let cell = cell();
        assert_eq!(strahler_orders(&cell), [2, 2, 1, 2, 1, 1]);
        assert_eq!(branch_orders(&cell), [0, 0, 1, 1, 2, 2]);
        let asymmetries = partition_asymmetries(&cell);
        assert_eq!(asymmetries, [None, Some(0.5), None, Some(0.0), None, None]);
        assert_eq!(end_distances(&cell, DVec3::ZERO)[..3], [5.0, 10.0, 20.0]);
        assert_eq!(section_lengths(&cell), [5.0, 5.0, 10.0, 10.0, 10.0, 10.0]);
        let sum: f64 = section_areas(&cell).iter().sum();
        assert!((sum - crate::Measures::of(&cell).area).abs() < 1e-9);
        let sum: f64 = section_volumes(&cell).iter().sum();
        assert!((sum - crate::Measures::of(&cell).volume).abs() < 1e-9);
    }
}
