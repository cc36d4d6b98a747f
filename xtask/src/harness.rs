//! Which harness runs the tests of a program: libtest, or that of `neurotess-testing`. A test of the other
//! kind would compile and never run; this finds it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use crate::steps::root;

/// Registers a test with our harness.
const OURS: &str = "#[neurotess_testing::test";
/// Registers a test with libtest.
const LIBTEST: &str = "#[test]";
/// Runs our harness.
const MAIN: &str = "neurotess_testing::main!";

/// A program of tests: its root file, and whether Cargo has libtest run it.
#[derive(Debug, PartialEq, Eq)]
struct Program {
    root: PathBuf,
    libtest: bool,
}

/// An error that names each test that would never run.
pub(crate) fn check() -> anyhow::Result<String> {
    let mut faults = Vec::new();
    let (mut programs, mut ours) = (0, 0);
    for parent in ["crates", "apps"] {
        for package in fs::read_dir(root().join(parent)).context(parent)? {
            let package = package?.path();
            let manifest = package.join("Cargo.toml");
            if !manifest.is_file() {
                continue;
            }
            let manifest = fs::read_to_string(manifest)?;
            for program in programs_of(&package, &manifest)? {
                programs += 1;
                ours += u32::from(!program.libtest);
                faults.extend(faults_of(&program)?);
            }
        }
    }
    if !faults.is_empty() {
        faults.sort();
        bail!("{}", faults.join("\n"));
    }
    Ok(format!(
        "{programs} test programs, {ours} of them with our harness: no test is left out"
    ))
}

/// The programs in the folder `tests` of a package.
fn programs_of(package: &Path, manifest: &str) -> anyhow::Result<Vec<Program>> {
    let manifest: toml::Table = manifest.parse().context("a manifest")?;
    let tests = package.join("tests");
    let mut programs = Vec::new();
    let listed = manifest.get("test").and_then(toml::Value::as_array);
    for test in listed.into_iter().flatten() {
        let name = test.get("name").and_then(toml::Value::as_str);
        let name = name.context("a [[test]] without a name")?;
        let path = test.get("path").and_then(toml::Value::as_str);
        let file = tests.join(name).with_extension("rs");
        let root = match path {
            Some(path) => package.join(path),
            None if file.is_file() => file,
            None => tests.join(name).join("main.rs"),
        };
        let harness = test.get("harness").and_then(toml::Value::as_bool);
        programs.push(Program {
            root,
            libtest: harness.unwrap_or(true),
        });
    }
    // Those that Cargo finds by itself.
    for entry in fs::read_dir(&tests).into_iter().flatten() {
        let path = entry?.path();
        let root = if path.is_dir() {
            path.join("main.rs")
        } else {
            path
        };
        let is_root = root.is_file() && root.extension().is_some_and(|end| end == "rs");
        if is_root && programs.iter().all(|program| program.root != root) {
            let libtest = true;
            programs.push(Program { root, libtest });
        }
    }
    Ok(programs)
}

fn faults_of(program: &Program) -> anyhow::Result<Vec<String>> {
    let root_file = &program.root;
    let mut faults = Vec::new();
    for file in files_of(root_file)? {
        let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        let is_root = file == *root_file;
        let place = file.strip_prefix(root()).unwrap_or(&file).display();
        let faults_here = faults_in(&text, is_root, program.libtest);
        faults.extend(faults_here.map(|fault| format!("{place}{fault}")));
    }
    Ok(faults)
}

/// Faults of one file, each after its line.
fn faults_in(text: &str, is_root: bool, libtest: bool) -> impl Iterator<Item = String> {
    let begins = |start: &'static str| {
        let lines = (1..).zip(text.lines());
        lines.filter(move |(_, line)| line.trim_start().starts_with(start))
    };
    let wrong = if libtest { OURS } else { LIBTEST };
    let manifest = if libtest { "has no" } else { "has" };
    let why = format!("would never run: the program's [[test]] {manifest} `harness = false`");
    let left_out = begins(wrong).map(|(line, _)| format!(":{line}: {wrong} {why}"));
    let has_main = begins(MAIN).next().is_some();
    let main = match (libtest, has_main) {
        (true, true) => Some(format!(": {MAIN} in a program that libtest runs")),
        (false, false) if is_root => Some(format!(": no {MAIN}, so nothing runs its tests")),
        _ => None,
    };
    left_out.chain(main).collect::<Vec<_>>().into_iter()
}

