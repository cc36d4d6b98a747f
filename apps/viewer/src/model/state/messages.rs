//! What is said at the bottom of the window, and what went wrong.

use super::State;
use crate::model::save::Written;

/// Something that went wrong or is shown with reduced quality, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file or thing.
    pub what: String,
    /// The reason, and what to do.
    pub why: String,
}

/// What is said at the bottom of the window, and what went wrong.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    /// What was done last, for the status bar.
    pub status: String,
    /// Problems, in the order in which they occurred.
    pub problems: Vec<Problem>,
}

impl State {
    /// Notes how saving ended.
    pub(crate) fn note_saved(&mut self, result: Result<Written, String>) {
        match result {
            Ok(Written { status, remarks }) => {
                self.messages.status = status;
                for (what, why) in remarks {
                    self.problem(what, why);
                }
            }
            Err(why) => {
                self.messages.status = format!("Not saved: {why}");
                self.problem("save", why);
            }
        }
    }

    /// Adds a problem.
    pub fn problem(&mut self, what: impl Into<String>, why: impl Into<String>) {
        let problem = Problem {
            what: what.into(),
            why: why.into(),
        };
        if !self.messages.problems.contains(&problem) {
            self.messages.problems.push(problem);
        }
    }
}
