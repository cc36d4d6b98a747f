//! Spines at given places, as those of synapses.
//!
//! Each place belongs to the neurite whose surface is nearest. Along a section, places are taken in their order, and
//! where two are too close for the surface, the farther one moves on by up to [`SLIDE`].

use std::collections::HashMap;

use glam::{DVec3, IVec3};

use super::base::Base;
use super::line::{APART, Line, Site};
use super::shape::Spine;
use super::{Grown, MOST, SPINE};
use crate::edit::EditError;
use crate::edit::nodes::Nodes;
use crate::random::Random;
use crate::{Attachment, Morphology, NeuriteKind, SectionId};

/// A place is at most so far (µm) from the membrane of its dendrite: longer than all spines that were measured.
pub const SPINE_REACH: f64 = 5.0;

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
    let pieces = Pieces::new(&lines);
    let somata = somata(morphology);
    let mut wanted: Vec<Wanted> = vec![Vec::new(); lines.len()];
    for &place in places {
        let found = pieces.nearest(place).filter(|found| {
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

/// Side of a cell of the grid (µm).
const CELL: f64 = 4.0;
/// Cells along a side of what is searched at most.
const MOST_SHELLS: i32 = 16;

/// Links of lines in a grid, each in all cells that its axis goes through.
struct Pieces {
    cells: HashMap<IVec3, Vec<u32>>,
    links: Vec<Link>,
    /// The largest radius (µm).
    widest: f64,
}

struct Link {
    section: usize,
    /// Distance (µm) of its first end from the start of the section.
    along: f64,
    ends: [(DVec3, f64); 2],
}

/// The place on a neurite that is nearest to another place.
#[derive(Clone, Copy)]
struct Found {
    section: usize,
    /// Distance (µm) from the start of the section.
    along: f64,
    /// Distance (µm) from the surface; below 0 inside.
    far: f64,
}

impl Pieces {
    fn new(lines: &[Line<'_>]) -> Self {
        let mut pieces = Self {
            cells: HashMap::new(),
            links: Vec::new(),
            widest: 0.0,
        };
        for (section, line) in lines.iter().enumerate() {
            for (along, ends) in line.links() {
                pieces.add(Link {
                    section,
                    along,
                    ends,
                });
            }
        }
        pieces
    }

    fn add(&mut self, link: Link) {
        let number = self.links.len() as u32;
        let [(from, thick), (to, thin)] = link.ends;
        self.widest = self.widest.max(thick).max(thin);
        let steps = (2.0 * from.distance(to) / CELL).ceil().clamp(1.0, 1e6) as u32;
        for step in 0..=steps {
            let at = from.lerp(to, f64::from(step) / f64::from(steps));
            let there = self.cells.entry(cell(at)).or_default();
            if there.last() != Some(&number) {
                there.push(number);
            }
        }
        self.links.push(link);
    }

    /// What is nearest to a place, if it is near at all. Cells are searched outwards.
    fn nearest(&self, place: DVec3) -> Option<Found> {
        if !place.is_finite() {
            return None;
        }
        let mut best: Option<Found> = None;
        for shell in 0..=MOST_SHELLS {
            // No link that is not found yet is nearer to the axis: half a cell for its samples.
            let rest = (f64::from(shell) - 1.5) * CELL - self.widest;
            if rest > best.map_or(SPINE_REACH, |found| found.far) {
                break;
            }
            for at in around(cell(place), shell) {
                let links = self.cells.get(&at).into_iter().flatten();
                for found in links.map(|&number| self.links[number as usize].found(place)) {
                    if best.is_none_or(|best| found.far < best.far) {
                        best = Some(found);
                    }
                }
            }
        }
        best
    }
}

impl Link {
    fn found(&self, place: DVec3) -> Found {
        let [(from, radius), (to, other)] = self.ends;
        let way = to - from;
        let length = way.length();
        let share = match length > 0.0 {
            true => ((place - from).dot(way) / (length * length)).clamp(0.0, 1.0),
            false => 0.0,
        };
        let axis = from.lerp(to, share);
        Found {
            section: self.section,
            along: self.along + share * length,
            far: axis.distance(place) - (radius + share * (other - radius)),
        }
    }
}

fn cell(place: DVec3) -> IVec3 {
    (place / CELL).floor().as_ivec3()
}

/// The cells that are so many cells from one.
fn around(center: IVec3, shell: i32) -> impl Iterator<Item = IVec3> {
    let range = move || -shell..=shell;
    let all = range().flat_map(move |x| range().map(move |y| (x, y)));
    all.flat_map(move |(x, y)| {
        let is_side = x.abs() == shell || y.abs() == shell;
        // Within the sides only the two that close them.
        let step = match is_side {
            true => 1,
            false => 2 * shell.max(1),
        };
        range()
            .step_by(step as usize)
            .map(move |z| center.wrapping_add(IVec3::new(x, y, z)))
    })
}
