//! One file, one run: a cell is claimed before it is read, and may turn out to be done already.

use std::time::Duration;

use super::output::{Output, OutputError, begin};
use super::record::{OutputRecord, Stamp};
use super::targets::Job;
use crate::report::Reporter;

/// Between two looks whether another run is done.
const PATIENCE: Duration = Duration::from_millis(50);

/// What a worker may do with a cell.
pub(crate) enum Claim {
    /// Make it, into this.
    Ours(Output),
    /// Leave it: another run has made it meanwhile.
    Done,
}

/// Claims an output. With `--resume` (`made` and `resume`) another run that has it is waited for, and
/// what we made ourselves of other options or another input is replaced.
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
            // It was finished between the look and the claim.
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
