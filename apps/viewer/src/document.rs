//! What can be undone and is saved: the cells that are shown and how.

use glam::{DQuat, DVec3};
use neurotess::colouring;
use neurotess::generate::{GenerateOptions, SomaMethod, SphereKind};
use neurotess::render::{Choice, ColourMap, Light, Palette, Placement, Rgb};
use serde::{Deserialize, Serialize};

use crate::session::NeuronEntry;

/// Place of a tracing in [`Sources`](crate::sources::Sources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SourceId(pub u32);

/// All that an edit changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// What is shown, in the order of the list.
    pub neurons: Vec<Neuron>,
    /// Somata that are not as usual, by source.
    pub somata: Vec<(SourceId, SomaEdit)>,
    /// Colours, light, what is shown of cells.
    pub look: Look,
    /// How finely.
    pub detail: Detail,
    /// Side by side instead of where they were traced.
    pub grid: bool,
}

/// A tracing somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Neuron {
    /// Its shape.
    pub source: SourceId,
    /// Name in the list.
    pub name: String,
    /// Where it was traced, or where its circuit puts it.
    pub placement: Placement,
    /// Not drawn.
    pub hidden: bool,
    /// Selected.
    pub selected: bool,
}

impl Neuron {
    /// A tracing where its own coordinates put it.
    pub fn new(source: SourceId, name: String) -> Self {
        Self {
            source,
            name,
            placement: Placement::default(),
            hidden: false,
            selected: false,
        }
    }

    /// As a session has it.
    pub(crate) fn of_session(source: SourceId, entry: &NeuronEntry) -> Self {
        Self {
            placement: entry.place.map(Into::into).unwrap_or_default(),
            hidden: entry.hidden,
            selected: entry.selected && !entry.hidden,
            ..Self::new(source, entry.name.clone())
        }
    }
}

/// How a soma is made.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SomaEdit {
    /// The method.
    pub method: Method,
    /// Poisson's ratio, 0 to 0.49.
    pub poisson: f64,
    /// Factor on the radius.
    pub scale: f64,
    /// The paper's octahedron instead of a cube.
    pub octahedron: bool,
    /// Resolution of the reference sphere; 0: what fits.
    pub level: u32,
}

/// How a soma is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// A sphere deformed by elasticity.
    #[default]
    Elastic,
    /// A sphere.
    Sphere,
    /// LiveMesh's radius function.
    Profile,
    /// None.
    None,
}

impl Default for SomaEdit {
    fn default() -> Self {
        Self {
            method: Method::Elastic,
            poisson: 0.3,
            scale: 1.0,
            octahedron: false,
            level: 0,
        }
    }
}

impl SomaEdit {
    /// What the generator is told.
    pub fn options(&self) -> GenerateOptions {
        GenerateOptions {
            soma: match self.method {
                Method::Elastic => SomaMethod::Fem,
                Method::Sphere => SomaMethod::Sphere,
                Method::Profile => SomaMethod::Profile,
                Method::None => SomaMethod::None,
            },
            poisson: self.poisson.clamp(0.0, 0.49),
            soma_scale: self.scale.clamp(0.05, 20.0),
            sphere: match self.octahedron {
                true => SphereKind::Octahedron,
                false => SphereKind::Cube,
            },
            sphere_level: (self.level > 0).then(|| {
                let (low, high) = self.levels();
                self.level.clamp(low, high)
            }),
            kinds: None,
        }
    }

    /// Least and greatest resolution of the sphere.
    pub fn levels(&self) -> (u32, u32) {
        if self.octahedron { (1, 5) } else { (2, 32) }
    }
}

/// Colours, light, what is shown of cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Look {
    /// What colours tell.
    pub colour_by: ColourBy,
    /// Colours of types.
    #[serde(with = "palette")]
    pub palette: Palette,
    /// Colours of numbers.
    #[serde(with = "colour_map")]
    pub colour_map: ColourMap,
    /// Behind everything.
    pub background: Rgb,
    /// What surfaces are lit by.
    pub light: Lighting,
    /// Whether corners darken one another.
    pub occlusion: bool,
    /// Triangles.
    pub wires: bool,
    /// What colours mean.
    pub legend: bool,
    /// A length to compare with.
    pub scale_bar: bool,
    /// Directions of x, y and z.
    pub axes: bool,
    /// A colour of its own for what is selected.
    pub mark_selected: bool,
    /// Whether one looks through what is not selected.
    pub faint_others: bool,
    /// Share of what is not selected that is still seen.
    pub faint: f32,
    /// What is drawn of cells.
    pub parts: Parts,
    /// What is cut away.
    pub cut: Option<Cut>,
}

