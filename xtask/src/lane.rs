//! Which checks are run: those that every change pays for, or everything.

/// A lane of `cargo xtask test`. CONTRIBUTING.md lists what only the full one checks, with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lane {
    /// What every change must pass.
    Quick,
    /// Everything: before a change is done that touches what only this checks, and every night.
    Full,
}

impl Lane {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Full => "full",
        }
    }

    /// What tells tests of the lane.
    pub(crate) fn variables(self) -> [(&'static str, &'static str); 1] {
        let full = if self == Self::Full { "1" } else { "0" };
        [("NEUROTESS_FULL", full)]
    }
}
