//! Colors, light, and which parts of cells are shown.

use neurotess::coloring::{self, OwnColors};
use neurotess::render::Light;
use neurotess::render::color::{ColorMap, Palette, Rgb};
use serde::{Deserialize, Serialize};

/// Default background: a light gray, on which pale lines can be seen, and which makes dark somata
/// look less hard than white does.
pub const PAPER: Rgb = [238, 240, 243];

/// Colors, light, and which parts of cells are shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Look {
    /// What neurons are colored by.
    #[serde(alias = "colour_by")]
    pub color_by: ColorBy,
    /// Name of the attribute, for [`ColorBy::Attribute`].
    pub attribute: String,
    /// Numbers at both ends of the color map; none: they follow from the data.
    pub range: Option<[f32; 2]>,
    /// Time (ms) after which the flash of a spike has faded to about a third.
    pub decay: f64,
    /// Colors of types.
    #[serde(with = "palette")]
    pub palette: Palette,
    /// Colors of numbers.
    #[serde(with = "color_map", alias = "colour_map")]
    pub color_map: ColorMap,
    /// Whether the end of the color map that is as light or dark as the background is left out.
    pub trim_map: bool,
    /// Color of the background.
    pub background: Rgb,
    /// How surfaces are lit.
    pub light: Lighting,
    /// Whether corners are darkened by ambient occlusion.
    pub occlusion: bool,
    /// Whether a wireframe shows the triangles.
    #[serde(alias = "wires")]
    pub wireframe: bool,
    /// Whether there is a legend.
    pub legend: bool,
    /// Whether there is a scale bar.
    pub scale_bar: bool,
    /// Whether the directions of x, y and z are shown.
    pub axes: bool,
    /// Whether selected neurons have a color of their own.
    #[serde(alias = "mark_selected")]
    pub highlight_selected: bool,
    /// Whether neurons that are not selected are transparent.
    #[serde(alias = "faint_others")]
    pub ghost_others: bool,
    /// Opacity of transparent neurons, 0 to 1.
    #[serde(alias = "faint")]
    pub ghost_opacity: f32,
    /// Least width of neurites, in points of the window or pixels of pictures of usual size; 0: as they are. None: what
    /// is usual for the number of neurons that show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_width: Option<f32>,
    /// Factor on the radii of neurites in the picture; 1: as they were traced.
    pub radius_factor: f64,
    /// Which parts of cells are drawn.
    pub parts: VisibleParts,
    /// Colors that are not the palette's.
    #[serde(skip_serializing_if = "OwnColors::is_empty")]
    pub own_colors: OwnColors,
    /// A plane that cuts a part of the scene away.
    pub cut: Option<Cut>,
}

/// What neurons are colored by; see [`coloring::ColorBy`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum ColorBy {
    #[default]
    Type,
    Neuron,
    Neurite,
    Section,
    #[serde(rename = "order", alias = "branchorder")]
    BranchOrder,
    Radius,
    #[serde(rename = "depth", alias = "pathdistance")]
    PathDistance,
    Attribute,
    Value,
}

impl ColorBy {
    /// All of them, with their names in the panel.
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::Type, "type"),
        (Self::Neuron, "neuron"),
        (Self::Neurite, "neurite"),
        (Self::Section, "section"),
        (Self::BranchOrder, "branch order"),
        (Self::Radius, "radius"),
        (Self::PathDistance, "path distance"),
        (Self::Attribute, "attribute"),
        (Self::Value, "values of a report"),
    ];

    /// Whether it needs nothing but tracings.
    pub fn is_of_tracings(self) -> bool {
        self.in_library().is_some()
    }

    /// Whether it differs among neurons of one tracing.
    pub fn is_of_neurons(self) -> bool {
        matches!(self, Self::Neuron | Self::Attribute | Self::Value)
    }

    /// Whether it may be a number, whose range can be fixed.
    pub fn has_range(self) -> bool {
        self.is_number() || self == Self::Attribute
    }

    /// Whether it is a number, with a color map.
    pub fn is_number(self) -> bool {
        matches!(
            self,
            Self::BranchOrder | Self::Radius | Self::PathDistance | Self::Value
        )
    }

    /// The library's value; none if it needs more than a tracing.
    pub(crate) fn in_library(self) -> Option<coloring::ColorBy> {
        Some(match self {
            Self::Type => coloring::ColorBy::Type,
            Self::Neuron => coloring::ColorBy::Neuron,
            Self::Neurite => coloring::ColorBy::Neurite,
            Self::Section => coloring::ColorBy::Section,
            Self::BranchOrder => coloring::ColorBy::BranchOrder,
            Self::Radius => coloring::ColorBy::Radius,
            Self::PathDistance => coloring::ColorBy::PathDistance,
            Self::Attribute | Self::Value => return None,
        })
    }
}

/// How surfaces are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lighting {
    /// From the upper left.
    #[default]
    Soft,
    /// No light: plain colors.
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
    /// The same in the window's words.
    pub(crate) fn of(light: Light) -> Self {
        match light {
            Light::Soft => Self::Soft,
            Light::Flat => Self::Flat,
            Light::From(way) => {
                let way = way.normalize_or(glam::Vec3::Z);
                Self::From {
                    right: way.x.atan2(way.z).to_degrees(),
                    up: way.y.asin().to_degrees(),
                }
            }
        }
    }

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

