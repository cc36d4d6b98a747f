//! `cargo xtask wheel`: the Python package as a wheel that needs no Rust, and a look at whether it works
//! where nothing else is.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};

use crate::python::{self, WHEEL};
use crate::steps::{Steps, output, root, run};
use crate::third_party;

/// The file of others' licenses, beside ours, which maturin puts into the wheel with them.
const LICENSES: &str = "bindings/python/LICENSE-THIRD-PARTY.txt";

/// The largest wheel (bytes) that is fetched without a thought.
const MAX_BYTES: u64 = 20 << 20;

/// What a fresh environment must be able to do.
const TRIAL: &str = "
import sys, time
start = time.perf_counter()
import neurotess as nt
took = time.perf_counter() - start
assert 'numpy' not in sys.modules
mesh = nt.mesh(nt.synth('granule', points=100), level=2)
assert mesh.closed and mesh.check()['closed']
try:
    drawn = nt.render(nt.synth('granule', points=100), size=(64, 48), legend=False)
except nt.RenderError as error:
    drawn = error
import importlib.metadata
files = [str(file) for file in importlib.metadata.files('neurotess')]
licenses = [file for file in files if 'licenses/' in file]
assert len([file for file in licenses if file.endswith(('-MIT', '-APACHE', '-THIRD-PARTY.txt'))]) == 3, licenses
print(f'import in {1e3 * took:.1f} ms; {mesh}; picture: {drawn}')
";

/// Runs the command; with `from_source` it also installs the package as users with Rust do.
pub(crate) fn run_all(from_source: bool) -> anyhow::Result<()> {
    let mut steps = Steps::default();
    let folder = root().join("out/wheel");
    steps.step("setup", || python::set_up(&WHEEL))?;
    let Some(python) = python::interpreter(&WHEEL) else {
        bail!("wheels are made by Python 3.10 or newer with maturin, which could not be installed");
    };
    steps.step("licenses", || {
        let licenses = third_party::collect(&third_party::PYTHON)?;
        fs::write(root().join(LICENSES), &licenses.text).context(LICENSES)?;
        Ok(format!("of {} packages, in {LICENSES}", licenses.count))
    })?;
    let mut wheel = PathBuf::new();
    steps.step("wheel", || {
        wheel = build(&python, &folder)?;
        let bytes = fs::metadata(&wheel)?.len();
        if bytes > MAX_BYTES {
            bail!(
                "{} has {bytes} bytes, more than {MAX_BYTES}",
                wheel.display()
            );
        }
        Ok(format!(
            "{} ({:.1} MB)",
            wheel.display(),
            bytes as f64 / 1e6
        ))
    })?;
    steps.step("trial", || trial(&python, &wheel, &folder.join("venv")))?;
    if from_source {
        let sources = root().join("bindings/python");
        steps.step("from source", || {
            trial(&python, &sources, &folder.join("venv-from-source"))
        })?;
    }
    steps.summary();
    Ok(())
}

/// Builds the wheel; for Linux by zig, which links with an old C library, so that it runs on most systems.
fn build(python: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    let mut maturin = Command::new(python);
    maturin.args(["-m", "maturin", "build", "--release", "--locked"]);
    if cfg!(target_os = "linux") {
        maturin.args(["--zig", "--compatibility", "manylinux_2_17"]);
    }
    maturin.arg("--out").arg(folder);
    // maturin looks for zig beside the interpreter's other programs.
    let programs = python.parent().context("an interpreter's folder")?;
    let mut path = OsString::from(programs);
    if let Some(others) = std::env::var_os("PATH") {
        path.push(if cfg!(windows) { ";" } else { ":" });
        path.push(others);
    }
    run(maturin
        .current_dir(root().join("bindings/python"))
        .env("PATH", path))?;
    let made = fs::read_dir(folder)?.filter_map(Result::ok);
    let wheel = made
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|e| e == "whl"));
    wheel.context("maturin made no wheel")
}

/// Installs a wheel, or sources, into a fresh environment and uses the package, where no other program is.
fn trial(python: &Path, package: &Path, venv: &Path) -> anyhow::Result<String> {
    let own = python::make(python, venv)?;
    run(python::pip_install(&own).arg(package))?;
    let programs = own.parent().context("an interpreter's folder")?;
    let mut used = Command::new(&own);
    used.args(["-c", TRIAL]).current_dir(venv).env_clear();
    let said = output(&mut used)?;
    let version = output(
        Command::new(programs.join("neurotess"))
            .arg("--version")
            .env_clear(),
    )?;
    Ok(format!("{}; command: {}", said.trim(), version.trim()))
}
