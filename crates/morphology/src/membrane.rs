//! Places on the membrane, as the tracing has it: tubes around center lines, and spheres of somata.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use glam::DVec3;

use crate::nearest::{Link, Links};
use crate::{Attachment, Morphology, Point, SectionId, shape};

/// The membrane of a cell. Places are in the coordinates of its file (µm).
#[derive(Debug)]
pub struct Membrane<'m> {
    morphology: &'m Morphology,
    /// By point: its distance (µm) from the start of its section.
    ways: Vec<f64>,
    /// Made when it is first asked for.
    links: OnceLock<Links>,
}

/// A place within a cell, and the membrane around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembranePlace {
    /// On the center line, or the center of a soma (µm).
    pub center: DVec3,
    /// Unit vector along the center line; none in a soma.
    pub axis: Option<DVec3>,
    /// Distance (µm) of the membrane from the center.
    pub radius: f64,
}

impl<'m> Membrane<'m> {
    /// Takes time linear in the number of points.
    pub fn of(morphology: &'m Morphology) -> Self {
        let mut ways = vec![0.0; morphology.points.len()];
        for (index, section) in morphology.sections.iter().enumerate() {
            let range = section.range();
            let branch = shape::branch_point(morphology, SectionId(index as u32));
            let mut before = branch.map(|point| center(morphology, point));
            let mut way = 0.0;
            for (point, way_there) in morphology.points[range.clone()]
                .iter()
                .zip(&mut ways[range])
            {
                let here = center(morphology, point);
                way += before.map_or(0.0, |before| before.distance(here));
                (*way_there, before) = (way, Some(here));
            }
        }
        Self {
            morphology,
            ways,
            links: OnceLock::new(),
        }
    }

    /// The place at a share of a section's length, from 0 at its start to 1 at its end; none if there is no such
    /// section, or that is no number. Takes the logarithm of the section's points.
    pub fn on_section(&self, section: SectionId, share: f64) -> Option<MembranePlace> {
        let range = self.morphology.sections.get(section.index())?.range();
        let length = *self.ways[range].last()?;
        let share = Some(share).filter(|share| !share.is_nan())?;
        self.along(section, share.clamp(0.0, 1.0) * length)
    }

    /// The place at a distance (µm) from the start of a section.
    fn along(&self, section: SectionId, way: f64) -> Option<MembranePlace> {
        let range = self.morphology.sections[section.index()].range();
        let ways = &self.ways[range.clone()];
        let upper = ways
            .partition_point(|&there| there < way)
            .min(ways.len().checked_sub(1)?);
        let to = &self.morphology.points[range.start + upper];
        let (from, begin) = match upper.checked_sub(1) {
            Some(lower) => (&self.morphology.points[range.start + lower], ways[lower]),
            None => {
                let branch = shape::branch_point(self.morphology, section);
                (branch.unwrap_or(to), 0.0)
            }
        };
        let [a, b] = [from, to].map(|point| center(self.morphology, point));
        let step = ways[upper] - begin;
        let share = if step > 0.0 {
            (way - begin) / step
        } else {
            1.0
        };
        let [thick, thin] = [from, to].map(|point| f64::from(point.radius).max(0.0));
        Some(MembranePlace {
            center: a.lerp(b, share),
            axis: (b - a).try_normalize(),
            radius: thick + share * (thin - thick),
        })
    }

    /// The place in the main soma; none if there is no soma.
    pub fn in_soma(&self) -> Option<MembranePlace> {
        self.soma_place(0)
            .filter(|_| self.morphology.soma().is_some())
    }

    fn soma_place(&self, soma: usize) -> Option<MembranePlace> {
        let soma = self.morphology.somata.get(soma)?;
        Some(MembranePlace {
            center: self.morphology.origin + soma.center.as_dvec3(),
            axis: None,
            radius: f64::from(soma.radius).max(0.0),
        })
    }

    /// The place whose membrane is nearest to another place; none if that is farther than 5 µm from all.
    pub fn nearest(&self, place: DVec3) -> Option<MembranePlace> {
        let links = self.links.get_or_init(|| Links::new(self.all_links()));
        let found = links.nearest(place);
        let neurite = found.and_then(|found| {
            let there = self.along(SectionId(found.section as u32), found.along)?;
            Some((there, found.far))
        });
        let somata = (0..self.morphology.somata.len()).filter_map(|soma| {
            let there = self.soma_place(soma)?;
            Some((there, there.center.distance(place) - there.radius))
        });
        let all = neurite.into_iter().chain(somata);
        let near = all.filter(|(_, far)| *far <= crate::nearest::REACH);
        let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(place, _)| place)
    }

    fn all_links(&self) -> impl Iterator<Item = Link> + '_ {
        let sections = self.morphology.sections.iter().enumerate();
        sections.flat_map(move |(index, section)| {
            let ways = &self.ways[section.range()];
            let id = SectionId(index as u32);
            // Those with a branch point have a link before their first point.
            let has_branch = matches!(section.attachment, Attachment::Section(_));
            let begins = has_branch
                .then_some(0.0)
                .into_iter()
                .chain(ways.iter().copied());
            let links = shape::links(self.morphology, id).zip(begins);
            links.map(move |((from, to), along)| Link {
                section: index,
                along,
                ends: [from, to].map(|point| {
                    let radius = f64::from(point.radius).max(0.0);
                    (center(self.morphology, point), radius)
                }),
            })
        })
    }
}

