//! `--between A B`: what lies between two samples of a tracing.

use neurotess::morphology::paths::{Location, Path};
use neurotess::morphology::{Morphology, SectionId, shape};
use serde::{Serialize, Serializer};

use crate::report::Failure;

/// An end, as it is given: a sample's number in the file, or the soma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Soma,
    Sample(i64),
}

impl std::str::FromStr for End {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "soma" => Ok(Self::Soma),
            number => number
                .parse()
                .map(Self::Sample)
                .map_err(|_| "the number of a sample in the file, or soma, is needed".into()),
        }
    }
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Soma => f.write_str("the soma"),
            Self::Sample(id) => write!(f, "sample {id}"),
        }
    }
}

impl Serialize for End {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Soma => serializer.serialize_str("soma"),
            Self::Sample(id) => serializer.serialize_i64(*id),
        }
    }
}

/// What is measured between two ends: µm, and angles in radians.
#[derive(Serialize)]
pub(super) struct Between {
    from: Place,
    to: Place,
    distance: f64,
    /// None if they are not connected.
    path: Option<PathFigures>,
}

#[derive(Serialize)]
struct Place {
    sample: End,
    /// None of a soma.
    section: Option<u32>,
    position: [f64; 3],
    radius: f64,
    diameter: f64,
    /// Along the neurite, from its first sample; none without a soma.
    path_from_soma: Option<f64>,
}

#[derive(Serialize)]
struct PathFigures {
    length: f64,
    /// Of that, between the soma's center and the first samples of neurites.
    in_soma: f64,
    tortuosity: Option<f64>,
    forks: Vec<Fork>,
}

#[derive(Serialize)]
struct Fork {
    sample: i64,
    section: u32,
    /// None where there are more than two branches.
    local_angle: Option<f64>,
    remote_angle: Option<f64>,
}

/// Measures between pairs of ends.
pub(super) fn between(
    file: &str,
    morphology: &Morphology,
    ends: &[End],
) -> Result<Vec<Between>, Failure> {
    let located = |end: &End| {
        let location = match *end {
            End::Soma => (!morphology.somata.is_empty()).then_some(Location::Soma(0)),
            End::Sample(id) => Location::of_sample(morphology, id),
        };
        let hint = "give a number of the file's first column, or soma";
        let missing = || Failure(format!("{file}: {end} is not there (--between): {hint}"));
        location.ok_or_else(missing)
    };
    let pairs = ends.chunks_exact(2);
    pairs
        .map(|pair| {
            let [a, b] = [located(&pair[0])?, located(&pair[1])?];
            let distance = a.position(morphology).distance(b.position(morphology));
            Ok(Between {
                from: place(morphology, pair[0], a),
                to: place(morphology, pair[1], b),
                distance,
                path: Path::between(morphology, a, b).map(|path| figures(morphology, &path)),
            })
        })
        .collect()
}

fn place(morphology: &Morphology, sample: End, location: Location) -> Place {
    let radius = location.radius(morphology);
    let soma = morphology.soma().map(|_| Location::Soma(0));
    let from_soma = soma.and_then(|soma| Path::between(morphology, soma, location));
    Place {
        sample,
        section: location.section(morphology).map(|id| id.0),
        position: location.position(morphology).to_array(),
        radius,
        diameter: 2.0 * radius,
        path_from_soma: from_soma.map(|path| path.length - path.soma_length),
    }
}

fn figures(morphology: &Morphology, path: &Path) -> PathFigures {
    let fork = |&id: &SectionId| {
        let children = shape::children(morphology, id);
        let pair = <[SectionId; 2]>::try_from(children).ok();
        let angle = |reach| shape::angle_between(morphology, pair?, reach);
        Fork {
            sample: morphology.sample_ids[morphology.sections[id.index()].end as usize - 1],
            section: id.0,
            local_angle: angle(shape::LOCAL),
            remote_angle: angle(shape::REMOTE),
        }
    };
    PathFigures {
        length: path.length,
        in_soma: path.soma_length,
        tortuosity: path.tortuosity(),
        forks: path.forks.iter().map(fork).collect(),
    }
}

impl Between {
    /// Lines for people.
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = vec![format!("{} and {}", self.from.sample, self.to.sample)];
        let mut far = format!("distance {:.2} µm", self.distance);
        match &self.path {
            None => far.push_str(", no path: they are not connected"),
            Some(path) => {
                far.push_str(&format!(", path {:.2} µm", path.length));
                if path.in_soma > 0.0 {
                    far.push_str(&format!(" ({:.2} µm of it in the soma)", path.in_soma));
                }
                if let Some(tortuosity) = path.tortuosity {
                    far.push_str(&format!(", tortuosity {tortuosity:.3}"));
                }
            }
        }
        lines.push(far);
        let forks = self.path.iter().flat_map(|path| &path.forks);
        let forks: Vec<String> = forks.map(Fork::text).collect();
        if self.path.is_some() {
            lines.push(match forks.len() {
                0 => "no forks between them".into(),
                n => format!("forks between them: {n}, at {}", forks.join(", ")),
            });
        }
        for place in [&self.from, &self.to] {
            let mut text = format!("{}: diameter {:.2} µm", place.sample, place.diameter);
            if let Some(path) = place.path_from_soma.filter(|_| place.section.is_some()) {
                text.push_str(&format!(", {path:.2} µm along the neurite from the soma"));
            }
            lines.push(text);
        }
        lines
    }
}

impl Fork {
    fn text(&self) -> String {
        let degrees = |angle: f64| format!("{:.1}°", angle.to_degrees());
        match (self.local_angle, self.remote_angle) {
            (Some(local), Some(remote)) => {
                let (local, remote) = (degrees(local), degrees(remote));
                format!("sample {} ({local}, to the ends {remote})", self.sample)
            }
            _ => format!("sample {}", self.sample),
        }
    }
}
