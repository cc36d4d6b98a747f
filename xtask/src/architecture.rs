//! Who may know whom: the rules of ARCHITECTURE.md. Between crates a list says it; inside a crate, files
//! and folders that lie side by side import one way.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use anyhow::bail;

use crate::metadata::Package;
use crate::modules::{self, Imports, Module};
use crate::named_files;
use crate::python_modules;
use crate::steps::root;

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
        // It judges forks by their refined patches.
        &["neurotess-morphology", "neurotess-mesh", "neurotess-refine"],
    ),
    ("neurotess-refine", &["neurotess-mesh"]),
    ("neurotess-union", &["neurotess-mesh"]),
    // What a picture is; two crates draw it.
    ("neurotess-picture", &["neurotess-mesh", "neurotess-refine"]),
    (
        "neurotess-raster",
        &["neurotess-mesh", "neurotess-refine", "neurotess-picture"],
    ),
    (
        "neurotess-render",
        &["neurotess-mesh", "neurotess-refine", "neurotess-picture"],
    ),
    (
        "neurotess-recipe",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-mesh",
            "neurotess-generate",
            "neurotess-refine",
            "neurotess-union",
            "neurotess-output",
        ],
    ),
    (
        "neurotess-options",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-circuit",
            "neurotess-mesh",
            "neurotess-generate",
            "neurotess-refine",
            "neurotess-recipe",
            "neurotess-picture",
            "neurotess-color",
        ],
    ),
    (
        "neurotess-drawing",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-circuit",
            "neurotess-cache",
            "neurotess-mesh",
            "neurotess-generate",
            "neurotess-refine",
            "neurotess-recipe",
            "neurotess-output",
            "neurotess-picture",
            "neurotess-color",
            "neurotess-raster",
            "neurotess-options",
            // Behind features.
            "neurotess-precomputed",
            "neurotess-render",
            "neurotess-web",
        ],
    ),
    (
        "neurotess-batch",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-mesh",
            "neurotess-recipe",
            "neurotess-output",
            // Cells of circuits, behind a feature.
            "neurotess-circuit",
        ],
    ),
    (
        "neurotess-precomputed",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-circuit",
            "neurotess-mesh",
            "neurotess-refine",
            "neurotess-recipe",
            "neurotess-output",
            "neurotess-batch",
        ],
    ),
    (
        "neurotess-web",
        &[
            "neurotess-morphology",
            "neurotess-mesh",
            "neurotess-refine",
            "neurotess-picture",
            // The shaders.
            "neurotess-render",
            "neurotess-color",
        ],
    ),
    (
        "neurotess-wasm",
        &[
            "neurotess-morphology",
            "neurotess-formats",
            "neurotess-mesh",
            "neurotess-generate",
            "neurotess-refine",
            "neurotess-picture",
            "neurotess-raster",
            "neurotess-color",
            "neurotess-plot",
            "neurotess-web",
        ],
    ),
    ("neurotess-output", &[]),
    ("neurotess-plot", &["neurotess-morphology"]),
    (
        "neurotess-cache",
        &[
            "neurotess-morphology",
            "neurotess-mesh",
            "neurotess-generate",
            "neurotess-render",
            "neurotess-output",
        ],
    ),
    (
        "neurotess-color",
        &[
            "neurotess-morphology",
            "neurotess-mesh",
            "neurotess-circuit",
            "neurotess-picture",
        ],
    ),
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
            "neurotess-options",
            "neurotess-drawing",
            "neurotess-picture",
            "neurotess-raster",
            "neurotess-render",
            "neurotess-color",
            "neurotess-output",
            "neurotess-plot",
            "neurotess-cache",
            "neurotess-union",
            "neurotess-recipe",
            "neurotess-batch",
            "neurotess-precomputed",
            "neurotess-web",
        ],
    ),
    ("neurotess-viewer", &["neurotess"]),
    ("neurotess-cli", &["neurotess", "neurotess-viewer"]),
    ("neurotess-python", &["neurotess", "neurotess-cli"]),
    ("xtask", &["neurotess-plot"]),
    // Tests of all crates may use it.
    ("neurotess-testing", &["neurotess-testing-macros"]),
    ("neurotess-testing-macros", &[]),
];

/// An error that names each dependency that is not allowed, each circle of imports, and files that pages name in vain.
pub(crate) fn check(packages: &[Package]) -> anyhow::Result<String> {
    let crates = check_crates(packages)?;
    let files = check_files()?;
    let named = named_files::check()?;
    Ok(format!("{crates}; {files}; {named}"))
}

