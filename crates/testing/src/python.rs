//! The Python environment, in which other people's readers check our files.

use std::path::PathBuf;
use std::process::Command;

use crate::workspace;

/// An interpreter that can import a module: the one that `NEUROTESS_PYTHON` names, or that of the
/// workspace's environment.
///
/// # Errors
/// Where there is no interpreter, or it lacks the module.
pub fn python_with(module: &str) -> Result<PathBuf, String> {
    let python = interpreter()?;
    let import = format!("import {module}");
    let output = Command::new(&python).args(["-c", &import]).output();
    if output.is_ok_and(|output| output.status.success()) {
        return Ok(python);
    }
    Err(format!("{} cannot import {module}", python.display()))
}

fn interpreter() -> Result<PathBuf, String> {
    if let Some(named) = std::env::var_os("NEUROTESS_PYTHON") {
        return Ok(named.into());
    }
    let inner = if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    };
    let own = workspace().join(".venv").join(inner);
    let missing = "no Python environment (.venv): cargo xtask setup makes it";
    own.exists()
        .then_some(own)
        .ok_or_else(|| missing.to_owned())
}
