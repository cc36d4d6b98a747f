//! The command as the host of a drawing.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use neurotess::batch;
use neurotess::drawing::{Host, MeshedCell, Work};
use neurotess::formats::{Read, ReadOptions};

use crate::io::workers;
use crate::report::{Failure, Progress, Reporter, bug};

impl Host for Reporter {
    fn stopped(&self) -> &AtomicBool {
        Self::stopped(self)
    }

    fn warning(&self, message: &str) {
        Self::warning(self, message);
    }

    fn failure(&self, message: &str) {
        Self::failure(self, &Failure(message.to_owned()));
    }

    fn note(&self, message: &str) {
        Self::note(self, message);
    }

    fn is_verbose(&self) -> bool {
        self.verbose()
    }

    fn read(&self, file: &Path, options: &ReadOptions) -> Result<Read, String> {
        batch::read(file, None, options).map_err(|e| e.to_string())
    }

    fn each(&self, files: &[PathBuf], work: Work<'_>) -> Vec<Result<MeshedCell, String>> {
        let progress = Progress::new(self, files.len(), "files");
        let order: Vec<usize> = (0..files.len()).collect();
        let done = workers::run(files, &order, self.threads(), |file| {
            let done = work(file);
            progress.done();
            done
        });
        drop(progress);
        let results = match done {
            Ok(results) => results,
            Err(e) => files.iter().map(|_| Err(e.to_string())).collect(),
        };
        let named = results.into_iter().zip(files).map(|(result, file)| {
            result.unwrap_or_else(|panic| Err(bug(&file.display().to_string(), &panic).0))
        });
        named.collect()
    }
}