fn check_crates(packages: &[Package]) -> anyhow::Result<String> {
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

/// The modules of the Python package.
const PYTHON: &str = "bindings/python/python/neurotess";

fn check_files() -> anyhow::Result<String> {
    let (mut count, mut faults) = (0, Vec::new());
    for group in ["crates", "apps", "bindings", "."] {
        for entry in fs::read_dir(root().join(group))? {
            let src = entry?.path().join("src");
            if !src.is_dir() {
                continue;
            }
            let imports = modules::read(&src)?;
            count += imports.len();
            let of_crate = src.parent().and_then(|p| p.file_name()).unwrap_or_default();
            let circles = circles(&imports).into_iter();
            faults.extend(circles.map(|circle| format!("{}: {circle}", of_crate.display())));
        }
    }
    let python = python_modules::read(&root().join(PYTHON))?;
    count += python.len();
    let circles = circles(&python).into_iter();
    faults.extend(circles.map(|circle| format!("Python: {circle}")));
    if !faults.is_empty() {
        bail!("imports go in circles:\n   {}", faults.join("\n   "));
    }
    Ok(format!("{count} files import one way"))
}

/// For each folder the circles among what lies in it side by side, files and folders. A module and its
/// own children may know one another.
fn circles(imports: &Imports) -> Vec<String> {
    let mut edges: BTreeMap<&[String], BTreeMap<&String, BTreeSet<&String>>> = BTreeMap::new();
    for (from, targets) in imports {
        for to in targets {
            let common = from.iter().zip(to).take_while(|(a, b)| a == b).count();
            if let (Some(a), Some(b)) = (from.get(common), to.get(common)) {
                let folder = edges.entry(&from[..common]).or_default();
                folder.entry(a).or_default().insert(b);
            }
        }
    }
    let mut circles = Vec::new();
    for (folder, edges) in edges {
        for group in strongly_connected(&edges) {
            let names: Vec<&str> = group.iter().map(|name| name.as_str()).collect();
            let links = links(imports, folder, &group);
            circles.push(format!(
                "{}{} ({links})",
                folder.iter().map(|f| format!("{f}/")).collect::<String>(),
                names.join(" ↔ ")
            ));
        }
    }
    circles
}

/// Which files make a circle, from where to where.
fn links(imports: &Imports, folder: &[String], group: &BTreeSet<&String>) -> String {
    let within = |module: &Module| {
        let name = module.strip_prefix(folder).and_then(|rest| rest.first());
        name.filter(|name| group.contains(name)).cloned()
    };
    let mut links = Vec::new();
    for (from, targets) in imports {
        for to in targets {
            if let (Some(a), Some(b)) = (within(from), within(to))
                && a != b
            {
                links.push(format!("{} → {}", from.join("/"), to.join("/")));
            }
        }
    }
    links.join(", ")
}

/// Groups of more than one, each of which leads to all others of its group.
fn strongly_connected<'n>(
    edges: &BTreeMap<&'n String, BTreeSet<&'n String>>,
) -> Vec<BTreeSet<&'n String>> {
    let reach = |start: &'n String| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(next) = open.pop() {
            for &other in edges.get(next).into_iter().flatten() {
                if seen.insert(other) {
                    open.push(other);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&String, BTreeSet<&String>> =
        edges.keys().map(|&name| (name, reach(name))).collect();
    let mut groups = BTreeSet::new();
    for (&name, others) in &reached {
        let back = |other: &&&'n String| reached.get(**other).is_some_and(|r| r.contains(name));
        let group: BTreeSet<&String> = others.iter().filter(back).copied().collect();
        if group.len() > 1 {
            groups.insert(group);
        }
    }
    groups.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(name: &str, dependencies: &[&str]) -> Package {
        Package {
            name: name.into(),
            version: "0.1.0".into(),
            license: "MIT".into(),
            repository: String::new(),
            manifest: std::path::PathBuf::new(),
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
        let error = check_crates(&packages).expect_err("forbidden").to_string();
        assert_eq!(
            error,
            "neurotess-refine must not depend on neurotess-morphology"
        );
        assert!(check_crates(&packages[..2]).is_ok());
        assert!(check_crates(&[package("neurotess-new", &[])]).is_err());
    }

    #[test]
    fn circles_of_files_and_of_folders_are_found_but_not_those_with_children() {
        let module = |path: &str| -> Module { path.split('/').map(str::to_owned).collect() };
        let edge = |from: &str, to: &[&str]| {
            let to = to.iter().map(|path| module(path)).collect::<BTreeSet<_>>();
            (module(from), to)
        };
        let plain = [
            edge("a/x", &["b/y"]),
            edge("b", &["b/y"]),
            edge("b/y", &["b"]),
        ];
        assert_eq!(
            circles(&plain.clone().into_iter().collect()),
            Vec::<String>::new()
        );
        let back = plain.into_iter().chain([edge("b/z", &["a/w"])]);
        assert_eq!(circles(&back.collect()), ["a ↔ b (a/x → b/y, b/z → a/w)"]);
        let files = [edge("a/x", &["a/y"]), edge("a/y", &["a/x"])];
        assert_eq!(circles(&files.into_iter().collect()).len(), 1);
    }
}
