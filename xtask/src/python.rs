//! The Python environment `.venv`, in which other people's readers check our files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::Context;

use crate::steps::{root, run};

/// Makes `.venv` with `tests/python/requirements.txt`, unless it is there; says how it is.
pub(crate) fn set_up() -> anyhow::Result<String> {
    let wanted = root().join("tests/python/requirements.txt");
    let wanted = fs::read_to_string(&wanted).context("tests/python/requirements.txt")?;
    let venv = root().join(".venv");
    let stamp = venv.join("requirements.stamp");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok("the Python environment is there".into());
    }
    let Some(python) = interpreter() else {
        return Ok("no Python 3 here: checks by other readers will be skipped".into());
    };
    if let Err(e) = install(python, &venv) {
        // Without the packages the tests say that they skip; all else can be checked.
        println!("   {e:#}");
        return Ok(
            "Python packages cannot be installed: checks by other readers are skipped".into(),
        );
    }
    fs::write(&stamp, &wanted).context("cannot write .venv/requirements.stamp")?;
    Ok("made the Python environment in .venv".into())
}

fn install(python: &str, venv: &Path) -> anyhow::Result<()> {
    let own = own_interpreter(venv);
    if !own.exists() {
        run(Command::new(python)
            .args(["-m", "venv", ".venv"])
            .current_dir(root()))?;
    }
    run(Command::new(own)
        .args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
        ])
        .args(["-r", "tests/python/requirements.txt"])
        .current_dir(root()))
}

fn interpreter() -> Option<&'static str> {
    let version = "import sys; sys.exit(sys.version_info < (3, 9))";
    ["python3", "python"].into_iter().find(|python| {
        let status = Command::new(python)
            .args(["-c", version])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        status.is_ok_and(|status| status.success())
    })
}

fn own_interpreter(venv: &Path) -> PathBuf {
    let inner = if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    };
    // A link to the system's interpreter: it must be called by this very path.
    fs::canonicalize(venv)
        .unwrap_or_else(|_| venv.to_path_buf())
        .join(inner)
}