/// What colours tell; see [`colouring::ColourBy`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum ColourBy {
    #[default]
    Type,
    Neuron,
    Neurite,
    Section,
    Order,
    Radius,
    Depth,
}

impl ColourBy {
    /// All, with names for people.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::Type, "type"),
        (Self::Neuron, "neuron"),
        (Self::Neurite, "neurite"),
        (Self::Section, "section"),
        (Self::Order, "branch order"),
        (Self::Radius, "radius"),
        (Self::Depth, "path distance"),
    ];

    /// Whether it is a number, with a colour map.
    pub fn is_number(self) -> bool {
        matches!(self, Self::Order | Self::Radius | Self::Depth)
    }

    pub(crate) fn in_library(self) -> colouring::ColourBy {
        match self {
            Self::Type => colouring::ColourBy::Type,
            Self::Neuron => colouring::ColourBy::Neuron,
            Self::Neurite => colouring::ColourBy::Neurite,
            Self::Section => colouring::ColourBy::Section,
            Self::Order => colouring::ColourBy::Order,
            Self::Radius => colouring::ColourBy::Radius,
            Self::Depth => colouring::ColourBy::Depth,
        }
    }
}

/// What surfaces are lit by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lighting {
    /// From the upper left.
    #[default]
    Soft,
    /// Not at all.
    Flat,
    /// From a direction (degrees): to the right, and upwards.
    From {
        /// From −180 to 180; 0 is from the viewer.
        right: f32,
        /// From −90 to 90.
        up: f32,
    },
}

impl Lighting {
    pub(crate) fn light(self) -> Light {
        match self {
            Self::Soft => Light::Soft,
            Self::Flat => Light::Flat,
            Self::From { right, up } => {
                let (right, up) = (right.to_radians(), up.to_radians());
                Light::From(glam::Vec3::new(
                    right.sin() * up.cos(),
                    up.sin(),
                    right.cos() * up.cos(),
                ))
            }
        }
    }
}

/// What is drawn of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Parts {
    /// All.
    #[default]
    All,
    /// Somata.
    Soma,
    /// Neurites.
    Neurites,
}

/// A plane across the scene: what lies behind it is cut away.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// 0: x, 1: y, 2: z.
    pub axis: usize,
    /// Where, from 0 to 1 through the scene.
    pub place: f32,
    /// The other side is cut away.
    pub flipped: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            colour_by: ColourBy::Type,
            palette: Palette::default(),
            colour_map: ColourMap::default(),
            background: [255; 3],
            light: Lighting::Soft,
            occlusion: true,
            wires: false,
            legend: true,
            scale_bar: true,
            axes: true,
            mark_selected: false,
            faint_others: false,
            faint: 0.25,
            parts: Parts::All,
            cut: None,
        }
    }
}

/// How finely surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Detail {
    /// By what.
    pub criterion: Criterion,
    /// Error (pixels).
    pub error: f32,
    /// Length of an edge's piece (pixels).
    pub size: f32,
    /// Level.
    pub level: u32,
    /// Distance (µm) from which on the level is 1.
    pub far: f32,
    /// What is smaller (pixels) is left out.
    pub smallest: f32,
}

/// By what the level is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Criterion {
    /// Error in pixels.
    #[default]
    Error,
    /// Size in pixels.
    Size,
    /// The same everywhere.
    Homogeneous,
    /// By the distance from the eye.
    Distance,
}

impl Default for Detail {
    fn default() -> Self {
        Self {
            criterion: Criterion::Error,
            error: 0.5,
            size: 8.0,
            level: 4,
            far: 500.0,
            smallest: 0.0,
        }
    }
}

impl Detail {
    pub(crate) fn choice(&self) -> Choice {
        match self.criterion {
            Criterion::Error => Choice::PixelError(self.error.max(0.01)),
            Criterion::Size => Choice::PixelSize(self.size.max(0.5)),
            Criterion::Homogeneous => Choice::Homogeneous(self.level.clamp(1, 64)),
            Criterion::Distance => Choice::Distance {
                level: self.level.clamp(1, 64),
                far: self.far.max(1e-3),
            },
        }
    }
}

impl Document {
    /// How the soma of a source is made.
    pub fn soma(&self, source: SourceId) -> SomaEdit {
        let edit = self.somata.iter().find(|(id, _)| *id == source);
        edit.map_or_else(SomaEdit::default, |(_, edit)| *edit)
    }

