//! `cargo xtask gpu-bundle`: a folder with all that a machine with graphics hardware needs beside its driver.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::json;
use walkdir::WalkDir;

use super::run::MADE;
use crate::demo;
use crate::programs;
use crate::steps::{self, Steps, output, root, target_folder};

/// Where it is written.
const FOLDER: &str = "out/gpu-bundle";
/// Most bytes of it: it travels to machines that are lent for minutes.
const MAX_BYTES: u64 = 55_000_000;

/// Debian's packages of libraries: the Vulkan loader, and what NVIDIA's driver loads, which containers may lack. Each is
/// used only where the system has no library of its name.
const LIBRARIES: &[&str] = &[
    "libvulkan1",
    "libglvnd0",
    "libegl1",
    "libglx0",
    "libx11-6",
    "libxext6",
    "libxcb1",
    "libxau6",
    "libxdmcp6",
    "libbsd0",
    "libmd0",
];

/// What tests and pictures read, from the workspace.
const FILES: &[&str] = &[
    "samples/pyramidal.swc",
    "samples/purkinje.swc",
    "samples/star.swc",
    "samples/granule.swc",
    "samples/basket.swc",
    "samples/motor.swc",
    "crates/render/tests/golden",
    "LICENSE-MIT",
    "LICENSE-APACHE",
];

/// Runs the command.
pub(crate) fn run() -> anyhow::Result<()> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        bail!("the bundle is for Linux on x86-64, and made there");
    }
    let folder = root().join(FOLDER);
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| FOLDER.to_owned())?;
    }
    fs::create_dir_all(&folder).with_context(|| FOLDER.to_owned())?;
    let mut steps = Steps::default();
    steps.step("program", || program(&folder))?;
    steps.step("tests", || tests(&folder))?;
    steps.step("runner", || runner(&folder))?;
    steps.step("libraries", || libraries(&folder))?;
    steps.step("files", || files(&folder))?;
    steps.step("size", || size(&folder))?;
    steps.summary();
    println!(
        "\nCopy {FOLDER} to a machine with graphics hardware and start run.sh there; --help lists its options."
    );
    println!(
        "Its results/result.json then goes into benchmarks/gpu.md: cargo xtask gpu-page result.json"
    );
    Ok(())
}

fn program(folder: &Path) -> anyhow::Result<String> {
    demo::build()?;
    let from = target_folder()?.join("release/neurotess");
    strip(&from, &folder.join("neurotess"))
}

/// The test program of the renderer: parity, cracks, ids, static pictures, exploration, streaming.
fn tests(folder: &Path) -> anyhow::Result<String> {
    let built =
        programs::executable("test --locked --no-run --package neurotess-render --test it")?;
    strip(&built, &folder.join("graphics-tests"))
}

fn runner(folder: &Path) -> anyhow::Result<String> {
    let script = folder.join("run.sh");
    fs::write(&script, include_str!("run.sh"))?;
    steps::run(Command::new("chmod").arg("+x").arg(&script))?;
    let commit = output(
        Command::new("git")
            .current_dir(root())
            .args(["describe", "--always", "--dirty"]),
    )?;
    let made = json!({ "version": env!("CARGO_PKG_VERSION"), "commit": commit.trim() });
    fs::write(folder.join(MADE), made.to_string())?;
    // This program as it runs: Cargo may have built another in its place meanwhile.
    let own = folder.join("xtask");
    fs::copy("/proc/self/exe", &own).context("this program")?;
    strip(&own, &own)
}

/// Copies a program without its symbols.
fn strip(from: &Path, to: &Path) -> anyhow::Result<String> {
    // Who links has it: it comes with the linker.
    steps::run(Command::new("strip").arg("-o").arg(to).arg(from))?;
    Ok(format!("{:.1} MB", fs::metadata(to)?.len() as f64 / 1e6))
}