fn center(morphology: &Morphology, point: &Point) -> DVec3 {
    morphology.origin + point.position.as_dvec3()
}

impl MembranePlace {
    /// The unit vector from the center across the center line to another place; none for a place on that line.
    pub fn towards(&self, place: DVec3) -> Option<DVec3> {
        let aside = place - self.center;
        let aside = match self.axis {
            Some(axis) => aside.reject_from_normalized(axis),
            None => aside,
        };
        // Less than a nanometer says nothing.
        (aside.length() > 1e-3).then(|| aside.normalize_or_zero())
    }

    /// A unit vector across the center line, or any in a soma, that a number tells: those of numbers in turn are
    /// spread evenly.
    pub fn outwards(&self, number: u64) -> DVec3 {
        // Of the plastic number: Roberts, The unreasonable effectiveness of quasirandom sequences, 2018.
        const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
        // Shares of a turn, exact for all numbers that files have.
        let share = |step: f64| ((number % (1 << 32)) as f64 * step).fract();
        let (sin, cos) = (TAU * share(STEPS[0])).sin_cos();
        match self.axis {
            Some(axis) => {
                let (side, across) = axis.any_orthonormal_pair();
                cos * side + sin * across
            }
            None => {
                let z = 2.0 * share(STEPS[1]) - 1.0;
                let around = (1.0 - z * z).max(0.0).sqrt();
                DVec3::new(around * cos, around * sin, z)
            }
        }
    }

    /// The place on the membrane in a direction from the center.
    pub fn at(&self, outwards: DVec3) -> DVec3 {
        self.center + self.radius * outwards
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NeuriteKind, Node};

    /// A soma of 5 µm, a dendrite of 2 µm upwards that forks, its second branch to the right.
    fn cell() -> Morphology {
        let node = |id, kind, at: [f64; 2], radius, parent| Node {
            id,
            kind,
            position: DVec3::new(at[0], at[1], 0.0),
            radius,
            parent,
            section: None,
        };
        let dendrite = NeuriteKind::BASAL_DENDRITE;
        let nodes = [
            node(1, NeuriteKind::SOMA, [0.0, 0.0], 5.0, None),
            node(2, dendrite, [0.0, 6.0], 2.0, Some(0)),
            node(3, dendrite, [0.0, 30.0], 2.0, Some(1)),
            node(4, dendrite, [-9.0, 60.0], 1.0, Some(2)),
            node(5, dendrite, [40.0, 30.0], 1.0, Some(2)),
        ];
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        built.expect("a cell").morphology
    }

    #[test]
    fn shares_of_sections_are_on_the_center_line() {
        let cell = cell();
        let membrane = Membrane::of(&cell);
        let on = |section, share| membrane.on_section(SectionId(section), share);
        let trunk = on(0, 0.25).expect("a place");
        assert_eq!(trunk.center, DVec3::new(0.0, 12.0, 0.0));
        assert_eq!((trunk.axis, trunk.radius), (Some(DVec3::Y), 2.0));
        // From the fork on, which belongs to the trunk.
        let branch = on(2, 0.5).expect("a place");
        assert_eq!(branch.center, DVec3::new(20.0, 30.0, 0.0));
        assert_eq!((branch.axis, branch.radius), (Some(DVec3::X), 1.5));
        let [start, end] = [-1.0, 2.0].map(|share| on(2, share).expect("a place").center.x);
        assert_eq!([start, end], [0.0, 40.0]);
        assert_eq!((on(0, f64::NAN), on(3, 0.5)), (None, None));
    }

    #[test]
    fn directions_are_across_the_center_line_and_all_around() {
        let cell = cell();
        let membrane = Membrane::of(&cell);
        let trunk = membrane.on_section(SectionId(0), 0.5).expect("a place");
        let soma = membrane.in_soma().expect("a soma");
        for place in [trunk, soma] {
            let ways: Vec<DVec3> = (0..1000).map(|n| place.outwards(n)).collect();
            assert!(ways.iter().all(|way| (way.length() - 1.0).abs() < 1e-9));
            let across = |way: &DVec3| place.axis.is_none_or(|axis| axis.dot(*way).abs() < 1e-9);
            assert!(ways.iter().all(across));
            let mean = ways.iter().sum::<DVec3>() / 1000.0;
            assert!(mean.length() < 0.01, "{mean}");
        }
        assert_eq!(trunk.at(DVec3::X).distance(trunk.center), 2.0);
    }

    #[test]
    fn the_nearest_membrane_is_found_on_neurites_and_somata() {
        let cell = cell();
        let membrane = Membrane::of(&cell);
        let near = |x, y, z| membrane.nearest(DVec3::new(x, y, z));
        let branch = near(20.0, 30.0, 3.0).expect("near");
        assert!(branch.center.distance(DVec3::new(20.0, 30.0, 0.0)) < 1e-9);
        assert!((branch.radius - 1.5).abs() < 1e-9);
        let beside = DVec3::new(20.0, 30.0, 3.0);
        assert_eq!(branch.towards(beside), Some(DVec3::Z));
        assert_eq!(branch.towards(branch.center), None);
        let soma = near(-6.0, 0.0, 0.0).expect("near");
        assert_eq!((soma.axis, soma.radius), (None, 5.0));
        assert_eq!(near(20.0, 50.0, 0.0), None);
    }
}
