//! Measuring: the tool that is on while places are clicked, what dimensions measure, and how that
//! is said. Lengths are µm in the world, so a neuron's scale counts.

use std::f64::consts::PI;

use glam::DVec3;
use neurotess::morphology::paths::{Location, Path};
use neurotess::morphology::{Morphology, SectionId, shape};
use neurotess::render::Placement;

use crate::model::document::{Anchor, Dimension};
use crate::model::numbers::measured;

/// The tool, while it is on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measuring {
    /// The first end of a distance, once it is clicked.
    pub first: Option<Anchor>,
    /// What is under the cursor.
    pub under: Option<Pointed>,
}

/// What the cursor is at while the tool is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointed {
    /// The location on the tracing.
    pub at: Anchor,
    /// The fork near it.
    pub fork: Option<Anchor>,
}

/// What a dimension measures.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// Of two locations.
    Distance {
        /// Their distance.
        straight: f64,
        /// The path between them, if both are on the same neuron and connected.
        path: Option<PathFigures>,
    },
    /// The diameter.
    Diameter(f64),
    /// The angles (radians) between each two branches of a fork.
    Angle {
        /// To the first points of the branches.
        local: Vec<f64>,
        /// To their ends.
        remote: Vec<f64>,
    },
}

/// Figures of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathFigures {
    /// Its length.
    pub length: f64,
    /// Of that, what is between the soma's center and the first points of neurites.
    pub soma_length: f64,
    /// Its length by the distance of its ends.
    pub tortuosity: Option<f64>,
    /// Number of forks that it passes.
    pub forks: usize,
}

/// A dimension as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its place in the world.
    pub shape: FigureShape,
    /// Its label, in lines.
    pub label: Vec<String>,
    /// What it measures.
    pub measured: Measured,
}

/// Lines of a dimension in the world.
#[derive(Clone, Debug, PartialEq)]
pub enum FigureShape {
    /// A straight line, and the path if there is one.
    Distance {
        /// Ends of the line.
        ends: [DVec3; 2],
        /// Corners of the path.
        path: Vec<DVec3>,
    },
    /// A line across a neurite.
    Diameter {
        /// Its middle.
        center: DVec3,
        /// Direction of the neurite; zero at a soma.
        along: DVec3,
        /// Half of its length.
        radius: f64,
    },
    /// Arcs between branches.
    Angle {
        /// The fork.
        center: DVec3,
        /// Unit directions of the branches.
        branches: Vec<DVec3>,
        /// The radius of the fork.
        radius: f64,
    },
}

/// A neuron with its tracing and placements: as it was traced, and as it is drawn, perhaps side by
/// side with others.
pub(crate) struct Placed<'a> {
    pub(crate) morphology: &'a Morphology,
    pub(crate) traced: Placement,
    pub(crate) drawn: Placement,
}

impl Placed<'_> {
    fn drawn_at(&self, location: Location) -> DVec3 {
        self.drawn
            .world_from_cell(location.position(self.morphology))
    }

    fn traced_at(&self, location: Location) -> DVec3 {
        self.traced
            .world_from_cell(location.position(self.morphology))
    }
}

/// What a dimension measures and how it is drawn; none if its neuron is gone, or if the tracing is
/// another one there. `placed` returns the neuron of an anchor that is on its tracing.
pub(crate) fn figure<'a>(
    dimension: &Dimension,
    placed: impl Fn(Anchor) -> Option<Placed<'a>>,
) -> Option<Figure> {
    match *dimension {
        Dimension::Distance { from, to } => {
            let same = from.neuron == to.neuron;
            let ends = [from.location, to.location];
            Some(distance([placed(from)?, placed(to)?], ends, same))
        }
        Dimension::Diameter { at } => Some(diameter(&placed(at)?, at.location)),
        Dimension::Angle { at } => angle(&placed(at)?, at.location),
    }
}

