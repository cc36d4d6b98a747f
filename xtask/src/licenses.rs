//! Licenses of all dependencies, and packages that are there in two versions.
//!
//! `cargo deny` judges by `deny.toml` where it is installed. Elsewhere this does the part of it that
//! needs no other program, by the same lists.

use std::collections::BTreeMap;
use std::process::{Command, Stdio};

use anyhow::bail;

use crate::metadata::Package;
use crate::steps::{cargo, run};

/// Licenses that may be linked into a program under MIT OR Apache-2.0; as in `deny.toml`.
const ALLOWED: &[&str] = &[
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MPL-2.0",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
    "0BSD",
];

/// Packages that may be there in several versions, and why.
const DUPLICATES: &[(&str, &str)] = &[
    (
        "bitflags",
        "winit's bindings of macOS and Redox are of the old one",
    ),
    (
        "block2",
        "winit's bindings of macOS are a release behind wgpu's",
    ),
    (
        "calloop",
        "winit's Wayland loop is a release behind the clipboard's",
    ),
    ("calloop-wayland-source", "the same"),
    ("foldhash", "the old hashbrown's"),
    (
        "getrandom",
        "ahash, which egui hashes by, is a release behind tempfile",
    ),
    (
        "hashbrown",
        "wgpu's allocator for DirectX is a release behind wgpu",
    ),
    (
        "jni-sys",
        "wgpu's bindings for Android have the old one in front of the new",
    ),
    ("linux-raw-sys", "with the old rustix"),
    ("miniz_oxide", "png is a release behind flate2"),
    (
        "objc2",
        "winit's bindings of macOS are a release behind wgpu's",
    ),
    ("objc2-app-kit", "the same"),
    ("objc2-foundation", "the same"),
    ("objc2-metal", "the same"),
    ("objc2-quartz-core", "the same"),
    ("objc2-ui-kit", "the same"),
    (
        "quick-xml",
        "Wayland's protocols are read by the old one, at build time only",
    ),
    ("r-efi", "with the old getrandom"),
    ("redox_syscall", "winit's and others' on Redox"),
    ("rustc-hash", "naga is a release behind accesskit"),
    (
        "rustix",
        "winit's Wayland loop is a release behind the clipboard's",
    ),
    (
        "smithay-client-toolkit",
        "winit is a release behind the clipboard",
    ),
    (
        "syn",
        "runs at build time only; the macros of Windows' bindings are older than serde's",
    ),
    (
        "thiserror",
        "winit's Wayland loop and Android's bindings have the old one",
    ),
    ("thiserror-impl", "the same"),
    (
        "windows-sys",
        "winit and others are releases behind one another",
    ),
];

/// An error that names each package whose license or second version is not allowed.
pub(crate) fn check(packages: &[Package]) -> anyhow::Result<String> {
    let deny = Command::new("cargo-deny")
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    if deny.is_ok_and(|status| status.success()) {
        run(&mut cargo("deny --offline check bans licenses sources"))?;
    }
    let mut faults: Vec<String> = packages
        .iter()
        .filter(|package| !allows(&package.license))
        .map(|p| format!("{} {}: license '{}'", p.name, p.version, p.license))
        .collect();
    let duplicates = duplicates(packages);
    for (name, versions) in &duplicates {
        if !DUPLICATES.iter().any(|(allowed, _)| allowed == name) {
            faults.push(format!("{name} in versions {}", versions.join(", ")));
        }
    }
    if !faults.is_empty() {
        bail!(
            "{}: allow it in xtask/src/licenses.rs and deny.toml, or do without",
            faults.join("; ")
        );
    }
    Ok(format!(
        "{} packages, all licenses allowed, {} in several versions",
        packages.len(),
        duplicates.len()
    ))
}

fn duplicates(packages: &[Package]) -> BTreeMap<&str, Vec<&str>> {
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for package in packages {
        let of_name = versions.entry(&package.name).or_default();
        of_name.push(&package.version);
    }
    versions.retain(|_, versions| versions.len() > 1);
    versions
}

/// Whether an SPDX expression leaves a choice of allowed licenses only.
fn allows(expression: &str) -> bool {
    // The slash is how old packages wrote OR.
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = &words[..];
    any(&mut rest) && rest.is_empty()
}

/// `all OR all …`
fn any(words: &mut &[&str]) -> bool {
    let mut allowed = all(words);
    while take(words, "OR") {
        allowed |= all(words);
    }
    allowed
}

/// `one AND one …`
fn all(words: &mut &[&str]) -> bool {
    let mut allowed = one(words);
    while take(words, "AND") {
        allowed &= one(words);
    }
    allowed
}

/// `( any )`, `license` or `license WITH exception`
fn one(words: &mut &[&str]) -> bool {
    if take(words, "(") {
        let allowed = any(words);
        return take(words, ")") && allowed;
    }
    let Some((&license, rest)) = words.split_first() else {
        return false;
    };
    *words = rest;
    if take(words, "WITH") {
        let Some((&exception, rest)) = words.split_first() else {
            return false;
        };
        *words = rest;
        return ALLOWED.contains(&format!("{license} WITH {exception}").as_str());
    }
    ALLOWED.contains(&license)
}

fn take(words: &mut &[&str], word: &str) -> bool {
    match words.split_first() {
        Some((&first, rest)) if first == word => {
            *words = rest;
            true
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_understood() {
        for yes in [
            "MIT",
            "MIT/Apache-2.0",
            "GPL-3.0 OR MIT",
            "(MIT OR GPL-3.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR GPL-3.0",
        ] {
            assert!(allows(yes), "{yes}");
        }
        for no in [
            "",
            "GPL-3.0",
            "MIT AND GPL-3.0",
            "(MIT",
            "MIT)",
            "MIT WITH nothing",
        ] {
            assert!(!allows(no), "{no}");
        }
    }
}
