//! How a soma is generated, and what else a cell grows that was not traced.

use std::collections::BTreeMap;

use neurotess::generate::{GenerateOptions, SomaKeep, SomaMethod, SphereKind};
use serde::{Deserialize, Serialize};

use super::SpineEdit;

/// How a soma is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SomaEdit {
    /// The method.
    pub method: Method,
    /// Poisson's ratio, 0 to 0.49.
    pub poisson: f64,
    /// What stays as it was traced.
    #[serde(skip_serializing_if = "Keep::is_usual")]
    pub keep: Keep,
    /// Factor on the radius.
    pub scale: f64,
    /// Whether the reference sphere is the paper's octahedron instead of a cube.
    pub octahedron: bool,
    /// Resolution of the reference sphere; 0: one that fits the neurites.
    pub level: u32,
    /// Positions of first rings by the neurite's number, from 0: see
    /// [`GenerateOptions::rings`]. In a session's file: a list, with numbers from 1.
    #[serde(with = "rings", skip_serializing_if = "BTreeMap::is_empty")]
    pub rings: BTreeMap<u32, f64>,
    /// Spines of the cell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spines: Option<SpineEdit>,
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
    /// No soma.
    None,
}

/// What of an elastic soma stays as it was traced: see [`SomaKeep`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Keep {
    /// Its volume.
    #[default]
    Volume,
    /// Its area.
    Area,
    /// The size of what neurites draw out.
    Scale,
}

impl Keep {
    /// Whether it is the one of a soma that nobody edited.
    fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for SomaEdit {
    fn default() -> Self {
        Self {
            method: Method::Elastic,
            poisson: 0.3,
            keep: Keep::Volume,
            scale: 1.0,
            octahedron: false,
            level: 0,
            rings: BTreeMap::new(),
            spines: None,
        }
    }
}

impl SomaEdit {
    /// The generator's options.
    pub fn options(&self) -> GenerateOptions {
        GenerateOptions {
            soma: match self.method {
                Method::Elastic => SomaMethod::Fem,
                Method::Sphere => SomaMethod::Sphere,
                Method::Profile => SomaMethod::Profile,
                Method::None => SomaMethod::None,
            },
            poisson: self.poisson.clamp(0.0, 0.49),
            soma_keep: match self.keep {
                Keep::Volume => SomaKeep::Volume,
                Keep::Area => SomaKeep::Area,
                Keep::Scale => SomaKeep::Scale,
            },
            soma_scale: self.scale.clamp(0.05, 20.0),
            sphere: match self.octahedron {
                true => SphereKind::Octahedron,
                false => SphereKind::Cube,
            },
            sphere_level: (self.level > 0).then(|| {
                let (low, high) = self.levels();
                self.level.clamp(low, high)
            }),
            rings: self.rings.clone(),
            ..GenerateOptions::default()
        }
    }

    /// Whether first rings can be placed.
    pub fn places_rings(&self) -> bool {
        matches!(self.method, Method::Elastic | Method::Profile)
    }

    /// Least and greatest resolution of the sphere.
    pub fn levels(&self) -> (u32, u32) {
        if self.octahedron { (1, 5) } else { (2, 32) }
    }
}

mod rings {
    use std::collections::BTreeMap;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Ring {
        neurite: u32,
        position: f64,
    }

    pub(super) fn serialize<S: Serializer>(
        rings: &BTreeMap<u32, f64>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let rings = rings.iter().map(|(&n, &position)| Ring {
            neurite: n + 1,
            position,
        });
        serializer.collect_seq(rings)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<BTreeMap<u32, f64>, D::Error> {
        let rings = Vec::<Ring>::deserialize(deserializer)?;
        rings
            .into_iter()
            .map(|ring| match ring.neurite.checked_sub(1) {
                Some(neurite) if (0.0..=2.0).contains(&ring.position) => {
                    Ok((neurite, ring.position))
                }
                Some(_) => Err(serde::de::Error::custom("positions are from 0 to 2")),
                None => Err(serde::de::Error::custom("neurites are counted from 1")),
            })
            .collect()
    }
}
