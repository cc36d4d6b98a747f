//! Claims of outputs, so that several runs can share a folder: a cell is claimed before it is read,
//! and may turn out to be done already.

use std::time::Duration;

use super::output::{Output, OutputError, begin};
use super::record::{OutputRecord, Stamp};
use super::targets::Job;
use crate::report::Reporter;

/// Time between checks whether another run is done.
const PATIENCE: Duration = Duration::from_millis(50);

/// What a worker may do with a cell.
pub(crate) enum Claim {
    /// Write it.
    Ours(Claimed),
    /// Keep it: another run has written it meanwhile.
    Done,
}

/// What may be written.
pub(crate) struct Claimed {
    /// The file; one that is written in parts only holds its name meanwhile.
    pub(crate) output: Output,
    /// Whether files that belong to it may be replaced.
    pub(crate) replace: bool,
}

/// Claims an output. With `--resume` (`made` and `resume`), waits for another run that has claimed
/// it, and replaces outputs of ours that were made with other options or from another input.
pub(crate) fn claim(
    job: &Job,
    force: bool,
    resume: Option<&OutputRecord>,
    reporter: &Reporter,
) -> Result<Claim, OutputError> {
    let Some(record) = resume else {
        let output = begin(&job.out, force || job.parts)?;
        return Ok(Claim::Ours(Claimed {
            output,
            replace: force,
        }));
    };
    let mut announced = false;
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
        match begin(&job.out, force || job.parts || state.is_ours()) {
            Ok(output) if Stamp::of(&job.out) == before => {
                if job.parts {
                    // The name tells nothing of parts that another run has finished meanwhile.
                    record.read();
                    if record.state_of(job).stays() {
                        return Ok(Claim::Done);
                    }
                }
                let replace = force || state.is_ours() || record.knows(job);
                return Ok(Claim::Ours(Claimed { output, replace }));
            }
            // It was finished between the check and the claim.
            Ok(_) => {}
            Err(OutputError::Taken { path }) => {
                if !announced {
                    let path = path.display();
                    reporter.note(&format!("{path} is being written by another run: waiting"));
                    announced = true;
                }
                std::thread::sleep(PATIENCE);
            }
            Err(e) => return Err(e),
        }
    }
}
