//! What was mended, counted by cause.

use std::fmt;

/// The codes of all causes.
pub(crate) const CODES: [&str; 41] = [
    "branch_repeated",
    "branches_separated",
    "branches_touch",
    "buried_twig",
    "close_forks",
    "coarse_coordinates",
    "coincident_points",
    "crowded_branches",
    "dense_points",
    "drawn_in",
    "far_from_soma",
    "fork_at_soma",
    "fork_split",
    "fork_thickened",
    "insertion_quad_far",
    "hub",
    "inside_soma",
    "long_sample_numbers",
    "near_fork",
    "neurite_inside_soma",
    "no_insertion_quad",
    "one_point_neurite",
    "one_point_tree",
    "radius_mended",
    "radius_raised",
    "radius_unknown",
    "ring_limited",
    "ring_moved",
    "ring_nearer",
    "ring_shrunk",
    "ring_unused",
    "rings_cross",
    "sharp_bend",
    "simplified",
    "soma_as_neurite",
    "soma_folded",
    "soma_hidden",
    "soma_radius_mended",
    "soma_rounded",
    "stems_gathered",
    "types_unused",
];

/// One cause with its count and the first sample concerned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Short name of the cause, as in `radius_mended`.
    pub code: &'static str,
    /// How often it happened.
    pub count: usize,
    /// The file's own number of the first sample concerned, if there is one.
    pub sample: Option<i64>,
    /// What was done, for people.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.sample {
            Some(id) => write!(
                f,
                "{} ({} ×, first at sample {id})",
                self.message, self.count
            ),
            None => write!(f, "{} ({} ×)", self.message, self.count),
        }
    }
}

/// Collects warnings, one per cause.
#[derive(Clone, Debug, Default)]
pub(crate) struct Warnings(Vec<Warning>);

impl Warnings {
    /// Counts one occurrence.
    pub(crate) fn add(&mut self, code: &'static str, sample: Option<i64>, message: &str) {
        debug_assert!(CODES.contains(&code), "{code} is missing in CODES");
        match self.0.iter_mut().find(|w| w.code == code) {
            Some(warning) => warning.count += 1,
            None => {
                self.0.push(Warning {
                    code,
                    count: 1,
                    sample,
                    message: message.to_owned(),
                });
            }
        }
    }

    /// Counts several occurrences at once; none if `count` is zero.
    pub(crate) fn add_many(&mut self, code: &'static str, count: usize, message: &str) {
        if count > 0 {
            self.add(code, None, message);
            if let Some(warning) = self.0.iter_mut().find(|w| w.code == code) {
                warning.count += count - 1;
            }
        }
    }

    /// Adds another step's warnings.
    pub(crate) fn extend(&mut self, other: Self) {
        for warning in other.0 {
            match self.0.iter_mut().find(|w| w.code == warning.code) {
                Some(known) => known.count += warning.count,
                None => self.0.push(warning),
            }
        }
    }

    /// The warnings in order of their first occurrence.
    pub(crate) fn into_vec(self) -> Vec<Warning> {
        self.0
    }
}
