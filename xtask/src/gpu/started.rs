//! Programs of the bundle: each is started in the bundle's folder, writes nowhere else, and is ended when its time is
//! over.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::Context;

use super::results::Ended;

/// Where programs are and write.
pub(super) struct Place {
    /// The bundle's folder.
    pub(super) bundle: PathBuf,
    /// What is deleted at the end: caches, temporary files.
    pub(super) work: PathBuf,
    /// Results.
    pub(super) out: PathBuf,
    /// A part of the adapter's name.
    pub(super) adapter: Option<String>,
}

/// Variables of folders that programs and drivers write to: caches of shaders among them, by Mesa and by NVIDIA.
pub(super) const CACHES: [&str; 8] = [
    "HOME",
    "TMPDIR",
    "XDG_CACHE_HOME",
    "XDG_CONFIG_HOME",
    "XDG_DATA_HOME",
    "XDG_RUNTIME_DIR",
    "MESA_SHADER_CACHE_DIR",
    "__GL_SHADER_DISK_CACHE_PATH",
];

/// How a program ended, and what it printed.
pub(super) struct Program {
    pub(super) printed: String,
    pub(super) how: Ended,
    pub(super) why: String,
}

impl Place {
    pub(super) fn program(&self, name: &str) -> PathBuf {
        self.bundle.join(name)
    }

    /// Runs a program for so long at most. Its end is up to coreutils' `timeout`, which ends all processes that the
    /// program started, too, and does so also where this one was killed.
    pub(super) fn start(
        &self,
        program: &Path,
        arguments: &[&str],
        variables: &[(&str, &str)],
        most: Duration,
    ) -> anyhow::Result<Program> {
        let log = self.out.join("log.txt");
        let errors = File::options().create(true).append(true).open(&log)?;
        let most = most.as_secs_f64().max(0.1);
        let mut command = Command::new("timeout");
        command
            .args(["--kill-after=2", &format!("{most:.1}")])
            .arg(program)
            .args(arguments)
            .current_dir(&self.bundle)
            .stdin(Stdio::null())
            .stderr(errors)
            .env("NO_COLOR", "1")
            .env("NEUROTESS_WORKSPACE", &self.bundle);
        let cache = self.work.join("cache");
        for name in CACHES {
            command.env(name, &cache);
        }
        if let Some(adapter) = &self.adapter {
            command.env("NEUROTESS_ADAPTER", adapter);
        }
        command.envs(variables.iter().copied());
        let output = command.output().context("timeout, of coreutils")?;
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        let how = match output.status.code() {
            Some(0) => Ended::Well,
            // 124: it was ended; 137: it had to be killed, be it by somebody else.
            Some(124) => Ended::TooLate,
            _ => Ended::Failed,
        };
        let why = match how {
            Ended::Well => String::new(),
            Ended::TooLate => format!("ended after {most:.0} s"),
            Ended::Failed => format!("{}{}", output.status, last_line(&log)),
        };
        Ok(Program { printed, how, why })
    }
}

/// The last line that says something, after a colon.
fn last_line(log: &Path) -> String {
    let text = fs::read(log).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let line = text.lines().rfind(|line| !line.trim().is_empty());
    let line: Option<String> = line.map(|line| line.trim().chars().take(300).collect());
    line.map_or(String::new(), |line| format!(": {line}"))
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::time::Instant;

    use super::*;

    /// A folder of its own.
    fn trial(name: &str) -> Place {
        let bundle = crate::steps::root().join("target/gpu-run").join(name);
        let place = Place {
            work: bundle.join("work"),
            out: bundle.join("results"),
            adapter: None,
            bundle,
        };
        for folder in [place.work.join("cache"), place.out.clone()] {
            fs::create_dir_all(folder).expect("a folder");
        }
        place
    }

    fn shell(place: &Place, script: &str) -> Program {
        let most = Duration::from_millis(500);
        place
            .start(Path::new("sh"), &["-c", script], &[], most)
            .expect("started")
    }

    #[test]
    fn what_takes_too_long_is_ended_with_all_that_it_started() {
        let place = trial("late");
        let clock = Instant::now();
        let ended = shell(&place, "echo begun; sleep 600 & sleep 600");
        assert_eq!(
            (ended.how, ended.printed.as_str()),
            (Ended::TooLate, "begun\n")
        );
        // Whoever still holds the pipe would make this wait.
        assert!(clock.elapsed() < Duration::from_secs(60));
    }

    #[test]
    fn what_fails_or_is_killed_says_why() {
        let place = trial("failed");
        let failed = shell(&place, "echo some trouble >&2; exit 3");
        assert_eq!(failed.how, Ended::Failed);
        assert!(failed.why.contains("some trouble"), "{}", failed.why);
        assert_eq!(shell(&place, "kill -KILL $$").how, Ended::Failed);
        assert_eq!(shell(&place, "exit 0").how, Ended::Well);
    }

    #[test]
    fn folders_of_caches_are_the_bundle_s() {
        let place = trial("caches");
        let printed = shell(&place, "echo $HOME; echo $TMPDIR; echo $XDG_CACHE_HOME").printed;
        let cache = place.work.join("cache").display().to_string();
        assert!(printed.lines().all(|folder| folder == cache), "{printed}");
    }
}
