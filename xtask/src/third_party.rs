//! The licenses of all packages that are compiled into a module of ours, as one text. Most of them ask that their text
//! goes along with the program.
//!
//! Packages and licenses are Cargo's; the texts are the files that each package holds. Where a package holds
//! none and offers the Apache License 2.0, whose text is the same for all, that stands for it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use crate::metadata::{self, Package};
use crate::steps::{cargo, output, root};

/// What others' packages are compiled into.
pub(crate) struct Module {
    pub(crate) package: &'static str,
    /// What it is compiled for; none: this platform.
    pub(crate) target: Option<&'static str>,
    /// What it is, at the beginning of a sentence.
    pub(crate) what: &'static str,
}

/// The Python package's.
pub(crate) const PYTHON: Module = Module {
    package: "neurotess-python",
    target: None,
    what: "Its extension module",
};

/// What is compiled in although Cargo does not list it.
const STANDARD_LIBRARY: &str =
    "Rust's standard library: https://github.com/rust-lang/rust (MIT OR Apache-2.0)";

/// The text; `count` packages have it.
pub(crate) struct Licenses {
    pub(crate) text: String,
    pub(crate) count: usize,
}

/// Collects the licenses.
///
/// # Errors
/// Where a package has no text of its own and no license whose text is known.
pub(crate) fn collect(module: &Module) -> anyhow::Result<Licenses> {
    let packages = metadata::read()?;
    let compiled = compiled_in(module)?;
    let is_in = |p: &&Package| compiled.contains(&(p.name.clone(), p.version.clone()));
    let others: Vec<&Package> = packages.iter().filter(|p| !p.ours).filter(is_in).collect();
    let apache = fs::read_to_string(root().join("LICENSE-APACHE")).context("LICENSE-APACHE")?;
    let mut texts: BTreeMap<String, (String, BTreeSet<String>)> = BTreeMap::new();
    let mut add = |text: String, package: String| {
        let entry = texts
            .entry(same_words(&text))
            .or_insert((text, BTreeSet::new()));
        entry.1.insert(package);
    };
    add(apache.clone(), "Rust's standard library".into());
    let mut list = String::new();
    for package in &others {
        let name = format!("{} {}", package.name, package.version);
        writeln!(list, "{name}: {} ({})", package.repository, package.license)?;
        let folder = package.manifest.parent().context("a manifest's folder")?;
        let files = license_files(folder)?;
        if files.is_empty() && !package.license.contains("Apache-2.0") {
            bail!("{name} ({}) holds no text of its license", package.license);
        }
        let missing = files.is_empty().then(|| apache.clone());
        let found = files
            .iter()
            .map(|file| fs::read(file).map(|bytes| text_of(&bytes)));
        let found: Vec<String> = found.collect::<Result<_, _>>()?;
        missing
            .into_iter()
            .chain(found)
            .for_each(|text| add(text, name.clone()));
    }
    let mut text = format!(
        "neurotess is under MIT OR Apache-2.0. {} also holds these packages:\n\n\
         {list}{STANDARD_LIBRARY}\n\nTheir licenses follow.\n",
        module.what
    );
    for (words, packages) in texts.values() {
        let names: Vec<&str> = packages.iter().map(String::as_str).collect();
        write!(
            text,
            "\n{0}\n{1}:\n{0}\n\n{2}\n",
            "-".repeat(80),
            names.join(", "),
            words.trim_end()
        )?;
    }
    Ok(Licenses {
        text,
        count: others.len(),
    })
}

/// Names and versions of what is compiled into a module, without macros, which run at build time.
fn compiled_in(module: &Module) -> anyhow::Result<BTreeSet<(String, String)>> {
    let mut tree = cargo("tree --locked --edges normal,no-proc-macro --prefix none --format {p}");
    tree.args(["--package", module.package]);
    tree.args(
        module
            .target
            .into_iter()
            .flat_map(|target| ["--target", target]),
    );
    let listed = output(&mut tree)?;
    let named = |line: &str| -> Option<(String, String)> {
        let mut words = line.split_whitespace();
        let (name, version) = (words.next()?, words.next()?);
        Some((name.to_owned(), version.strip_prefix('v')?.to_owned()))
    };
    Ok(listed.lines().filter_map(named).collect())
}

/// Files of licenses and notices in a package, those of parts of it in folders too.
fn license_files(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
        for entry in entries {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if path.is_dir() {
                folders.push(path);
            } else if is_license(&name) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Whether a file of this name holds a license.
fn is_license(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let (stem, extension) = name.split_once('.').unwrap_or((&name, ""));
    let begins = [
        "license",
        "licence",
        "unlicense",
        "copying",
        "copyright",
        "notice",
    ];
    let fonts = ["ofl", "ufl"];
    let named = begins.iter().any(|begin| stem.starts_with(begin))
        || stem.ends_with("-license")
        || fonts.contains(&stem);
    named && ["", "txt", "md", "lib", "lesser"].contains(&extension)
}

fn text_of(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).replace("\r\n", "\n")
}

/// Two texts that differ in line breaks and spaces only are one.
fn same_words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_licenses_are_known_by_their_names() {
        for yes in [
            "LICENSE",
            "LICENSE-MIT",
            "license.txt",
            "LICENCE.md",
            "UNLICENSE",
            "COPYING",
            "OFL.txt",
            "emoji-icon-font-mit-license.txt",
        ] {
            assert!(is_license(yes), "{yes}");
        }
        for no in [
            "lib.rs",
            "license.rs",
            "README.md",
            "offline.txt",
            "licenses.hbs",
        ] {
            assert!(!is_license(no), "{no}");
        }
    }

    #[test]
    fn all_that_is_compiled_in_is_named_with_its_text() {
        let licenses = collect(&PYTHON).expect("all packages have licenses");
        assert!(licenses.count > 50, "{}", licenses.count);
        for name in [
            "\npyo3 0.",
            "\nnumpy 0.",
            "\nrayon 1.",
            "Permission is hereby granted",
            "Apache License",
        ] {
            assert!(licenses.text.contains(name), "{name}");
        }
        assert!(!licenses.text.contains("\nproptest "), "of tests only");
    }
}
