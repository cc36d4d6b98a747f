//! Options by their names.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::alike::one_of;
use crate::groups::DeviceOptions;
use crate::{OptionError, Picture, text_of};

impl Picture {
    /// The names of all options, each with its group.
    pub fn keywords() -> Vec<(String, String)> {
        let all = value_of(&Self::default());
        let groups = all.into_iter().flat_map(|(group, options)| {
            let options = match options {
                Value::Object(options) => options,
                _ => Map::new(),
            };
            options
                .into_iter()
                .map(move |(name, _)| (name, group.clone()))
        });
        let times = ("times".to_owned(), "camera".to_owned());
        groups.chain([times]).collect()
    }

    /// Sets an option by its name, which flags have with hyphens.
    ///
    /// # Errors
    /// There is no such option: the nearest name is told. A value that it cannot have: what is possible is told.
    pub fn set(&mut self, keyword: &str, value: &Value) -> Result<(), OptionError> {
        let name = keyword.replace('-', "_");
        let all = Self::keywords();
        let Some((_, group)) = all.iter().find(|(known, _)| *known == name) else {
            return Err(OptionError::unknown(
                keyword,
                all.iter().map(|(name, _)| &name[..]),
            ));
        };
        self.set_in(group, &name, value)
    }

    fn set_in(&mut self, group: &str, name: &str, value: &Value) -> Result<(), OptionError> {
        match group {
            "look" => set(&mut self.look, name, value),
            "colors" => set(&mut self.colors, name, value),
            "camera" => set(&mut self.camera, name, value),
            "refinement" => set(&mut self.refinement, name, value),
            "shape" => set(&mut self.shape, name, value),
            "markers" => set(&mut self.markers, name, value),
            "meshes" => set(&mut self.meshes, name, value),
            "cells" => {
                let listed = self.cells.listed.take();
                let done = set(&mut self.cells, name, value);
                self.cells.listed = listed;
                done
            }
            _ => Ok(()),
        }
    }

    /// The same with the options of these names as another picture has them.
    #[must_use]
    pub fn with(mut self, other: &Self, keywords: &[String]) -> Self {
        let others = value_of(other);
        for (name, group) in Self::keywords() {
            if let Some(value) = others.get(&group).and_then(|all| all.get(&name))
                && keywords.contains(&name)
            {
                // It was read from this text: it is one that the option can have.
                drop(self.set_in(&group, &name, value));
            }
        }
        self
    }

    /// The options that are not as usual, by group.
    pub fn to_json(&self) -> Value {
        let usual = value_of(&Self::default());
        let mut given = value_of(self);
        for (group, options) in &mut given {
            if let (Value::Object(options), Some(Value::Object(usual))) =
                (options, usual.get(group))
            {
                options.retain(|name, value| usual.get(name) != Some(value));
            }
        }
        given.retain(|_, options| options.as_object().is_some_and(|all| !all.is_empty()));
        Value::Object(given)
    }

    /// Options by group, as [`to_json`](Self::to_json) gives them; what is none has its default.
    ///
    /// # Errors
    /// A group or an option that there is not, or a value that it cannot have.
    pub fn from_json(json: &Value) -> Result<Self, OptionError> {
        let mut picture = Self::default();
        let Value::Object(groups) = json else {
            return Err(OptionError::value(
                "a picture",
                json,
                "options by group are needed, as in {\"look\": {\"size\": \"640x480\"}}",
            ));
        };
        let known = value_of(&picture);
        for (group, options) in groups {
            if !known.contains_key(group) {
                return Err(OptionError::unknown(
                    group,
                    known.keys().map(String::as_str),
                ));
            }
            let Value::Object(options) = options else {
                return Err(OptionError::value(
                    group,
                    options,
                    "options by name are needed",
                ));
            };
            let all = Self::keywords();
            for (name, value) in options {
                if !all.iter().any(|(known, of)| known == name && of == group) {
                    let names = all.iter().filter(|(_, of)| of == group);
                    return Err(OptionError::unknown(name, names.map(|(name, _)| &name[..])));
                }
                picture.set_in(group, name, value)?;
            }
        }
        Ok(picture)
    }
}

impl DeviceOptions {
    /// Sets an option by its name.
    ///
    /// # Errors
    /// There is no such option, or a value that it cannot have.
    pub fn set(&mut self, keyword: &str, value: &Value) -> Result<(), OptionError> {
        let known = value_of(self);
        match known.contains_key(keyword) {
            true => set(self, keyword, value),
            false => Err(OptionError::unknown(
                keyword,
                known.keys().map(String::as_str),
            )),
        }
    }
}

/// Sets an option of a group.
fn set<Group: Serialize + DeserializeOwned>(
    group: &mut Group,
    name: &str,
    value: &Value,
) -> Result<(), OptionError> {
    let mut all = value_of(group);
    // Of lists one entry alone, and entries by name: those of a map.
    let pair = |(of, to): (&String, &Value)| Value::String(format!("{of}={}", text_of(to)));
    let listed = match (all.get(name), value) {
        (Some(Value::Array(_)), Value::Object(entries)) => {
            Value::Array(entries.iter().map(pair).collect())
        }
        (Some(Value::Array(_)), Value::Array(_)) => value.clone(),
        (Some(Value::Array(_)), one) if name != "synapses" => Value::Array(vec![one.clone()]),
        _ => value.clone(),
    };
    all.insert(name.to_owned(), listed);
    // Only this one can be wrong: all others are those of a group that there is.
    let read = serde_json::from_value(Value::Object(all));
    *group = read.map_err(|e| OptionError::value(name, value, &needed(&e.to_string())))?;
    Ok(())
}

fn value_of(value: &impl Serialize) -> Map<String, Value> {
    match serde_json::to_value(value) {
        Ok(Value::Object(all)) => all,
        // Groups are maps, and all of their values have a form.
        _ => Map::new(),
    }
}

/// What is needed, in the words of all options, where the library has others.
fn needed(message: &str) -> String {
    let Some((_, expected)) = message
        .starts_with("unknown variant")
        .then(|| message.split_once("expected "))
        .flatten()
    else {
        return match message.strip_prefix("invalid type: ") {
            Some(kinds) => {
                let wanted = kinds
                    .split_once("expected ")
                    .map_or(kinds, |(_, kind)| kind);
                match wanted {
                    "a boolean" => "true or false is needed".into(),
                    "a string" => "a name is needed".into(),
                    "f64" => "a number is needed".into(),
                    "u64" | "usize" => "a whole number is needed".into(),
                    "a sequence" => "a list is needed".into(),
                    other => format!("{other} is needed"),
                }
            }
            None => message.to_owned(),
        };
    };
    let names: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    one_of(&names)
}