/// A root file and all modules of it that have files of their own.
fn files_of(root_file: &Path) -> anyhow::Result<BTreeSet<PathBuf>> {
    let mut found = BTreeSet::new();
    let mut open = vec![root_file.to_path_buf()];
    while let Some(file) = open.pop() {
        let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        open.extend(modules(&file, &text, file == root_file));
        found.insert(file);
    }
    Ok(found)
}

/// Files of the modules that a file declares.
fn modules(file: &Path, text: &str, is_root: bool) -> Vec<PathBuf> {
    let folder = file.parent().unwrap_or(file);
    let own = if is_root || file.ends_with("mod.rs") {
        folder.to_path_buf()
    } else {
        file.with_extension("")
    };
    let mut modules = Vec::new();
    let mut path = None;
    for line in text.lines().map(str::trim) {
        let named = line.strip_prefix("#[path = \"");
        if let Some(named) = named.and_then(|rest| rest.strip_suffix("\"]")) {
            path = Some(folder.join(named));
        } else if let Some(name) = declared(line) {
            let flat = own.join(name).with_extension("rs");
            let nested = own.join(name).join("mod.rs");
            let usual = if flat.is_file() { flat } else { nested };
            modules.push(path.take().unwrap_or(usual));
        }
    }
    modules
}

/// The name in `mod name;`.
fn declared(line: &str) -> Option<&str> {
    let (before, name) = line.strip_suffix(';')?.rsplit_once(' ')?;
    ["mod", "pub mod", "pub(crate) mod"]
        .contains(&before)
        .then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str, libtest: bool) -> Vec<String> {
        faults_in(text, true, libtest).collect()
    }

    #[test]
    fn a_test_that_its_harness_does_not_know_is_a_fault() {
        let both =
            "#[test]\nfn a() {}\n\nmod inner {\n    #[neurotess_testing::test(needs(gpu))]\n}\n";
        let with_main = format!("{both}neurotess_testing::main!();\n");
        let [fault] = &faults(&with_main, false)[..] else {
            panic!("one fault");
        };
        assert!(fault.starts_with(":1: #[test] would never run"), "{fault}");
        let [fault] = &faults(both, true)[..] else {
            panic!("one fault");
        };
        assert!(
            fault.starts_with(":5: #[neurotess_testing::test"),
            "{fault}"
        );
        assert_eq!(faults("#[test]\nfn a() {}\n", true), [""; 0]);
    }

    #[test]
    fn main_stands_where_our_harness_runs() {
        assert_eq!(faults("", false).len(), 1);
        assert_eq!(faults("neurotess_testing::main!();", false).len(), 0);
        assert_eq!(faults("neurotess_testing::main!();", true).len(), 1);
    }

    #[test]
    fn every_file_of_a_program_is_found() {
        let here = Path::new("/tests/pictures.rs");
        let text = "mod common;\n#[path = \"common/draw.rs\"]\nmod draw;\nmod inner {\n}\n";
        let files = modules(here, text, true);
        assert_eq!(
            files,
            [
                Path::new("/tests/common/mod.rs"),
                Path::new("/tests/common/draw.rs")
            ]
        );
        let below = modules(
            Path::new("/tests/cli/mesh.rs"),
            "pub(crate) mod cell;",
            false,
        );
        assert_eq!(below, [Path::new("/tests/cli/mesh/cell/mod.rs")]);
    }

    #[test]
    fn this_workspace_leaves_no_test_out() {
        check().expect("no fault");
    }

    #[test]
    fn manifests_say_which_harness_runs() {
        let package = root().join("crates/testing");
        let manifest = "[[test]]\nname = \"harness\"\nharness = false\n";
        let programs = programs_of(&package, manifest).expect("programs");
        let libtest: Vec<bool> = programs.iter().map(|program| program.libtest).collect();
        assert_eq!(libtest, [false]);
        assert!(programs[0].root.ends_with("tests/harness.rs"));
        let programs = programs_of(&package, "").expect("programs");
        assert!(programs[0].libtest);
    }
}
