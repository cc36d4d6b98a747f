//! Our packages and all they depend on, as Cargo knows them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use anyhow::Context;
use serde_json::Value;

use crate::steps::{cargo, output};

/// A package.
#[derive(Debug)]
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) version: String,
    /// SPDX expression, empty if there is none.
    pub(crate) license: String,
    /// Where its sources are, empty if it does not say.
    pub(crate) repository: String,
    /// Its `Cargo.toml`.
    pub(crate) manifest: PathBuf,
    /// Whether it is a member of the workspace.
    pub(crate) ours: bool,
    /// Direct dependencies by name that are not for its tests alone.
    pub(crate) dependencies: BTreeSet<String>,
}

/// All packages that are built for any platform, tests included.
pub(crate) fn read() -> anyhow::Result<Vec<Package>> {
    let text = output(&mut cargo("metadata --format-version 1 --locked"))?;
    let value: Value = serde_json::from_str(&text)?;
    packages(&value).context("cargo metadata is not as expected")
}

fn packages(value: &Value) -> Option<Vec<Package>> {
    let names = |list: &Value| -> Option<BTreeSet<String>> {
        let list = list.as_array()?.iter();
        Some(list.filter_map(Value::as_str).map(str::to_owned).collect())
    };
    let members = names(&value["workspace_members"])?;
    let mut packages = BTreeMap::new();
    for package in value["packages"].as_array()? {
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
        let dependencies = package["dependencies"].as_array()?.iter();
        let dependencies = dependencies
            .filter(|dependency| dependency["kind"] != "dev")
            .filter_map(|dependency| dependency["name"].as_str())
            .map(str::to_owned)
            .collect();
        let package = Package {
            name: text("name"),
            version: text("version"),
            license: text("license"),
            repository: text("repository"),
            manifest: text("manifest_path").into(),
            ours: members.contains(&text("id")),
            dependencies,
        };
        packages.insert((text("name"), text("version")), package);
    }
    Some(packages.into_values().collect())
}
