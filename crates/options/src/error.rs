//! What is wrong with options.

use serde_json::Value;

/// What is wrong with options. Messages name them as flags of the command line do, where there are several.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OptionError {
    /// There is no option of this name.
    #[error("there is no option '{name}'{}", near(.nearest.as_deref()))]
    Unknown {
        /// What was given.
        name: String,
        /// The name that was likely meant.
        nearest: Option<String>,
    },
    /// A value that an option cannot have.
    #[error("{name}={value}: {needed}")]
    Value {
        /// The option.
        name: String,
        /// What was given.
        value: String,
        /// What is possible.
        needed: String,
    },
    /// Options that do not go together.
    #[error("{0}")]
    Together(String),
}

fn near(name: Option<&str>) -> String {
    name.map_or(String::new(), |name| format!(": did you mean '{name}'?"))
}

impl OptionError {
    pub(crate) fn unknown<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Self {
        Self::Unknown {
            name: name.to_owned(),
            nearest: crate::alike::nearest(name, known).map(str::to_owned),
        }
    }

    pub(crate) fn value(name: &str, value: &Value, needed: &str) -> Self {
        Self::Value {
            name: name.to_owned(),
            value: crate::text_of(value),
            needed: needed.to_owned(),
        }
    }

    /// Options that do not go together: why, and what to do.
    pub fn together(why: impl Into<String>) -> Self {
        Self::Together(why.into())
    }
}