fn distance([a, b]: [Placed<'_>; 2], [from, to]: [Location; 2], same: bool) -> Figure {
    let straight = a.traced_at(from).distance(b.traced_at(to));
    let path = if same {
        Path::between(a.morphology, from, to)
    } else {
        None
    };
    let scale = a.traced.scale;
    let figures = path.as_ref().map(|path| PathFigures {
        length: path.length * scale,
        soma_length: path.soma_length * scale,
        tortuosity: path.tortuosity(),
        forks: path.forks.len(),
    });
    let corners = path.iter().flat_map(|path| path.positions(a.morphology));
    let shape = FigureShape::Distance {
        ends: [a.drawn_at(from), b.drawn_at(to)],
        path: corners.map(|p| a.drawn.world_from_cell(p)).collect(),
    };
    let measured = Measured::Distance {
        straight,
        path: figures,
    };
    labeled(shape, measured)
}

fn diameter(placed: &Placed<'_>, location: Location) -> Figure {
    let morphology = placed.morphology;
    let radius = location.radius(morphology);
    let along = match location {
        Location::Soma(_) => DVec3::ZERO,
        Location::Neurite { point, .. } => direction(morphology, point),
    };
    let shape = FigureShape::Diameter {
        center: placed.drawn_at(location),
        along: placed.drawn.rotation * along,
        radius: radius * placed.drawn.scale,
    };
    labeled(
        shape,
        Measured::Diameter(2.0 * radius * placed.traced.scale),
    )
}

/// Direction of the link that leads to a point; of the link after it if there is none.
fn direction(morphology: &Morphology, point: u32) -> DVec3 {
    let at = |fraction| Location::Neurite { point, fraction }.position(morphology);
    let link = (at(1.0) - at(0.0)).try_normalize();
    link.or_else(|| {
        let next = Location::of_point(point + 1);
        let section = Location::of_point(point).section(morphology);
        let within = next.is_on(morphology) && next.section(morphology) == section;
        within
            .then(|| next.position(morphology) - at(1.0))?
            .try_normalize()
    })
    .unwrap_or(DVec3::ZERO)
}

fn angle(placed: &Placed<'_>, location: Location) -> Option<Figure> {
    let morphology = placed.morphology;
    let children = shape::children(morphology, location.section(morphology)?);
    let angles = |reach: f64| -> Vec<f64> {
        let firsts = children.iter().enumerate();
        let pairs = firsts.flat_map(|(i, &a)| children[i + 1..].iter().map(move |&b| [a, b]));
        pairs
            .filter_map(|pair| shape::angle_between(morphology, pair, reach))
            .collect()
    };
    let branches = children
        .iter()
        .filter_map(|&id| shape::leaving(morphology, id, shape::LOCAL))
        .map(|direction| placed.drawn.rotation * direction);
    let branches: Vec<DVec3> = branches.collect();
    let local = angles(shape::LOCAL);
    if local.is_empty() {
        return None;
    }
    let shape = FigureShape::Angle {
        center: placed.drawn_at(location),
        branches,
        radius: location.radius(morphology) * placed.drawn.scale,
    };
    let remote = angles(shape::REMOTE);
    Some(labeled(shape, Measured::Angle { local, remote }))
}

fn labeled(shape: FigureShape, measured: Measured) -> Figure {
    Figure {
        shape,
        label: measured.label(),
        measured,
    }
}

/// The fork that is nearest to a location along its section, not farther than `reach` µm.
pub(crate) fn fork_near(
    morphology: &Morphology,
    location: Location,
    reach: f64,
) -> Option<Location> {
    let section = location.section(morphology)?;
    let end_of = |id: SectionId| Location::of_point(morphology.sections[id.index()].end - 1);
    let forks = std::iter::once(section).chain(morphology.sections[section.index()].parent());
    let near = forks.filter_map(|id| {
        let fork = end_of(id);
        // A branch begins at the membrane of its trunk.
        let reach = reach.max(1.5 * fork.radius(morphology));
        let away = Path::between(morphology, location, fork)?.length;
        let forked = away <= reach && shape::children(morphology, id).len() > 1;
        forked.then_some((away, fork))
    });
    let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, fork)| fork)
}

impl Measured {
    /// Lines of its label.
    fn label(&self) -> Vec<String> {
        match self {
            Self::Distance { straight, path } => {
                let path = path.map(|path| format!("path {}", measured(path.length, "µm")));
                std::iter::once(measured(*straight, "µm"))
                    .chain(path)
                    .collect()
            }
            Self::Diameter(diameter) => vec![format!("Ø {}", measured(*diameter, "µm"))],
            Self::Angle { local, remote } => {
                vec![degrees(local), format!("remote {}", degrees(remote))]
            }
        }
    }

    /// Its numbers: µm and degrees.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Distance { straight, path } => {
                let path = path
                    .iter()
                    .flat_map(|path| std::iter::once(path.length).chain(path.tortuosity));
                std::iter::once(*straight).chain(path).collect()
            }
            Self::Diameter(diameter) => vec![*diameter],
            Self::Angle { local, remote } => {
                local.iter().chain(remote).map(|a| a * 180.0 / PI).collect()
            }
        }
    }
}

/// Angles in degrees.
pub(crate) fn degrees(angles: &[f64]) -> String {
    let angles = angles.iter().map(|a| format!("{:.1}°", a * 180.0 / PI));
    angles.collect::<Vec<_>>().join(", ")
}
