//! Rust's standard library for WebAssembly, which a page's core needs: rustup's, or one that is compiled once from
//! Debian's sources of the same version, where rustup's servers are out of reach.
//!
//! The compiler stays as it is: it is told of the library's folder by `--sysroot`, which no build script and no macro
//! sees, since Cargo gives flags to the target's crates alone.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, bail};

use crate::steps::{cargo, output, run, target_folder};

/// What it is compiled for.
pub(crate) const TARGET: &str = "wasm32-unknown-unknown";

/// Debian's release that has the library's sources of several versions of the compiler.
const SUITE: &str = "trixie-backports";
/// The package of them.
const PACKAGE: &str = "rust-src";
/// The file in the library's folder that says that it is whole.
const MARK: &str = "complete";

/// What to do where there is none.
pub(crate) const BY_HAND: &str = "run rustup target add wasm32-unknown-unknown";

/// Where the library is.
pub(crate) enum Library {
    /// With the compiler.
    Installed,
    /// In a folder like the compiler's.
    Own(PathBuf),
}

impl Library {
    /// The library, if there is one for this compiler.
    pub(crate) fn find() -> anyhow::Result<Option<Self>> {
        let sysroot = output(Command::new(rustc()).args(["--print", "sysroot"]))?;
        if has_library(Path::new(sysroot.trim())) {
            return Ok(Some(Self::Installed));
        }
        let own = own_folder()?;
        let is_there = own.join(MARK).exists();
        Ok(is_there.then_some(Self::Own(own)))
    }

    /// Cargo for the target.
    pub(crate) fn cargo(&self, arguments: &str) -> Command {
        let mut command = cargo(arguments);
        command.args(["--target", TARGET]);
        if let Self::Own(folder) = self {
            let mut flag = OsString::from("--sysroot=");
            flag.push(folder);
            // This one is heeded before all others.
            command.env("CARGO_ENCODED_RUSTFLAGS", flag);
        }
        command
    }
}

/// Makes the library if there is none; says how it is. Never fails: all else works without it, and what needs it is
/// skipped.
pub(crate) fn set_up() -> String {
    let what = "Rust's library for WebAssembly";
    match Library::find() {
        Ok(Some(_)) => return format!("{what} is there"),
        Ok(None) => {}
        Err(e) => return format!("{what} is not looked for: {e:#}"),
    }
    match compile() {
        Ok(version) => format!("compiled {what} from Debian's sources of {version}"),
        Err(e) => {
            println!("   {e:#}");
            format!(
                "{what} is missing: {BY_HAND} to make the page that takes tracings; its tests are skipped"
            )
        }
    }
}

/// Compiles the library. Says of which version.
fn compile() -> anyhow::Result<String> {
    let own = own_folder()?;
    let work = own.with_extension("work");
    if work.exists() {
        fs::remove_dir_all(&work)?;
    }
    fs::create_dir_all(&work)?;
    let version = version()?;
    let sources = sources(&work, &version)?;
    // The libraries that std is made of may use what stable crates may not, as Cargo says when it builds them itself.
    let mut build = Command::new(cargo("").get_program());
    build
        .args(["build", "--release", "--locked", "--target", TARGET])
        .args(["-p", "std", "-p", "panic_abort", "-p", "proc_macro"])
        .current_dir(&sources)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_TARGET_DIR", work.join("target"))
        // With bitcode, which links of whole programs need.
        .env(
            "CARGO_ENCODED_RUSTFLAGS",
            "-Zforce-unstable-if-unmarked\u{1f}-Cembed-bitcode=yes",
        );
    run(&mut build)?;
    let built = work.join("target").join(TARGET).join("release/deps");
    let library = libraries(&own);
    if own.exists() {
        fs::remove_dir_all(&own)?;
    }
    fs::create_dir_all(&library)?;
    for entry in fs::read_dir(&built).context("what was built")? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "rlib") {
            let name = path.file_name().context("a file's name")?;
            fs::copy(&path, library.join(name))?;
        }
    }
    fs::write(own.join(MARK), "")?;
    fs::remove_dir_all(&work)?;
    Ok(version)
}

/// Fetches and unpacks the sources of a version, by apt with lists of its own: the system's stay as they are.
fn sources(work: &Path, version: &str) -> anyhow::Result<PathBuf> {
    let mirror = mirror()?;
    for folder in ["parts", "lists/partial", "cache/archives/partial"] {
        fs::create_dir_all(work.join(folder))?;
    }
    let list = format!("deb {mirror} {SUITE} main\n");
    fs::write(work.join("sources.list"), list)?;
    let apt = |arguments: &[&str]| {
        let mut apt = Command::new("apt-get");
        for (option, folder) in [
            // None beside the one below.
            ("Dir::Etc::sourceparts", "parts"),
            ("Dir::State::lists", "lists"),
            ("Dir::Cache", "cache"),
        ] {
            let mut value = OsString::from(format!("{option}="));
            value.push(work.join(folder));
            apt.arg("-o").arg(value);
        }
        let mut file = OsString::from("Dir::Etc::sourcelist=");
        file.push(work.join("sources.list"));
        apt.arg("-o").arg(file).arg("-qq").args(arguments);
        run(apt.current_dir(work))
    };
    apt(&["update"])?;
    apt(&["download", &format!("{PACKAGE}={version}+*")])?;
    let found = fs::read_dir(work)?.filter_map(Result::ok);
    let package = found
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|e| e == "deb"));
    let package = package.context("apt-get has fetched no package")?;
    let unpacked = work.join("unpacked");
    run(Command::new("dpkg-deb")
        .arg("-x")
        .arg(&package)
        .arg(&unpacked))?;
    Ok(unpacked.join(format!("usr/src/rustc-{version}/library")))
}

/// The server that this system has Debian's packages from.
fn mirror() -> anyhow::Result<String> {
    let mut targets = Command::new("apt-get");
    targets.args(["indextargets", "--format", "$(ORIGIN) $(REPO_URI)"]);
    let listed = targets.stderr(Stdio::null()).output();
    let listed = listed.context("this system has no apt-get")?;
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let mut of_debian = listed
        .lines()
        .filter_map(|line| line.strip_prefix("Debian "));
    let main = of_debian.find(|uri| !uri.contains("security"));
    match main {
        Some(uri) => Ok(uri.trim().to_owned()),
        None => bail!("this system is not Debian, or apt-get update has not been run"),
    }
}

/// The compiler's version, as in 1.95.0.
fn version() -> anyhow::Result<String> {
    let said = output(Command::new(rustc()).arg("--version"))?;
    let version = said.split_whitespace().nth(1);
    Ok(version.context("rustc's version")?.to_owned())
}

/// Where the library of this compiler is that is not rustup's: libraries of another commit cannot be used.
fn own_folder() -> anyhow::Result<PathBuf> {
    let said = output(Command::new(rustc()).arg("-vV"))?;
    let commit = said
        .lines()
        .find_map(|line| line.strip_prefix("commit-hash: "));
    let name = commit.unwrap_or("unknown").trim().to_owned();
    Ok(target_folder()?.join("wasm-library").join(name))
}

fn libraries(sysroot: &Path) -> PathBuf {
    sysroot.join("lib/rustlib").join(TARGET).join("lib")
}

fn has_library(sysroot: &Path) -> bool {
    let entries = fs::read_dir(libraries(sysroot)).ok();
    let mut names = entries.into_iter().flatten().filter_map(Result::ok);
    names.any(|entry| entry.file_name().to_string_lossy().starts_with("libstd"))
}

/// The compiler that Cargo calls.
fn rustc() -> OsString {
    std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())
}
