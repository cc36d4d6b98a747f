//! What a test needs, and whether it is there.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A thing that tests need, by the name and the function that says what is missing.
#[derive(Clone, Copy, Debug)]
pub struct Need {
    name: &'static str,
    probe: fn() -> Result<(), String>,
}

impl Need {
    /// `name` is that of the function, without its modules; one program has one need of a name.
    pub const fn new(name: &'static str, probe: fn() -> Result<(), String>) -> Self {
        Self { name, probe }
    }

    /// What is missing; the first call finds out, later ones remember.
    pub(crate) fn missing(&self) -> Option<String> {
        static KNOWN: Mutex<BTreeMap<&str, Option<String>>> = Mutex::new(BTreeMap::new());
        // Held while probing, so that no two tests do. A probe that panics failed its own test.
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let probe = || (self.probe)().err().map(|reason| one_line(&reason));
        known.entry(self.name).or_insert_with(probe).clone()
    }

    /// The variable with which a missing need is a failure, where it is set.
    pub(crate) fn requirement(&self) -> Option<String> {
        let variable = format!("NEUROTESS_REQUIRE_{}", self.name.to_uppercase());
        let value = std::env::var(&variable).unwrap_or_default();
        (!["", "0"].contains(&value.as_str())).then(|| format!("{variable}={value}"))
    }
}

/// The reason must fit in the line of its test.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
