//! No test is left out. The programs below `tests/` are run by the harness of `neurotess-testing`: a test of
//! libtest's would compile there and never run, as would a file that no module declares. This finds both.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use crate::steps::root;

/// An error that names each test that would never run.
pub(crate) fn check() -> anyhow::Result<String> {
    let (mut faults, mut programs) = (Vec::new(), 0);
    for parent in ["crates", "apps"] {
        for package in fs::read_dir(root().join(parent)).context(parent)? {
            let package = package?.path();
            let manifest = package.join("Cargo.toml");
            if !package.join("tests").is_dir() || !manifest.is_file() {
                continue;
            }
            let listed = listed(&fs::read_to_string(&manifest)?).context("a manifest")?;
            programs += listed.len();
            let files = files(&package.join("tests"))?;
            let faults_here = faults_of(&files, &listed).into_iter();
            faults.extend(faults_here.map(|fault| format!("{}: {fault}", package.display())));
        }
    }
    if !faults.is_empty() {
        faults.sort();
        bail!("{}", faults.join("\n"));
    }
    Ok(format!("{programs} test programs leave no test out"))
}

/// A file below `tests`, from there, with its text.
type File = (PathBuf, String);

/// Names of the programs that a manifest gives to our harness.
fn listed(manifest: &str) -> anyhow::Result<BTreeSet<String>> {
    let manifest: toml::Table = manifest.parse()?;
    let tests = manifest.get("test").and_then(toml::Value::as_array);
    let ours = tests.into_iter().flatten().filter(|test| {
        let harness = test.get("harness").and_then(toml::Value::as_bool);
        harness == Some(false)
    });
    let name = |test: &toml::Value| Some(test.get("name")?.as_str()?.to_owned());
    Ok(ours.filter_map(name).collect())
}

/// All Rust files below a folder.
fn files(tests: &Path) -> anyhow::Result<Vec<File>> {
    let (mut files, mut open) = (Vec::new(), vec![tests.to_path_buf()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let text = fs::read_to_string(&path)?;
                files.push((path.strip_prefix(tests)?.to_path_buf(), text));
            }
        }
    }
    Ok(files)
}

/// What would never run of these files, where these programs have our harness.
fn faults_of(files: &[File], listed: &BTreeSet<String>) -> Vec<String> {
    let lines = files.iter().flat_map(|(_, text)| text.lines());
    let module = |line: &str| {
        let declared = line.trim_start_matches("pub(crate) ").strip_prefix("mod ");
        declared.and_then(|rest| Some(rest.strip_suffix(';')?.to_owned()))
    };
    let declared: BTreeSet<String> = lines.filter_map(|line| module(line.trim())).collect();
    let mut faults = Vec::new();
    for (path, text) in files {
        let place = path.display();
        for (line, _) in (1..)
            .zip(text.lines())
            .filter(|(_, line)| line.trim() == "#[test]")
        {
            faults.push(format!(
                "{place}:{line}: #[test] is libtest's: write #[neurotess_testing::test]"
            ));
        }
        // A folder's file is known by the folder.
        let is_folder = path.ends_with("main.rs") || path.ends_with("mod.rs");
        let named = if is_folder {
            path.parent()
        } else {
            Some(path.as_path())
        };
        let name = named
            .and_then(Path::file_stem)
            .unwrap_or_default()
            .to_string_lossy();
        let is_program = path.ends_with("main.rs") || path.parent() == Some(Path::new(""));
        if is_program && !listed.contains(&*name) {
            faults.push(format!(
                "{place}: needs a [[test]] with `harness = false` in Cargo.toml"
            ));
        }
        if !is_program && !declared.contains(&*name) {
            faults.push(format!("{place}: no file declares `mod {name};`"));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(files: &[(&str, &str)], manifest: &str) -> Vec<String> {
        let files: Vec<File> = files
            .iter()
            .map(|(path, text)| (path.into(), (*text).into()))
            .collect();
        faults_of(&files, &listed(manifest).expect("a manifest"))
    }

    const OURS: &str = "[[test]]\nname = \"it\"\nharness = false\n";

    #[test]
    fn a_test_of_libtest_is_a_fault() {
        let files = [
            ("it/main.rs", "mod a;\n"),
            ("it/a.rs", "fn b() {}\n    #[test]\n"),
        ];
        let [fault] = &faults(&files, OURS)[..] else {
            panic!("one fault");
        };
        assert!(fault.starts_with("it/a.rs:2: #[test]"), "{fault}");
    }

    #[test]
    fn a_program_that_libtest_runs_is_a_fault() {
        for manifest in ["", "[[test]]\nname = \"it\"\n"] {
            assert_eq!(faults(&[("it/main.rs", "")], manifest).len(), 1);
        }
        assert_eq!(faults(&[("other.rs", "")], OURS).len(), 1);
    }

    #[test]
    fn a_file_that_is_no_module_is_a_fault() {
        let main = "#[cfg(unix)]\nmod kept;\npub(crate) mod folder;\n";
        let files = [
            ("it/main.rs", main),
            ("it/kept.rs", ""),
            ("it/folder/mod.rs", "mod inner;"),
            ("it/folder/inner.rs", ""),
        ];
        assert_eq!(faults(&files, OURS), [""; 0]);
        assert_eq!(faults(&[files[0], ("it/lost.rs", "")], OURS).len(), 1);
        assert_eq!(faults(&[files[0], ("it/lost/mod.rs", "")], OURS).len(), 1);
    }

    #[test]
    fn this_workspace_leaves_no_test_out() {
        check().expect("no fault");
    }
}
