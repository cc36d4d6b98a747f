//! Spines at random places of a density.

use super::base::Base;
use super::line::{APART, Line};
use super::shape::Spine;
use super::{Grown, MOST};
use crate::edit::nodes::Nodes;
use crate::edit::{EditError, positive};
use crate::random::Random;
use crate::{Morphology, NeuriteKind, SectionId};

/// Grows so many spines on each µm of dendrites.
pub(super) fn grow(
    morphology: &Morphology,
    nodes: &Nodes,
    density: f64,
    seed: u64,
    grown: &mut Grown,
) -> Result<(), EditError> {
    positive("the density of spines", density)?;
    let ids = (0..morphology.sections.len() as u32).map(SectionId);
    let dendrites = ids.filter(|id| is_dendrite(morphology.sections[id.index()].kind));
    let lines: Vec<(SectionId, Line<'_>)> = dendrites
        .map(|id| (id, Line::new(morphology, nodes, id)))
        .collect();
    let spines = density * lines.iter().map(|(_, line)| line.length()).sum::<f64>();
    if spines > MOST {
        return Err(EditError::TooManySpines { density, spines });
    }
    for (id, line) in &lines {
        // A stream for each section, so that one that is edited leaves the others' spines as they are.
        let mut random = Random::new(seed, u64::from(id.0));
        grow_on(line, density, &mut random, grown);
    }
    Ok(())
}

fn is_dendrite(kind: NeuriteKind) -> bool {
    [NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE].contains(&kind)
}

fn grow_on(line: &Line<'_>, density: f64, random: &mut Random, grown: &mut Grown) {
    let (least, end) = line.room();
    let mut next = least.max(random.unit() / density);
    while next < end {
        let Some(site) = line.at(next) else { return };
        let spine = Spine::new(site.radius, None, random);
        match Base::new(&site, spine, None, random, &mut grown.room) {
            Some(base) => grown.bases[site.node].push(base),
            None => grown.left += 1,
        }
        next += ((0.5 + random.unit()) / density).max(APART * site.radius);
    }
}
