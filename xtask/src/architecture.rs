//! Which of our crates may know which: the rule of ARCHITECTURE.md.

use std::collections::BTreeSet;

use anyhow::bail;

use crate::metadata::Package;

/// A crate and the crates of ours that it may depend on (tests aside).
const ALLOWED: &[(&str, &[&str])] = &[
    ("neurotess-morphology", &[]),
    ("neurotess-mesh", &[]),
    ("neurotess-formats", &["neurotess-morphology"]),
    (
        "neurotess-circuit",
        &["neurotess-morphology", "neurotess-formats"],
    ),
    (
        "neurotess-synth",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-circuit",
        ],
    ),
    (
        "neurotess-generate",
        &["neurotess-morphology", "neurotess-mesh"],
    ),
    ("neurotess-refine", &["neurotess-mesh"]),
    ("neurotess-render", &["neurotess-mesh", "neurotess-refine"]),
    (
        "neurotess",
        &[
            "neurotess-morphology",
            "neurotess-mesh",
            "neurotess-formats",
            "neurotess-circuit",
            "neurotess-synth",
            "neurotess-generate",
            "neurotess-refine",
            "neurotess-render",
        ],
    ),
    ("neurotess-viewer", &["neurotess"]),
    ("neurotess-cli", &["neurotess", "neurotess-viewer"]),
    ("xtask", &["neurotess"]),
    // Tests of all crates may use it.
    ("neurotess-testing", &["neurotess-testing-macros"]),
    ("neurotess-testing-macros", &[]),
];

/// An error that names each dependency that is not allowed.
pub(crate) fn check(packages: &[Package]) -> anyhow::Result<String> {
    let ours: Vec<&Package> = packages.iter().filter(|package| package.ours).collect();
    let names: BTreeSet<&str> = ours.iter().map(|package| package.name.as_str()).collect();
    let mut faults = Vec::new();
    for package in &ours {
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == package.name) else {
            faults.push(format!("{} has no rule: add it to ALLOWED", package.name));
            continue;
        };
        let inner = package.dependencies.iter();
        for other in inner.filter(|other| names.contains(other.as_str())) {
            if !allowed.contains(&other.as_str()) {
                faults.push(format!("{} must not depend on {other}", package.name));
            }
        }
    }
    if !faults.is_empty() {
        bail!("{}", faults.join("; "));
    }
    Ok(format!("{} crates know only what they may", ours.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(name: &str, dependencies: &[&str]) -> Package {
        Package {
            name: name.into(),
            version: "0.1.0".into(),
            license: "MIT".into(),
            ours: true,
            dependencies: dependencies.iter().map(|&name| name.into()).collect(),
        }
    }

    #[test]
    fn a_forbidden_dependency_is_named() {
        let refine = package(
            "neurotess-refine",
            &["neurotess-mesh", "neurotess-morphology"],
        );
        let others = [
            package("neurotess-mesh", &[]),
            package("neurotess-morphology", &[]),
        ];
        let packages: Vec<Package> = others.into_iter().chain([refine]).collect();
        let error = check(&packages).expect_err("forbidden").to_string();
        assert_eq!(
            error,
            "neurotess-refine must not depend on neurotess-morphology"
        );
        assert!(check(&packages[..2]).is_ok());
        assert!(check(&[package("neurotess-new", &[])]).is_err());
    }
}
