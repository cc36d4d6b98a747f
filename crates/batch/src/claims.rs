//! Claims of outputs, so that several runs can share a folder: a cell is claimed before it is read,
//! and may turn out to be done already.

use std::time::Duration;

use neurotess_output::{Existing, Output, OutputError};

use crate::record::OutputRecord;
use crate::stamp::Stamp;
use crate::standard::begin;
use crate::targets::Job;

/// Time between checks whether another run is done.
const PATIENCE: Duration = Duration::from_millis(50);

/// What a worker may do with a cell.
pub(crate) enum Claim {
    /// Write it.
    Ours(Claimed),
    /// Keep it: another run has written it meanwhile.
    Done,
    /// Leave it: another thread stopped the work while it waited.
    Stopped,
}

/// What may be written.
pub(crate) struct Claimed {
    /// The file; one that is written in parts only holds its name meanwhile.
    pub(crate) output: Output,
    /// What becomes of files that belong to it.
    pub(crate) existing: Existing,
}

/// Who waits for another run.
pub(crate) struct Waiting<'w> {
    /// Told once.
    pub(crate) tell: &'w dyn Fn(),
    /// Whether to wait no longer.
    pub(crate) is_stopped: &'w dyn Fn() -> bool,
}

/// Claims an output. With the record of a run that resumes, waits for another run that has claimed it, and replaces outputs
/// of ours that were made with other options or from another input.
pub(crate) fn claim(
    job: &Job,
    existing: Existing,
    resume: Option<&OutputRecord>,
    waiting: &Waiting<'_>,
) -> Result<Claim, OutputError> {
    let or_replace = |replace: bool| match replace {
        true => Existing::Replace,
        false => existing,
    };
    let Some(record) = resume else {
        let output = begin(&job.out, or_replace(job.parts))?;
        return Ok(Claim::Ours(Claimed { output, existing }));
    };
    let mut told = false;
    loop {
        let before = Stamp::of(&job.out);
        let mut state = record.state_of(job);
        if before.is_some() && !state.is_ours() {
            // Perhaps another run's, which has recorded it.
            record.read();
            state = record.state_of(job);
        }
        if state.stays() {
            return Ok(Claim::Done);
        }
        match begin(&job.out, or_replace(job.parts || state.is_ours())) {
            Ok(output) if Stamp::of(&job.out) == before => {
                if job.parts {
                    // The name tells nothing of parts that another run has finished meanwhile.
                    record.read();
                    if record.state_of(job).stays() {
                        return Ok(Claim::Done);
                    }
                }
                let existing = or_replace(state.is_ours() || record.knows(job));
                return Ok(Claim::Ours(Claimed { output, existing }));
            }
            // It was finished between the check and the claim.
            Ok(_) => {}
            Err(OutputError::Taken { .. }) => {
                if !told {
                    (waiting.tell)();
                    told = true;
                }
                std::thread::sleep(PATIENCE);
                if (waiting.is_stopped)() {
                    return Ok(Claim::Stopped);
                }
            }
            Err(e) => return Err(e),
        }
    }
}