/// Which parts of cells are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VisibleParts {
    /// All.
    #[default]
    All,
    /// Somata only.
    Soma,
    /// Neurites only.
    Neurites,
}

/// A plane across the scene, behind which everything is cut away.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// The axis that it is perpendicular to: 0 x, 1 y, 2 z.
    pub axis: usize,
    /// Its position, from 0 to 1 through the scene.
    pub place: f32,
    /// Whether the other side is cut away.
    pub flipped: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            color_by: ColorBy::Type,
            attribute: String::new(),
            range: None,
            decay: coloring::DECAY,
            palette: Palette::default(),
            color_map: ColorMap::default(),
            trim_map: false,
            background: PAPER,
            light: Lighting::Soft,
            occlusion: true,
            wireframe: false,
            legend: true,
            scale_bar: true,
            axes: true,
            highlight_selected: false,
            ghost_others: false,
            ghost_opacity: 0.25,
            least_width: None,
            radius_factor: 1.0,
            parts: VisibleParts::All,
            own_colors: OwnColors::default(),
            cut: None,
        }
    }
}

impl Look {
    /// Factor on the radii of neurites, within bounds whatever a session says.
    pub(crate) fn radius_factor(&self) -> f64 {
        match self.radius_factor.is_finite() {
            true => self.radius_factor.clamp(0.1, 100.0),
            false => 1.0,
        }
    }

    /// Least width of neurites while so many neurons show, within bounds whatever a session says: in points of the
    /// window, or pixels of pictures of usual size.
    pub(crate) fn least_width_of(&self, neurons: usize) -> f32 {
        let width = self.least_width.filter(|width| width.is_finite());
        let width = width.map(|width| width.clamp(0.0, 100.0));
        width.unwrap_or_else(|| neurotess::render::Look::usual_least_width(neurons))
    }

    /// What is taste in it, and survives into the next cell: palette, color map, background, light, legend. What
    /// changes what is seen belongs to the document: there a cell must not be taken for another one, or for thicker
    /// or less than it is. Nor do colors that were chosen for one circuit fit another.
    pub(crate) fn taste(&self) -> Self {
        let usual = Self::default();
        Self {
            color_by: match self.color_by.is_of_tracings() {
                true => self.color_by,
                false => usual.color_by,
            },
            attribute: usual.attribute,
            range: usual.range,
            wireframe: usual.wireframe,
            ghost_others: usual.ghost_others,
            least_width: usual.least_width,
            radius_factor: usual.radius_factor,
            parts: usual.parts,
            cut: usual.cut,
            ..self.clone()
        }
    }

    /// What a glance at the picture does not tell, and would take for the cell's own, in words.
    pub(crate) fn falsifies(&self) -> Vec<String> {
        let factor = self.radius_factor();
        let radii = (factor != 1.0).then(|| format!("radii × {}", (10.0 * factor).round() / 10.0));
        let parts = match self.parts {
            VisibleParts::All => None,
            VisibleParts::Soma => Some("somata only".to_owned()),
            VisibleParts::Neurites => Some("neurites only".to_owned()),
        };
        radii.into_iter().chain(parts).collect()
    }

    /// Color of a type of SWC.
    pub(crate) fn type_color(&self, kind: i32) -> Rgb {
        let own = self.own_colors.types.get(&kind).copied();
        own.unwrap_or_else(|| self.palette.of_type(kind))
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

by_name!(palette, neurotess::render::color::Palette);
by_name!(color_map, neurotess::render::color::ColorMap);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_of_earlier_versions_are_read() {
        let text = "colour_by = 'depth'\nwires = true\nmark_selected = true\nfaint_others = true\nfaint = 0.5";
        let look: Look = toml::from_str(text).expect("read");
        assert_eq!(look.color_by, ColorBy::PathDistance);
        assert!(look.wireframe && look.highlight_selected && look.ghost_others);
        assert_eq!(look.ghost_opacity, 0.5);
        assert!(look.own_colors.is_empty());
    }

    #[test]
    fn what_changes_what_is_seen_is_no_taste() {
        let look = Look {
            background: [1, 2, 3],
            legend: false,
            color_by: ColorBy::Value,
            range: Some([1.0, 2.0]),
            ghost_others: true,
            least_width: Some(2.0),
            radius_factor: 100.0,
            parts: VisibleParts::Neurites,
            cut: Some(Cut {
                axis: 1,
                place: 0.5,
                flipped: true,
            }),
            ..Look::default()
        };
        assert_eq!(look.falsifies(), ["radii × 100", "neurites only"]);
        let taste = Look {
            background: [1, 2, 3],
            legend: false,
            ..Look::default()
        };
        assert_eq!(look.taste(), taste);
        assert!(taste.falsifies().is_empty());
    }

    #[test]
    fn own_colors_are_kept_as_people_write_them() {
        let mut look = Look {
            light: Lighting::From {
                right: 1.0,
                up: 2.0,
            },
            cut: Some(Cut {
                axis: 1,
                place: 0.5,
                flipped: true,
            }),
            ..Look::default()
        };
        look.own_colors.set_named("axon", [255, 136, 0]);
        look.own_colors.set_named("L5 µ", [1, 2, 3]);
        let text = toml::to_string_pretty(&look).expect("written");
        assert!(
            text.contains("[own_colors.types]\naxon = \"#ff8800\""),
            "{text}"
        );
        assert_eq!(toml::from_str(&text), Ok(look));
    }
}
