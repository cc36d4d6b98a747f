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
    /// Write it into this output.
    Ours(Output),
    /// Keep it: another run has written it meanwhile.
    Done,
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
        return begin(&job.out, force).map(Claim::Ours);
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
        match begin(&job.out, force || state.is_ours()) {
            Ok(output) if Stamp::of(&job.out) == before => return Ok(Claim::Ours(output)),
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
