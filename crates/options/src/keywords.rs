//! Options by their names.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::alike::one_of;
use crate::{OptionError, Picture, text_of};

/// Options that do not go together with another one, which is given in their place.
const RIVALS: [(&str, &[&str]); 15] = [
    ("view", &["eye", "target", "up", "saved_view"]),
    ("eye", &["view", "saved_view"]),
    (
        "color_by",
        &[
            "color_by_attribute",
            "report",
            "time",
            "picture_times",
            "range",
        ],
    ),
    (
        "color_by_attribute",
        &["color_by", "report", "time", "picture_times", "range"],
    ),
    ("report", &["color_by", "color_by_attribute"]),
    ("palette", &["set_color", "background"]),
    ("background", &["transparent"]),
    ("transparent", &["background"]),
    ("level", &["lod", "pixels", "budget"]),
    ("pixels", &["lod", "level", "budget"]),
    ("lod", &["level", "pixels", "budget"]),
    ("synapses", &["points", "marker_color_by"]),
    ("points", &["synapses", "synapse_side", "marker_color_by"]),
    ("turntable", &["time", "picture_times"]),
    ("time", &["picture_times", "turntable", "frames"]),
];

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
        let times = ("picture_times".to_owned(), "camera".to_owned());
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

    /// The same with the options of these names as another picture has them. What does not go together with them is as
    /// usual: a side instead of an eye, a level instead of an error.
    #[must_use]
    pub fn with(mut self, other: &Self, keywords: &[String]) -> Self {
        let others = value_of(other);
        let usual = value_of(&Self::default());
        let all = Self::keywords();
        let mut take = |from: &Map<String, Value>, name: &str| {
            let Some((_, group)) = all.iter().find(|(known, _)| known == name) else {
                return;
            };
            if let Some(value) = from.get(group).and_then(|options| options.get(name)) {
                // It was read from this text: it is one that the option can have.
                drop(self.set_in(group, name, value));
            }
        };
        for keyword in keywords {
            let rivals = RIVALS.iter().filter(|(name, _)| name == keyword);
            for rival in rivals.flat_map(|(_, rivals)| *rivals) {
                take(&usual, rival);
            }
        }
        for keyword in keywords.iter().filter(|name| *name != "set_color") {
            take(&others, keyword);
        }
        if keywords.iter().any(|name| name == "set_color") {
            // Beside those that there are.
            let set = other.colors.set_color.iter().cloned();
            self.colors.set_color.extend(set);
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

/// Sets an option of a group by its name.
///
/// # Errors
/// There is no such option, or a value that it cannot have.
pub fn set_option<Group: Serialize + DeserializeOwned>(
    group: &mut Group,
    keyword: &str,
    value: &Value,
) -> Result<(), OptionError> {
    let known = value_of(group);
    match known.contains_key(keyword) {
        true => set(group, keyword, value),
        false => Err(OptionError::unknown(
            keyword,
            known.keys().map(String::as_str),
        )),
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
    let number = listed.is_number();
    all.insert(name.to_owned(), listed);
    // Only this one can be wrong: all others are those of a group that there is.
    let mut read = serde_json::from_value(Value::Object(all.clone()));
    if read.is_err() && number {
        // A name that is a number, like that of a node set; of choices, the message names them.
        all.insert(name.to_owned(), Value::String(text_of(value)));
        read = serde_json::from_value(Value::Object(all)).or_else(|e| match e.to_string() {
            told if told.starts_with("unknown variant") => Err(e),
            _ => read,
        });
    }
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
                    "i64" | "u64" | "usize" => "a whole number is needed".into(),
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// A value for each option that is not its default, in two forms.
    fn values() -> Vec<(&'static str, Value, Value)> {
        vec![
            ("size", json!([640, 480]), json!("640x480")),
            ("samples", json!(4), json!("4")),
            ("scale_bar", json!(true), json!("fit")),
            ("least_width", json!(2), json!("2.0")),
            ("light", json!([-1, 1, 1]), json!("-1,1,1")),
            ("ao", json!(0), json!("0")),
            ("range", json!([-80, 30.5]), json!("-80,30.5")),
            (
                "set_color",
                json!({ "axon": "#ff8800" }),
                json!("axon=#ff8800"),
            ),
            ("ring", json!({ "2": 0.5 }), json!(["2=0.5"])),
            ("types", json!(["axon", 3]), json!(["axon", "3"])),
            ("eye", json!([0, 20, 80]), json!("0,20,80")),
            ("time", json!(14.5), json!("14.5")),
            ("level", json!(3), json!("3")),
            ("synapses", json!(true), json!("all")),
            ("marker_size", json!(2), json!("2")),
            ("mesh", json!(["a.obj,fit"]), json!("a.obj,fit")),
            ("nodes", json!([0, 5, "10-19"]), json!("0,5,10-19")),
            (
                "region",
                json!([[0, 0, 0], [1, 2, 3]]),
                json!("0,0,0,1,2,3"),
            ),
        ]
    }

    #[test]
    fn numbers_lists_and_texts_are_the_same_and_come_back() {
        for (name, list, text) in values() {
            let of = |value: &Value| {
                let mut picture = Picture::default();
                picture.set(name, value).expect(name);
                picture
            };
            let picture = of(&list);
            assert_eq!(picture, of(&text), "{name}");
            assert_ne!(picture, Picture::default(), "{name}");
            let json = picture.to_json();
            assert_eq!(Picture::from_json(&json), Ok(picture.clone()), "{json}");
            let names = [name.to_owned()];
            assert_eq!(Picture::default().with(&picture, &names), picture);
        }
    }

    #[test]
    fn what_is_given_displaces_what_does_not_go_with_it() {
        let of = |options: &[(&str, Value)]| {
            let mut picture = Picture::default();
            for (name, value) in options {
                picture.set(name, value).expect(name);
            }
            picture
        };
        for (before, given, after) in [
            (
                vec![("eye", json!([0, 0, 9])), ("target", json!([0, 0, 0]))],
                ("view", json!("iso")),
                vec![("view", json!("iso"))],
            ),
            (
                vec![("transparent", json!(true))],
                ("background", json!("black")),
                vec![("background", json!("black"))],
            ),
            (
                vec![("pixels", json!(1))],
                ("level", json!(2)),
                vec![("level", json!(2))],
            ),
            (
                vec![("color_by_attribute", json!("layer"))],
                ("color_by", json!("type")),
                vec![("color_by", json!("type"))],
            ),
            (
                vec![("set_color", json!("axon=#ff0000"))],
                ("set_color", json!("soma=#000000")),
                vec![("set_color", json!(["axon=#ff0000", "soma=#000000"]))],
            ),
        ] {
            let names = [given.0.to_owned()];
            let after = of(&after);
            assert_eq!(of(&before).with(&of(&[given]), &names), after, "{names:?}");
        }
    }

    #[test]
    fn what_is_wrong_says_the_option_and_what_is_possible() {
        for (name, value, told) in [
            (
                "size",
                json!([640]),
                "size=640: width x height is needed, 1 to 32768, as in 1280x960",
            ),
            (
                "color_by",
                json!("depht"),
                "color_by=depht: use type, neurite, section, order, radius, depth, neuron or value",
            ),
            (
                "samples",
                json!(65),
                "samples=65: a whole number from 1 to 64 is needed",
            ),
            (
                "wireframe",
                json!(3),
                "wireframe=3: true or false is needed",
            ),
            (
                "eye",
                json!([0, 1]),
                "eye=0,1: three numbers X,Y,Z are needed, as in 0,20,80",
            ),
            (
                "colour-map",
                json!("jet"),
                "there is no option 'colour-map': did you mean 'colormap'?",
            ),
            ("zzz", json!(1), "there is no option 'zzz'"),
        ] {
            let error = Picture::default().set(name, &value).expect_err(name);
            assert_eq!(error.to_string(), told);
        }
        for (json, told) in [
            (
                json!({ "looks": {} }),
                "there is no option 'looks': did you mean 'look'?",
            ),
            (
                json!({ "look": { "color_by": "type" } }),
                "there is no option 'color_by'",
            ),
            (json!({ "look": 3 }), "look=3: options by name are needed"),
            (
                json!([]),
                "a picture=: options by group are needed, as in {\"look\": {\"size\": \"640x480\"}}",
            ),
        ] {
            assert_eq!(
                Picture::from_json(&json).expect_err("wrong").to_string(),
                told
            );
        }
    }
}