/// The libraries, each package in a folder with its license.
fn libraries(folder: &Path) -> anyhow::Result<String> {
    let packages = target_folder()?.join("gpu-bundle/packages");
    fs::create_dir_all(&packages)?;
    for name in LIBRARIES {
        let package = match package(&packages, name)? {
            Some(package) => package,
            None => download(&packages, name)?,
        };
        let unpacked = packages.join(name);
        steps::run(
            Command::new("dpkg-deb")
                .arg("-x")
                .args([&package, &unpacked]),
        )?;
        let to = folder.join("libraries").join(name);
        fs::create_dir_all(&to)?;
        for entry in WalkDir::new(&unpacked) {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = entry.path();
            // Links to libraries have the names by which they are loaded; what they point to is copied.
            if name.contains(".so.")
                && path.metadata().is_ok_and(|data| data.is_file())
                && is_loaded(&name)
            {
                fs::copy(path, to.join(&name)).with_context(|| path.display().to_string())?;
            }
            if name == "copyright" {
                let licenses = folder.join("licenses");
                fs::create_dir_all(&licenses)?;
                fs::copy(path, licenses.join(to.file_name().unwrap_or_default()))?;
            }
        }
    }
    Ok(format!("{} of Debian's packages", LIBRARIES.len()))
}

/// Whether it is the name that programs load: `libvulkan.so.1`, not `libvulkan.so.1.3.239`.
fn is_loaded(name: &str) -> bool {
    let version = name.rsplit_once(".so.").map_or("", |(_, version)| version);
    !version.contains('.')
}

/// The file of a package that was downloaded before.
fn package(packages: &Path, name: &str) -> anyhow::Result<Option<PathBuf>> {
    let start = format!("{name}_");
    for entry in fs::read_dir(packages)? {
        let path = entry?.path();
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        if file.starts_with(&start) && file.ends_with(".deb") {
            return Ok(Some(path));
        }
    }
    Ok(None)
}

fn download(packages: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let mut download = Command::new("apt-get");
    download
        .current_dir(packages)
        .args(["-qq", "download", name]);
    if steps::run(&mut download).is_err() {
        // A machine that was just made has no lists of packages.
        crate::setup::apt(&["update", "-qq"])?;
        steps::run(&mut download)
            .context("the bundle takes the Vulkan loader from Debian's packages")?;
    }
    package(packages, name)?.with_context(|| format!("the package {name}"))
}

fn files(folder: &Path) -> anyhow::Result<String> {
    for name in FILES {
        let from = root().join(name);
        for entry in WalkDir::new(&from) {
            let entry = entry?;
            let to = folder.join(name).join(entry.path().strip_prefix(&from)?);
            // Joining with nothing ends in a slash.
            let to: PathBuf = to.components().collect();
            if entry.file_type().is_dir() {
                continue;
            }
            fs::create_dir_all(to.parent().context("a folder")?)?;
            fs::copy(entry.path(), &to).with_context(|| (*name).to_owned())?;
        }
    }
    Ok("samples, golden pictures, licenses".into())
}

fn size(folder: &Path) -> anyhow::Result<String> {
    let mut bytes = 0;
    for entry in WalkDir::new(folder) {
        let entry = entry?;
        if entry.file_type().is_file() {
            bytes += entry.metadata()?.len();
        }
    }
    let megabytes = |bytes: u64| bytes as f64 / 1e6;
    if bytes > MAX_BYTES {
        bail!(
            "{:.1} MB: {:.0} may be",
            megabytes(bytes),
            megabytes(MAX_BYTES)
        );
    }
    Ok(format!("{:.1} MB", megabytes(bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_have_the_names_that_programs_load() {
        let loaded = [
            "libvulkan.so.1",
            "libvulkan.so.1.3.239",
            "libX11.so.6",
            "libX11-xcb.so.1",
        ];
        assert_eq!(loaded.map(is_loaded), [true, false, true, true]);
    }
}