    /// Another soma for a source.
    pub fn set_soma(&mut self, source: SourceId, edit: SomaEdit) {
        self.somata.retain(|(id, _)| *id != source);
        if edit != SomaEdit::default() {
            self.somata.push((source, edit));
            self.somata.sort_by_key(|(id, _)| *id);
        }
    }

    /// Indices of what is selected.
    pub fn selected(&self) -> impl Iterator<Item = usize> {
        let selected = self.neurons.iter().enumerate();
        selected.filter(|(_, n)| n.selected).map(|(i, _)| i)
    }

    /// Sources of what is selected, each once.
    pub fn selected_sources(&self) -> Vec<SourceId> {
        let mut sources: Vec<SourceId> = self.selected().map(|i| self.neurons[i].source).collect();
        sources.sort_unstable();
        sources.dedup();
        sources
    }
}

/// Where neurons stand side by side: `extents` are centre and size (µm) of each in its own place.
pub fn grid(neurons: &[Neuron], extents: &[(DVec3, DVec3)]) -> Vec<Placement> {
    let columns = (neurons.len() as f64).sqrt().ceil().max(1.0) as usize;
    let widest = |axis: usize| {
        extents
            .iter()
            .map(|(_, size)| size[axis])
            .fold(0.0, f64::max)
    };
    let step = DVec3::new(1.1 * widest(0), 1.1 * widest(1), 0.0);
    let place = |(i, (neuron, (center, _))): (usize, (&Neuron, &(DVec3, DVec3)))| {
        let cell = DVec3::new((i % columns) as f64, -((i / columns) as f64), 0.0);
        Placement {
            translation: neuron.placement.translation + cell * step - *center,
            ..neuron.placement
        }
    };
    neurons.iter().zip(extents).enumerate().map(place).collect()
}

/// Rotation and place as a session has them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PlaceFile {
    pub(crate) rotation: [f64; 4],
    pub(crate) scale: f64,
    pub(crate) translation: [f64; 3],
}

impl From<Placement> for PlaceFile {
    fn from(p: Placement) -> Self {
        Self {
            rotation: p.rotation.to_array(),
            scale: p.scale,
            translation: p.translation.to_array(),
        }
    }
}

impl From<PlaceFile> for Placement {
    fn from(p: PlaceFile) -> Self {
        let rotation = DQuat::from_array(p.rotation);
        Self {
            rotation: if rotation.is_finite() && rotation.length() > 1e-6 {
                rotation.normalize()
            } else {
                DQuat::IDENTITY
            },
            scale: if p.scale.is_finite() && p.scale > 0.0 {
                p.scale
            } else {
                1.0
            },
            translation: DVec3::from_array(
                p.translation.map(|c| if c.is_finite() { c } else { 0.0 }),
            ),
        }
    }
}

macro_rules! by_name {
    ($module:ident, $type:ty) => {
        mod $module {
            use serde::{Deserialize, Deserializer, Serializer};

            pub(super) fn serialize<S: Serializer>(
                value: &$type,
                serializer: S,
            ) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(value.name())
            }

            pub(super) fn deserialize<'de, D: Deserializer<'de>>(
                deserializer: D,
            ) -> Result<$type, D::Error> {
                String::deserialize(deserializer)?
                    .parse()
                    .map_err(serde::de::Error::custom)
            }
        }
    };
}

by_name!(palette, neurotess::render::Palette);
by_name!(colour_map, neurotess::render::ColourMap);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neurons_on_a_grid_do_not_overlap() {
        let neurons: Vec<Neuron> = (0..5)
            .map(|i| Neuron::new(SourceId(i), String::new()))
            .collect();
        let extents: Vec<(DVec3, DVec3)> = (0..5)
            .map(|i| {
                (
                    DVec3::splat(f64::from(i)),
                    DVec3::new(10.0 + f64::from(i), 20.0, 5.0),
                )
            })
            .collect();
        let places = grid(&neurons, &extents);
        for (i, (a, (center_a, size))) in places.iter().zip(&extents).enumerate() {
            for (b, (center_b, other)) in places[..i].iter().zip(&extents) {
                let apart = (a.translation + *center_a - b.translation - *center_b).abs();
                let room = (*size + *other) / 2.0;
                assert!(apart.x > room.x || apart.y > room.y, "{i}");
            }
        }
    }

    #[test]
    fn a_usual_soma_is_not_kept() {
        let mut document = Document::default();
        let edit = SomaEdit {
            poisson: 0.1,
            ..SomaEdit::default()
        };
        document.set_soma(SourceId(3), edit);
        assert_eq!(document.soma(SourceId(3)), edit);
        document.set_soma(SourceId(3), SomaEdit::default());
        assert!(document.somata.is_empty());
    }
}
