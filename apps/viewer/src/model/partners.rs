//! The paths from a synapse to the somata of its two cells.

use glam::DVec3;
use neurotess::morphology::paths::{Location, Path};
use neurotess::morphology::{Attachment, Morphology, NeuriteKind, Point, SectionId, shape};
use neurotess::render::Placement;

/// What a cell is to a synapse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It sends: the path goes along its axon.
    Presynaptic,
    /// It receives: the path goes along a dendrite.
    Postsynaptic,
}

/// The path from a synapse to the soma of one of its cells, or to where its tree begins if it has none.
#[derive(Clone, Debug, PartialEq)]
pub struct PartnerPath {
    /// Index of the neuron.
    pub neuron: usize,
    /// What it is to the synapse.
    pub role: Role,
    /// Corners (µm) in the world, where the neuron is drawn; the first is nearest to the synapse.
    pub corners: Vec<DVec3>,
    /// Its length (µm).
    pub length: f64,
    /// Distance (µm) of the synapse from the membrane there; 0 on it and inside.
    pub gap: f64,
}

/// A cell with its placements: in its circuit, and as it is drawn.
pub(crate) struct PartnerCell<'a> {
    pub(crate) neuron: usize,
    pub(crate) role: Role,
    pub(crate) morphology: &'a Morphology,
    pub(crate) traced: Placement,
    pub(crate) drawn: Placement,
}

impl PartnerCell<'_> {
    /// The path from a synapse at this place (µm, the circuit's coordinates); none if nothing of the cell was traced.
    pub(crate) fn path(&self, synapse: DVec3) -> Option<PartnerPath> {
        let morphology = self.morphology;
        let back = self.traced.rotation.inverse();
        let place = back * (synapse - self.traced.translation) / self.traced.scale;
        let (from, gap) = nearest(morphology, place, self.role)?;
        let path = Path::between(morphology, from, begin(morphology, from))?;
        let corners = path.positions(morphology).into_iter();
        Some(PartnerPath {
            neuron: self.neuron,
            role: self.role,
            corners: corners.map(|c| self.drawn.world_from_cell(c)).collect(),
            length: path.length * self.traced.scale,
            gap: gap.max(0.0) * self.traced.scale,
        })
    }
}

/// Where a path ends: the soma that the tree hangs on, or the tree's first point.
fn begin(morphology: &Morphology, location: Location) -> Location {
    let Some(mut section) = location.section(morphology) else {
        return location;
    };
    loop {
        let here = &morphology.sections[section.index()];
        match here.attachment {
            Attachment::Section(parent) => section = parent,
            Attachment::Soma { soma, .. } => return Location::Soma(soma),
            Attachment::Free => return Location::of_point(here.first),
        }
    }
}

/// The location whose membrane is nearest to a place (µm, the cell's coordinates), and its distance: on axons for what
/// sends, on all else for what receives, on anything if there is no such neurite.
fn nearest(morphology: &Morphology, place: DVec3, role: Role) -> Option<(Location, f64)> {
    let suits = |kind: NeuriteKind| match role {
        Role::Presynaptic => kind == NeuriteKind::AXON,
        Role::Postsynaptic => kind != NeuriteKind::AXON,
    };
    let neurite = nearest_on(morphology, place, suits);
    let somata = (0..morphology.somata.len() as u32).map(Location::Soma);
    let somata = somata.filter(|_| role == Role::Postsynaptic).map(|soma| {
        (
            soma,
            soma.position(morphology).distance(place) - soma.radius(morphology),
        )
    });
    let found = neurite.into_iter().chain(somata);
    found
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .or_else(|| nearest_on(morphology, place, |_| true))
}

fn nearest_on(
    morphology: &Morphology,
    place: DVec3,
    suits: impl Fn(NeuriteKind) -> bool,
) -> Option<(Location, f64)> {
    let sections = morphology.sections.iter().enumerate();
    let sections = sections.filter(|(_, section)| suits(section.kind));
    let points = sections.flat_map(|(index, section)| {
        let before = shape::branch_point(morphology, SectionId(index as u32));
        let own = section.range();
        own.clone().map(move |point| match point == own.start {
            true => (point, before.copied()),
            false => (point, Some(morphology.points[point - 1])),
        })
    });
    let at = |point: &Point| morphology.origin + point.position.as_dvec3();
    let candidate = |(point, before): (usize, Option<Point>)| {
        let to = &morphology.points[point];
        let from = before.as_ref().unwrap_or(to);
        let link = at(to) - at(from);
        let fraction = match link.length_squared() {
            square if square > 0.0 => ((place - at(from)).dot(link) / square).clamp(0.0, 1.0),
            _ => 1.0,
        };
        let [thick, thin] = [from, to].map(|p| f64::from(p.radius).max(0.0));
        let radius = thick + fraction * (thin - thick);
        let away = (at(from) + fraction * link).distance(place) - radius;
        let point = point as u32;
        (Location::Neurite { point, fraction }, away)
    };
    points.map(candidate).min_by(|a, b| a.1.total_cmp(&b.1))
}

#[cfg(test)]
mod tests {
    use neurotess::formats::{ReadOptions, swc};

    use super::*;

    /// A soma, a dendrite upwards that forks, an axon downwards.
    fn cell() -> Morphology {
        let text =
            b"1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 30 0 1 2\n4 3 20 30 0 .5 3\n5 3 -20 30 0 .5 3\n\
                     6 2 0 -6 0 1 1\n7 2 0 -60 0 .5 6\n";
        let read = swc::read_bytes(text, "cell", &ReadOptions::default());
        read.expect("a cell").morphology
    }

    fn path(role: Role, at: [f64; 3], drawn: Placement) -> PartnerPath {
        let morphology = cell();
        let of = PartnerCell {
            neuron: 3,
            role,
            morphology: &morphology,
            traced: Placement::default(),
            drawn,
        };
        of.path(DVec3::from(at)).expect("a path")
    }

    #[test]
    fn paths_go_along_dendrite_and_axon_to_the_soma() {
        let here = Placement::default();
        let post = path(Role::Postsynaptic, [10.0, 31.75, 0.0], here);
        assert_eq!((post.neuron, post.length), (3, 10.0 + 30.0));
        assert!((post.gap - 1.0).abs() < 1e-6, "{}", post.gap);
        let corners: Vec<[f64; 3]> = post.corners.iter().map(DVec3::to_array).collect();
        let expected = [
            [10.0, 30.0, 0.0],
            [0.0, 30.0, 0.0],
            [0.0, 6.0, 0.0],
            [0.0; 3],
        ];
        assert_eq!(corners, expected);
        // The axon, although dendrites are nearer.
        let pre = path(Role::Presynaptic, [10.0, -20.0, 0.0], here);
        assert_eq!((pre.length, pre.corners.len()), (20.0, 3));
        assert!((pre.gap - 9.1).abs() < 0.1, "{}", pre.gap);
        // On the soma there is no way to go.
        let on_soma = path(Role::Postsynaptic, [5.0, 0.0, 0.0], here);
        assert_eq!((on_soma.length, on_soma.gap), (0.0, 0.0));
    }

    #[test]
    fn paths_are_where_the_cell_is_drawn() {
        let drawn = Placement {
            translation: DVec3::X * 100.0,
            ..Placement::default()
        };
        let post = path(Role::Postsynaptic, [0.0, 20.0, 0.0], drawn);
        assert_eq!(post.corners[0].to_array(), [100.0, 20.0, 0.0]);
        assert_eq!(post.gap, 0.0);
    }
}
