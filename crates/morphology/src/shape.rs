//! Shape of the trees, section by section: orders, path lengths, contraction, fork angles.
//!
//! Every function is linear in its input and gives one value per section, in the order of
//! [`Morphology::sections`], unless it says otherwise.

use glam::DVec3;

use crate::frustum::distance;
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

/// Length (µm) of each section along its points.
pub fn section_lengths(morphology: &Morphology) -> Vec<f64> {
    let length = |id| links(morphology, id).map(|(a, b)| distance(a, b)).sum();
    ids(morphology).map(length).collect()
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
    let angle = |children: &Vec<DVec3>| match children[..] {
        [a, b] => Some(a.dot(b).clamp(-1.0, 1.0).acos()),
        _ => None,
    };
    directions.iter().map(angle).collect()
}

/// Direction from the branch point to the point `reach` µm along the section.
fn leaving(morphology: &Morphology, id: SectionId, reach: f64) -> Option<DVec3> {
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

fn ids(morphology: &Morphology) -> impl Iterator<Item = SectionId> + use<> {
    (0..morphology.sections.len() as u32).map(SectionId)
}
