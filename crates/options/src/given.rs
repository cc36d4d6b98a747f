//! Values as they are given: text of a flag, or numbers, lists and switches of JSON and Python, which become such text.

use serde_json::Value;

/// Whatever is given for an option, as the text that a flag of the command line would have: lists are joined by commas.
///
/// ```
/// use serde_json::json;
///
/// assert_eq!(neurotess_options::text_of(&json!([0, 20.5, -3])), "0,20.5,-3");
/// assert_eq!(neurotess_options::text_of(&json!("#ff8800")), "#ff8800");
/// ```
pub fn text_of(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(values) => {
            let texts: Vec<String> = values.iter().map(text_of).collect();
            texts.join(",")
        }
        other => other.to_string(),
    }
}

/// Reads and writes a value, which has a form as text, as text; numbers and lists are read as the text that they are.
macro_rules! by_text {
    ($($word:ty),+) => {$(
        impl<'de> serde::Deserialize<'de> for $word {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let value = serde_json::Value::deserialize(from)?;
                $crate::text_of(&value).parse().map_err(serde::de::Error::custom)
            }
        }

        impl serde::Serialize for $word {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.collect_str(self)
            }
        }
    )+};
}
pub(crate) use by_text;
