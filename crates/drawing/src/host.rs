//! The program around a drawing: it hears what there is to say, reads files its own way, and can stop the work.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use neurotess_formats::{self as formats, ReadOptions};
use rayon::prelude::*;

use crate::meshed::MeshedCell;

/// What is done with each file.
pub type Work<'a> = &'a (dyn Fn(&Path) -> Result<MeshedCell, String> + Sync);

/// The program around a drawing.
pub trait Host: Sync {
    /// Set by another thread that asks to stop.
    fn stopped(&self) -> &AtomicBool;

    /// Hears what is odd.
    fn warning(&self, message: &str);

    /// Hears of an input, or a part of one, that is left out: it failed.
    fn failure(&self, message: &str);

    /// Hears what was read.
    fn note(&self, _message: &str) {}

    /// Whether it wants every warning of every file, of several too.
    fn is_verbose(&self) -> bool {
        false
    }

    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read, or is no morphology: file, line, what to do.
    fn read(&self, file: &Path, options: &ReadOptions) -> Result<formats::Read, String> {
        formats::read(file, options).map_err(|e| e.to_string())
    }

    /// Does some work for all files; results are in their order.
    fn each(&self, files: &[PathBuf], work: Work<'_>) -> Vec<Result<MeshedCell, String>> {
        let stopped = || self.stopped().load(Ordering::Relaxed);
        let one = |file: &PathBuf| match stopped() {
            true => Err("stopped".to_owned()),
            false => work(file),
        };
        files.par_iter().map(one).collect()
    }
}

/// A host that keeps what it hears.
#[derive(Debug, Default)]
pub struct Quiet {
    stopped: Arc<AtomicBool>,
    messages: Mutex<Vec<String>>,
}

impl Quiet {
    /// One that ends the work soon after another thread sets `stopped`.
    pub fn stopped_by(stopped: &Arc<AtomicBool>) -> Self {
        Self {
            stopped: Arc::clone(stopped),
            messages: Mutex::default(),
        }
    }

    /// What it has heard.
    pub fn take_messages(&self) -> Vec<String> {
        let mut messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *messages)
    }
}

impl Host for Quiet {
    fn stopped(&self) -> &AtomicBool {
        &self.stopped
    }

    fn warning(&self, message: &str) {
        // One message is one line, whatever characters a file's name or content has.
        let line = message.replace(|c: char| c.is_control(), " ");
        let mut messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        messages.push(line);
    }

    fn failure(&self, message: &str) {
        self.warning(message);
    }
}
