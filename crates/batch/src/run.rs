//! The cells of a plan are claimed, made, recorded and told of, by several workers, each of which has one in memory.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use itertools::Itertools;
use neurotess_formats as formats;
use neurotess_recipe::Progress;

use crate::cell::{self, Listeners, Made, Prepared, Target};
use crate::claims::{Claim, Claimed, Waiting, claim};
use crate::error::{BatchError, CellError, CellFault};
use crate::event::{BatchReport, Event, Outcome};
use crate::plan::{Cell, Plan};
use crate::size::LargeFile;
use crate::stamp::Stamp;
use crate::tracing::readable;
use crate::workers::{self, guarded};

/// A tracing that was meshed, or why it was not.
type Shared = Option<Result<Prepared, Arc<CellFault>>>;

impl Plan {
    /// Meshes the cells that are not up to date, and tells what happens, by any thread. A tracing that several cells have
    /// is meshed once. One that fails is an outcome, and the others go on.
    ///
    /// # Errors
    /// There are no threads to be had.
    pub fn run(self, tell: impl Fn(Event<'_>) + Sync) -> Result<BatchReport, BatchError> {
        let groups = self.groups();
        let order: Vec<usize> = (0..groups.len()).collect();
        let run = Run {
            plan: &self,
            tell: &tell,
        };
        let results = workers::run(&groups, &order, self.threads, |cells| run.group(cells))?;
        let mut outcomes: Vec<Option<Outcome>> = self.cells.iter().map(|_| None).collect();
        for (cells, result) in groups.iter().zip_eq(results) {
            // What panics beside the cells is whoever listens.
            let ended = result.unwrap_or_else(|panic| {
                let bug = |&n: &usize| run.failed(&self.cells[n], CellFault::Bug(panic.clone()));
                cells.iter().map(bug).collect()
            });
            for (&cell, outcome) in cells.iter().zip_eq(ended) {
                outcomes[cell] = Some(outcome);
            }
        }
        let all = self.cells.iter().zip_eq(outcomes);
        let all = all.map(|(cell, ended)| ended.unwrap_or_else(|| Outcome::kept(&cell.job)));
        Ok(BatchReport {
            outcomes: all.collect(),
            not_found: self.not_found.clone(),
        })
    }

    /// Cells that are to be made, by tracing. Those with the most cells and the largest files come first, so that none of
    /// them comes last and keeps one core busy while the others wait.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut of_template: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (n, cell) in self.cells.iter().enumerate() {
            if !self.stays(n) {
                of_template.entry(cell.template).or_default().push(n);
            }
        }
        let mut groups: Vec<Vec<usize>> = of_template.into_values().collect();
        groups.sort_by_cached_key(|cells| {
            let size = size(&self.cells[cells[0]].job.input);
            std::cmp::Reverse((cells.len(), size))
        });
        groups
    }
}

/// Bytes of a file; 0 if there is none.
fn size(path: &Path) -> u64 {
    fs::metadata(formats::file_of(path)).map_or(0, |data| data.len())
}

/// A plan while it is followed.
struct Run<'r> {
    plan: &'r Plan,
    tell: &'r (dyn Fn(Event<'_>) + Sync),
}

impl Run<'_> {
    /// Makes all cells of one tracing.
    fn group(&self, cells: &[usize]) -> Vec<Outcome> {
        let mut shared = None;
        let outcome = |&n: &usize| {
            let cell = &self.plan.cells[n];
            let outcome = guarded(|| self.cell(cell, &mut shared))
                .unwrap_or_else(|panic| self.failed(cell, CellFault::Bug(panic)));
            (self.tell)(Event::Ended(&outcome));
            outcome
        };
        cells.iter().map(outcome).collect()
    }

    /// Claims a cell's file, writes it, records what it was made from and gives it its name.
    fn cell(&self, cell: &Cell, shared: &mut Shared) -> Outcome {
        let Plan { options, .. } = self.plan;
        if options.is_stopped() {
            return self.failed(cell, CellFault::Stopped);
        }
        let inputs = Stamp::of_inputs(&cell.job);
        let claimed = readable(&cell.job.input).map_err(CellFault::from);
        let made = match claimed.and_then(|()| self.claim(cell)) {
            Ok(Claim::Done) => return Outcome::kept(&cell.job),
            Ok(Claim::Stopped) => return self.failed(cell, CellFault::Stopped),
            Ok(Claim::Ours(claimed)) => self.make(cell, claimed, shared),
            Err(fault) => return self.failed(cell, fault),
        };
        let Made { report, files } = match made {
            Ok(made) => made,
            Err(error) => return Outcome::Failed(error),
        };
        if self.plan.records {
            let made = files.meshes(&cell.job.out);
            if let Err(e) = self.plan.record.add(&cell.job, inputs.as_deref(), &made) {
                (self.tell)(Event::Unrecorded(&e));
            }
        }
        (self.tell)(Event::Written(&report));
        match files.finish() {
            Ok(()) => Outcome::Done(Box::new(report)),
            Err(e) => self.failed(cell, e),
        }
    }

    fn claim(&self, cell: &Cell) -> Result<Claim, CellFault> {
        let Plan {
            options, record, ..
        } = self.plan;
        let waiting = Waiting {
            tell: &|| (self.tell)(Event::Waiting(&cell.job)),
            is_stopped: &|| options.is_stopped(),
        };
        let resumed = self.plan.states.as_ref().map(|_| record);
        Ok(claim(&cell.job, options.existing, resumed, &waiting)?)
    }

    /// Writes a cell; its tracing is meshed by the first that has it.
    fn make(&self, cell: &Cell, claimed: Claimed, shared: &mut Shared) -> Result<Made, CellError> {
        let Plan { options, .. } = self.plan;
        let job = &cell.job;
        let progress = |progress: Progress| (self.tell)(Event::Progress(job, progress));
        let large = |large: &LargeFile| (self.tell)(Event::Large(large));
        let error = |fault: CellFault| CellError::new(&job.input, fault);
        // Before the work: they may be in the way.
        let tables = options.tables.begin(options.existing);
        let tables = tables.map_err(|e| error(e.into()))?;
        let prepared =
            shared.get_or_insert_with(|| Ok(cell::prepare(&job.input, options, &progress)?));
        let prepared = prepared.as_ref().map_err(|fault| {
            let error = CellError::new(&job.input, Arc::clone(fault));
            error.of_node(cell.node.clone())
        })?;
        let place = cell.place.as_ref();
        let to = Target {
            job,
            claimed,
            node: cell.node.clone(),
            world_from_cell: place.map(|place| place(&prepared.meshed.morphology)),
        };
        let listeners = Listeners {
            progress: &progress,
            large: &large,
        };
        let written = prepared.write(options, to, tables, listeners);
        written.map_err(error)
    }

    fn failed(&self, cell: &Cell, fault: impl Into<CellFault>) -> Outcome {
        Outcome::Failed(CellError::new(&cell.job.input, fault.into()))
    }
}
