//! Names and values of options in files.

use std::collections::BTreeMap;
use std::path::PathBuf;

use neurotess_generate::Smooth;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::NamedOptions;
use crate::words::Word;
use crate::{MeshOption, MeshOptions, OptionValue, Spelling};

impl NamedOptions {
    /// Keywords and values of what is set.
    fn entries(&self) -> Vec<(MeshOption, OptionValue)> {
        use MeshOption as O;
        let number = |value: Option<f64>| value.map(OptionValue::Number);
        let whole = |value: Option<u32>| value.map(|value| OptionValue::Whole(value.into()));
        let switch = |value: bool| value.then_some(OptionValue::Switch(true));
        let rings = (!self.ring.is_empty()).then(|| {
            let rings = self.ring.iter();
            let rings = rings.map(|(n, &at)| (n.to_string(), OptionValue::Number(at)));
            OptionValue::Map(rings.collect())
        });
        let kinds = self.types.as_ref().map(|kinds| {
            let kinds = kinds.iter().map(|kind| OptionValue::Whole(kind.0.into()));
            OptionValue::List(kinds.collect())
        });
        let smooth = self.smooth.map(|smooth| match smooth {
            Smooth::Auto => OptionValue::Text("auto".into()),
            Smooth::Length(length) => OptionValue::Number(length),
            _ => OptionValue::Number(0.0),
        });
        let path = |value: &PathBuf| OptionValue::Text(value.to_string_lossy().into_owned());
        let all = [
            (O::Level, whole(self.level)),
            (O::MaxError, number(self.max_error)),
            (O::LevelAlong, whole(self.level_along)),
            (O::Isotropic, number(self.isotropic)),
            (O::MaxEdge, number(self.max_edge)),
            (O::MinEdge, number(self.min_edge)),
            (O::MaxAspect, number(self.max_aspect)),
            (O::Path, self.path.map(word)),
            (O::Caps, self.caps.map(word)),
            (O::Crossings, self.crossings.map(word)),
            (O::Simulation, switch(self.simulation)),
            (O::Soma, self.soma.map(word)),
            (O::Poisson, number(self.poisson)),
            (O::SomaKeep, self.soma_keep.map(word)),
            (O::SomaMesh, self.soma_mesh.as_ref().map(path)),
            (O::SomaScale, number(self.soma_scale)),
            (O::Radii, self.radii.map(word)),
            (O::RadiusFactor, number(self.radius_factor)),
            (O::Radius, number(self.radius)),
            (O::MinRadius, number(self.min_radius)),
            (O::SomaSphere, self.soma_sphere.map(word)),
            (O::SomaLevel, whole(self.soma_level)),
            (O::Ring, rings),
            (O::Smooth, smooth),
            (O::Types, kinds),
            (O::Quads, switch(self.quads)),
        ];
        let set = all.into_iter();
        set.filter_map(|(option, value)| Some((option, value?)))
            .collect()
    }
}

fn word<T: Word>(value: T) -> OptionValue {
    OptionValue::Text(value.word().to_owned())
}

impl Serialize for NamedOptions {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let entries = self.entries();
        serializer.collect_map(
            entries
                .iter()
                .map(|(option, value)| (option.keyword(), value)),
        )
    }
}

impl<'de> Deserialize<'de> for NamedOptions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values: BTreeMap<String, Option<OptionValue>> = Deserialize::deserialize(deserializer)?;
        let mut named = Self::default();
        for (keyword, value) in &values {
            if let Some(value) = value {
                let set = named.set(keyword, value);
                set.map_err(|e| D::Error::custom(e.told(Spelling::Keyword)))?;
            }
        }
        Ok(named)
    }
}

impl Serialize for MeshOptions {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let named = NamedOptions::of(self).map_err(serde::ser::Error::custom)?;
        named.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MeshOptions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let named = NamedOptions::deserialize(deserializer)?;
        let options = named.options();
        options.map_err(|e| D::Error::custom(e.told(Spelling::Keyword)))
    }
}
