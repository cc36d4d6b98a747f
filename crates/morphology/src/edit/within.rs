//! What is no farther along the tree than some distance.
//!
//! ```text
//! ●──○────|────○───○   traced: soma, samples; | is at the distance
//! ●──○────◎            kept; ◎ is new, with the radius in proportion
//! ```

use super::nodes::{Edits, Nodes};
use super::{EditError, positive};
use crate::paths::Location;
use crate::{Attachment, Morphology, Node};

pub(super) fn within(
    morphology: &Morphology,
    nodes: &Nodes,
    distance: f64,
) -> Result<Edits, EditError> {
    positive("the distance along the tree", distance)?;
    let along = distances(morphology);
    let mut next_id = nodes.nodes.iter().map(|node| node.id).max().unwrap_or(0);
    let mut kept = nodes.nodes[..nodes.somata].to_vec();
    // The new index of each node that is kept; those of somata, which are all kept, stay.
    let mut number: Vec<u32> = (0..nodes.somata as u32).collect();
    let mut came = 0;
    for (node, &far) in nodes.nodes[nodes.somata..].iter().zip(&along) {
        number.push(kept.len() as u32);
        let parent = node.parent.map(|p| number[p as usize]);
        if far <= distance {
            kept.push(Node { parent, ..*node });
            continue;
        }
        // The link from a soma to its neurite is no part of the neurite: what begins beyond goes.
        let before = node
            .parent
            .map(|p| p as usize)
            .filter(|&p| p >= nodes.somata);
        let Some(before) = before.filter(|&p| along[p - nodes.somata] < distance) else {
            continue;
        };
        let from = &nodes.nodes[before];
        let share =
            (distance - along[before - nodes.somata]) / (far - along[before - nodes.somata]);
        next_id = next_id.saturating_add(1);
        came += 1;
        kept.push(Node {
            id: next_id,
            kind: node.kind,
            position: from.position.lerp(node.position, share),
            radius: from.radius + share * (node.radius - from.radius),
            parent,
            section: node.section,
        });
    }
    Ok(Edits {
        largest_move: Some(0.0),
        came,
        ..Edits::in_place(kept)
    })
}

/// Distance (µm) of each point along its tree, from the soma's center or the root.
fn distances(morphology: &Morphology) -> Vec<f64> {
    let at = |point: usize| morphology.points[point].position.as_dvec3();
    let mut distances: Vec<f64> = Vec::with_capacity(morphology.points.len());
    for section in &morphology.sections {
        for point in section.range() {
            let before = match section.attachment {
                _ if point > section.first as usize => Some(point - 1),
                Attachment::Section(id) => Some(morphology.sections[id.index()].end as usize - 1),
                Attachment::Soma { .. } | Attachment::Free => None,
            };
            distances.push(match (before, section.attachment) {
                (Some(before), _) => distances[before] + at(before).distance(at(point)),
                (None, Attachment::Soma { soma, .. }) => {
                    Location::Soma(soma).center(morphology).distance(at(point))
                }
                (None, _) => 0.0,
            });
        }
    }
    distances
}
