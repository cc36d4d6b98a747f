//! Synapses and points beside the cells.

use std::path::PathBuf;

use neurotess::circuit::SynapseSide;
use neurotess::render::MarkerShape;
use serde::{Deserialize, Serialize};

/// Which synapses and points are shown beside the cells, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MarkerOptions {
    /// Whether synapses of the cells of circuits are shown.
    pub synapses: bool,
    /// Names of populations of edges; none: all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<String>,
    /// On which of its two cells a synapse is shown.
    #[serde(with = "side")]
    pub side: SynapseSide,
    /// A number of each synapse that colors tell; none: they tell the population of edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub property: Option<String>,
    /// Whether only synapses of selected cells are shown, while any cell is selected.
    pub of_selected: bool,
    /// A table of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<PathBuf>,
    /// The column of the table that colors tell; none: all points have one color.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// What each is drawn as.
    #[serde(with = "shape")]
    pub shape: MarkerShape,
    /// Diameter (µm).
    pub size: f32,
}

impl Default for MarkerOptions {
    fn default() -> Self {
        Self {
            synapses: false,
            edges: Vec::new(),
            side: SynapseSide::Afferent,
            property: None,
            of_selected: true,
            points: None,
            column: None,
            shape: MarkerShape::Sphere,
            size: 1.0,
        }
    }
}

impl MarkerOptions {
    /// Whether anything is shown.
    pub fn any(&self) -> bool {
        self.synapses || self.points.is_some()
    }

    /// Shape and radius (µm).
    pub(crate) fn form(&self) -> (MarkerShape, f64) {
        (self.shape, 0.5 * f64::from(self.size.clamp(0.01, 1000.0)))
    }
}

mod side {
    use neurotess::circuit::SynapseSide;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(
        side: &SynapseSide,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(match side {
            SynapseSide::Afferent => "afferent",
            SynapseSide::Efferent => "efferent",
        })
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<SynapseSide, D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "afferent" => Ok(SynapseSide::Afferent),
            "efferent" => Ok(SynapseSide::Efferent),
            other => Err(serde::de::Error::unknown_variant(
                other,
                &["afferent", "efferent"],
            )),
        }
    }
}

mod shape {
    use neurotess::render::MarkerShape;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(
        shape: &MarkerShape,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(match shape {
            MarkerShape::Point => "point",
            MarkerShape::Sphere => "sphere",
            MarkerShape::Contact => "contact",
        })
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<MarkerShape, D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "point" => Ok(MarkerShape::Point),
            "sphere" => Ok(MarkerShape::Sphere),
            "contact" => Ok(MarkerShape::Contact),
            other => Err(serde::de::Error::unknown_variant(
                other,
                &["point", "sphere", "contact"],
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_kept_as_people_write_them() {
        let options = MarkerOptions {
            synapses: true,
            side: SynapseSide::Efferent,
            shape: MarkerShape::Contact,
            points: Some("spines.csv".into()),
            ..MarkerOptions::default()
        };
        let text = toml::to_string_pretty(&options).expect("written");
        assert!(text.contains("side = \"efferent\""), "{text}");
        assert!(text.contains("shape = \"contact\""), "{text}");
        assert!(!text.contains("property"), "{text}");
        assert_eq!(toml::from_str(&text), Ok(options));
        assert_eq!(toml::from_str(""), Ok(MarkerOptions::default()));
        let wrong = toml::from_str::<MarkerOptions>("side = 'left'").expect_err("no side");
        assert!(wrong.message().contains("efferent"), "{wrong}");
    }
}
