//! Tracings that cells share: meshed when one of them needs it, and kept within a bound of memory.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use neurotess_batch::read;
use neurotess_formats::{ReadOptions, Warning};

use crate::error::Fault;
use crate::event::Event;
use crate::levels::{LevelOptions, TemplateMesh};
use crate::source::Source;

/// Bytes of tracings that are kept; with those in use there may be more. A hundred templates of a circuit, of 20,000
/// triangles each, have 60 MB.
const KEPT: usize = 256 << 20;

type Made = Result<TemplateMesh, Arc<Fault>>;

/// The tracings of a source.
pub(crate) struct Templates<'s> {
    source: &'s Source,
    options: LevelOptions,
    stopped: &'s AtomicBool,
    tell: &'s (dyn Fn(Event<'_>) + Sync),
    uses: Vec<u32>,
    warnings: Mutex<TracingWarnings>,
    kept: Mutex<Kept>,
}

#[derive(Default)]
struct TracingWarnings {
    /// Tracings of which it is told.
    told: BTreeSet<usize>,
    /// How many tracings have a warning of each code.
    counts: BTreeMap<&'static str, usize>,
}

#[derive(Default)]
struct Kept {
    slots: HashMap<usize, Slot>,
    clock: u64,
    bytes: usize,
}

struct Slot {
    made: Arc<OnceLock<Arc<Made>>>,
    used: u64,
    /// 0 until it is made.
    bytes: usize,
}

impl<'s> Templates<'s> {
    /// `tell` is told of warnings.
    pub(crate) fn new(
        source: &'s Source,
        options: LevelOptions,
        stopped: &'s AtomicBool,
        tell: &'s (dyn Fn(Event<'_>) + Sync),
    ) -> Self {
        Self {
            source,
            options,
            stopped,
            tell,
            uses: source.uses(),
            warnings: Mutex::default(),
            kept: Mutex::default(),
        }
    }

    /// The mesh of a tracing. Threads that ask for the same one meanwhile wait.
    pub(crate) fn get(&self, template: usize) -> Arc<Made> {
        if self.uses[template] < 2 {
            return Arc::new(self.make(template));
        }
        let slot = self.kept().slot(template);
        let made = Arc::clone(slot.get_or_init(|| Arc::new(self.make(template))));
        let bytes = made.as_ref().as_ref().map_or(0, TemplateMesh::bytes);
        self.kept().hold(template, bytes);
        made
    }

    fn make(&self, template: usize) -> Made {
        let make = || -> Result<TemplateMesh, Fault> {
            let file = self.source.file(template);
            let tracing = read(file, None, &ReadOptions::default())?;
            self.warn(template, file, &tracing.warnings);
            let morphology = Arc::new(tracing.morphology);
            Ok(TemplateMesh::new(morphology, self.options, self.stopped)?)
        };
        make().map_err(Arc::new)
    }

    /// Tells the warnings of a tracing, once.
    fn warn(&self, template: usize, file: &Path, warnings: &[Warning]) {
        let mut all = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        if warnings.is_empty() || !all.told.insert(template) {
            return;
        }
        for warning in warnings {
            *all.counts.entry(warning.code).or_default() += 1;
        }
        drop(all);
        (self.tell)(Event::Warned { file, warnings });
    }

    /// How many tracings have a warning of each code.
    pub(crate) fn warnings(self) -> BTreeMap<&'static str, usize> {
        let all = self.warnings.into_inner();
        all.unwrap_or_else(PoisonError::into_inner).counts
    }

    fn kept(&self) -> std::sync::MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kept {
    fn slot(&mut self, template: usize) -> Arc<OnceLock<Arc<Made>>> {
        self.clock += 1;
        let slot = self.slots.entry(template).or_insert_with(|| Slot {
            made: Arc::default(),
            used: 0,
            bytes: 0,
        });
        slot.used = self.clock;
        Arc::clone(&slot.made)
    }

    /// Notes what a tracing takes, and forgets those that were not used for the longest time.
    fn hold(&mut self, template: usize, bytes: usize) {
        let Some(slot) = self.slots.get_mut(&template) else {
            return;
        };
        self.bytes += bytes - slot.bytes;
        slot.bytes = bytes;
        while self.bytes > KEPT {
            let oldest = self
                .slots
                .iter()
                .filter(|(n, slot)| **n != template && slot.bytes > 0);
            let Some(oldest) = oldest.min_by_key(|(_, slot)| slot.used).map(|(n, _)| *n) else {
                return;
            };
            let forgotten = self.slots.remove(&oldest);
            self.bytes -= forgotten.map_or(0, |slot| slot.bytes);
        }
    }
}
