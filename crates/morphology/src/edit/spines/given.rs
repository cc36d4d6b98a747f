//! Spines at given places, as those of synapses.
//!
//! Each place belongs to the neurite whose surface is nearest. Along a section, places are taken in their order, and
//! where two are too close for the surface, the farther one moves on by up to [`SLIDE`].

use glam::DVec3;

use super::base::Base;
use super::line::{APART, Line, Site};
use super::shape::Spine;
use super::{Grown, MOST, SPINE};
use crate::edit::EditError;
use crate::edit::nodes::Nodes;
use crate::nearest::{Link, Links, REACH};
use crate::random::Random;
use crate::{Attachment, Morphology, NeuriteKind, SectionId};

/// A place is at most so far (µm) from the membrane of its dendrite: longer than all spines that were measured.
pub const SPINE_REACH: f64 = REACH;

/// A base moves along its dendrite at most so far (µm), if there is no room where it should be.
const SLIDE: f64 = 2.0;
/// A place that is nearer to the axis than this share of the radius says nothing of the direction.
const ON_AXIS: f64 = 0.5;

/// Distances (µm) from the start of a section, each with the place that it is for.
type Wanted = Vec<(f64, Option<DVec3>)>;

/// Grows a spine for each place (µm, the file's coordinates).
pub(super) fn grow_at(
    morphology: &Morphology,
    nodes: &Nodes,
    places: &[DVec3],
    seed: u64,
    grown: &mut Grown,
) -> Result<(), EditError> {
    let lines = lines(morphology, nodes, places.len())?;
    let links = links_of(&lines);
    let somata = somata(morphology);
    let mut wanted: Vec<Wanted> = vec![Vec::new(); lines.len()];
    for &place in places {
        let found = links.nearest(place).filter(|found| {
            let on_soma = distance_to_soma(morphology, somata[found.section], place);
            let carries = carries(morphology.sections[found.section].kind);
            carries && found.far <= on_soma.min(SPINE_REACH)
        });
        match found {
            Some(found) => wanted[found.section].push((found.along, Some(place))),
            None => grown.left += 1,
        }
    }
    grow_on_all(&lines, wanted, seed, grown);
    Ok(())
}

/// Grows a spine for each share of a section's length.
pub(super) fn grow_along(
    morphology: &Morphology,
    nodes: &Nodes,
    shares: &[(SectionId, f64)],
    seed: u64,
    grown: &mut Grown,
) -> Result<(), EditError> {
    let lines = lines(morphology, nodes, shares.len())?;
    let mut wanted: Vec<Wanted> = vec![Vec::new(); lines.len()];
    for &(section, share) in shares {
        let there = morphology.sections.get(section.index());
        match there {
            Some(there) if carries(there.kind) && (0.0..=1.0).contains(&share) => {
                let along = share * lines[section.index()].length();
                wanted[section.index()].push((along, None));
            }
            _ => grown.left += 1,
        }
    }
    grow_on_all(&lines, wanted, seed, grown);
    Ok(())
}

fn lines<'n>(
    morphology: &Morphology,
    nodes: &'n Nodes,
    places: usize,
) -> Result<Vec<Line<'n>>, EditError> {
    if places as f64 > MOST {
        return Err(EditError::TooManyPlaces { places });
    }
    let ids = (0..morphology.sections.len() as u32).map(SectionId);
    Ok(ids.map(|id| Line::new(morphology, nodes, id)).collect())
}

fn links_of(lines: &[Line<'_>]) -> Links {
    let all = lines.iter().enumerate().flat_map(|(section, line)| {
        let link = move |(along, ends)| Link {
            section,
            along,
            ends,
        };
        line.links().map(link)
    });
    Links::new(all)
}

fn grow_on_all(lines: &[Line<'_>], wanted: Vec<Wanted>, seed: u64, grown: &mut Grown) {
    for ((line, mut wanted), stream) in lines.iter().zip(wanted).zip(0..) {
        wanted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut random = Random::new(seed, stream);
        grow_on(line, &wanted, &mut random, grown);
    }
}

/// Whether spines are grown on what is of this type where a place is given.
fn carries(kind: NeuriteKind) -> bool {
    ![NeuriteKind::SOMA, NeuriteKind::AXON, SPINE].contains(&kind)
}

/// By section: the soma that it hangs on.
fn somata(morphology: &Morphology) -> Vec<Option<u32>> {
    let mut somata: Vec<Option<u32>> = Vec::with_capacity(morphology.sections.len());
    for section in &morphology.sections {
        somata.push(match section.attachment {
            Attachment::Soma { soma, .. } => Some(soma),
            Attachment::Section(parent) => somata[parent.index()],
            Attachment::Free => None,
        });
    }
    somata
}

/// Distance (µm) from the surface of a soma.
fn distance_to_soma(morphology: &Morphology, soma: Option<u32>, place: DVec3) -> f64 {
    let Some(soma) = soma else {
        return f64::INFINITY;
    };
    let soma = &morphology.somata[soma as usize];
    let center = morphology.origin + soma.center.as_dvec3();
    center.distance(place) - f64::from(soma.radius)
}

/// Grows spines along a section. `wanted`: sorted.
fn grow_on(
    line: &Line<'_>,
    wanted: &[(f64, Option<DVec3>)],
    random: &mut Random,
    grown: &mut Grown,
) {
    let (mut least, end) = line.room();
    for &(wanted, place) in wanted {
        let along = wanted.min(end).max(least);
        let there = along <= end && (along - wanted).abs() <= SLIDE;
        let Some(site) = line.at(along).filter(|_| there) else {
            grown.left += 1;
            continue;
        };
        let (towards, tip) = place.map_or((None, None), |place| aim(&site, place));
        let spine = Spine::new(site.radius, tip, random);
        match Base::new(&site, spine, towards, random, &mut grown.room) {
            Some(base) => {
                grown.bases[site.node].push(base);
                least = along + APART * site.radius;
            }
            None => grown.left += 1,
        }
    }
}

/// The direction (across the axis) that a place gives a spine, and how far (µm) from the axis it ends, if the place
/// says so.
fn aim(site: &Site, place: DVec3) -> (Option<DVec3>, Option<f64>) {
    let aside = (place - site.center).reject_from_normalized(site.axis);
    let far = aside.length();
    match far > ON_AXIS * site.radius && far.is_finite() {
        true => (aside.try_normalize(), Some(far)),
        false => (None, None),
    }
}
