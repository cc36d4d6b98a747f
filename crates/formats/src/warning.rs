//! What a reader took although it is odd: one warning per kind, with its first line and a count.

use std::fmt;

use neurotess_morphology::BuildNote;

use crate::{Fault, ReadError, ReadOptions};

/// Something odd in a file that could be read all the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// First line that is so, from 1 on.
    pub line: Option<u64>,
    /// Name for machines, like `soma_not_root`.
    pub code: &'static str,
    /// For people; tells the count if it is more than one.
    pub message: String,
    /// How many samples or rows are so.
    pub count: u64,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {} ({})", self.message, self.code),
            None => write!(f, "{} ({})", self.message, self.code),
        }
    }
}

/// Collects warnings; handed down by a reader.
#[derive(Default)]
pub(crate) struct Warnings(Vec<Warning>);

impl Warnings {
    pub(crate) fn add(&mut self, line: u64, code: &'static str, message: &str) {
        self.add_many(line, code, message, 1);
    }

    pub(crate) fn add_many(&mut self, line: u64, code: &'static str, message: &str, count: u64) {
        if let Some(known) = self.0.iter_mut().find(|w| w.code == code) {
            known.line = known.line.min(Some(line));
            known.count += count;
        } else {
            self.0.push(Warning {
                line: Some(line),
                code,
                message: message.into(),
                count,
            });
        }
    }

    /// Takes over what was odd about the nodes; `line` gives a node's line.
    pub(crate) fn add_notes(&mut self, notes: Vec<BuildNote>, line: impl Fn(u32) -> u64) {
        for note in notes {
            let message = note.oddity.to_string();
            self.add_many(line(note.node), note.oddity.code(), &message, note.count);
        }
    }

    /// In the order of the lines; the first is the error if reading strictly.
    pub(crate) fn finish(
        mut self,
        file: &str,
        options: &ReadOptions,
    ) -> Result<Vec<Warning>, ReadError> {
        self.0.sort_by_key(|w| w.line);
        for warning in self.0.iter_mut().filter(|w| w.count > 1) {
            warning.message = format!("{}, {} times", warning.message, warning.count);
        }
        match self.0.first() {
            Some(first) if options.strict => {
                let fault = Fault::Strict {
                    code: first.code,
                    message: first.message.clone(),
                };
                Err(ReadError {
                    file: file.into(),
                    line: first.line,
                    fault,
                })
            }
            _ => Ok(self.0),
        }
    }
}
