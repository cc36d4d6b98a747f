//! Python environments: `.venv`, in which our package is tested and, in the full lane, other people's readers check
//! our files,
//! `.venv-bench`, in which other people's tools are timed beside ours, and `.venv-wheel`, which makes wheels.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::Context;

use crate::lane::Lane;
use crate::steps::{root, run};

/// An environment: its folder, and the list of packages in it.
pub(crate) struct Environment {
    folder: &'static str,
    packages: &'static str,
}

/// What the package's own tests need.
const OWN_TESTS: Environment = Environment {
    folder: ".venv",
    packages: "tests/python/requirements.txt",
};

/// The same with other people's readers, generators, solvers.
const ALL_TESTS: Environment = Environment {
    folder: ".venv",
    packages: "tests/python/requirements-full.txt",
};

/// The environment of a lane's tests.
pub(crate) fn of_tests(lane: Lane) -> &'static Environment {
    match lane {
        Lane::Quick => &OWN_TESTS,
        Lane::Full => &ALL_TESTS,
    }
}

/// Where benchmarks find other people's tools.
pub(crate) const BENCHMARKS: Environment = Environment {
    folder: ".venv-bench",
    packages: "benchmarks/requirements.txt",
};

/// Where wheels are made.
pub(crate) const WHEEL: Environment = Environment {
    folder: ".venv-wheel",
    packages: "bindings/python/requirements-wheel.txt",
};

/// Makes an environment with its packages, unless it is there; says how it is.
pub(crate) fn set_up(environment: &Environment) -> anyhow::Result<String> {
    let wanted = list(&root().join(environment.packages))?;
    let stamp = stamp(environment);
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok("the Python environment is there".into());
    }
    let Some(python) = system_interpreter() else {
        return Ok("no Python 3 here: what needs it will be skipped".into());
    };
    if let Err(e) = install(python, environment) {
        // Without the packages the tests say that they skip; all else can be checked.
        println!("   {e:#}");
        return Ok("Python packages cannot be installed: what needs them is skipped".into());
    }
    fs::write(&stamp, &wanted).with_context(|| format!("cannot write {}", stamp.display()))?;
    Ok(format!(
        "made the Python environment in {}",
        environment.folder
    ))
}

/// The environment's own interpreter, where the environment is complete.
pub(crate) fn interpreter(environment: &Environment) -> Option<PathBuf> {
    let folder = root().join(environment.folder);
    stamp(environment)
        .exists()
        .then(|| own_interpreter(&folder))
}

/// A list of packages, with those that it includes (`-r other.txt`): what changes in these is installed, too.
fn list(file: &Path) -> anyhow::Result<String> {
    let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
    let mut whole = text.clone();
    for other in text.lines().filter_map(|line| line.strip_prefix("-r ")) {
        whole += &list(&file.with_file_name(other))?;
    }
    Ok(whole)
}

/// A file that holds the list of packages once they are installed.
fn stamp(environment: &Environment) -> PathBuf {
    let list = Path::new(environment.packages).with_extension("stamp");
    let name = list.file_name().unwrap_or_default();
    root().join(environment.folder).join(name)
}

fn install(python: &str, environment: &Environment) -> anyhow::Result<()> {
    let own = make(Path::new(python), &root().join(environment.folder))?;
    run(pip_install(&own)
        .args(["-r", environment.packages])
        .current_dir(root()))
}

/// Makes a virtual environment, unless it is there; returns its own interpreter.
pub(crate) fn make(python: &Path, venv: &Path) -> anyhow::Result<PathBuf> {
    if !own_interpreter(venv).exists() {
        run(Command::new(python).args(["-m", "venv"]).arg(venv))?;
    }
    Ok(own_interpreter(venv))
}

/// `pip install`, without what to install.
pub(crate) fn pip_install(own: &Path) -> Command {
    let mut command = Command::new(own);
    command.args(["-m", "pip", "install", "--quiet"]);
    command.arg("--disable-pip-version-check");
    command
}

fn system_interpreter() -> Option<&'static str> {
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
