//! Whether each feature builds alone, and whether each crate can be packed.

use crate::lane::Lane;
use crate::steps::{cargo, output, run};

/// What is checked without warnings: a package and its features. All of them together are what the
/// workspace builds anyway.
const COMBINATIONS: &[(&str, &str)] = &[
    ("neurotess", ""),
    ("neurotess", "asc"),
    ("neurotess", "h5"),
    ("neurotess", "neuroml"),
    ("neurotess", "xml"),
    ("neurotess", "json"),
    ("neurotess", "circuit"),
    ("neurotess", "precomputed"),
    ("neurotess", "synth"),
    ("neurotess", "synth,circuit"),
    ("neurotess", "render"),
    ("neurotess", "render,circuit"),
    ("neurotess", "gpu"),
    ("neurotess", "gpu,circuit"),
    ("neurotess-web", ""),
    ("neurotess-cli", ""),
    ("neurotess-cli", "render"),
    ("neurotess-cli", "gpu"),
    ("neurotess-python", ""),
    ("neurotess-python", "render"),
    ("neurotess-python", "gpu"),
];

/// Those of the quick lane: the library with nothing optional, and the core of pages in browsers.
const QUICK: &[(&str, &str)] = &[("neurotess", ""), ("neurotess-web", "")];

/// Checks each combination of features of a lane. The check is clippy's: what that has checked of others' packages
/// is used again.
pub(crate) fn features(lane: Lane) -> anyhow::Result<String> {
    let combinations = if lane == Lane::Full {
        COMBINATIONS
    } else {
        QUICK
    };
    for (package, features) in combinations {
        let mut check = cargo("clippy --locked --no-default-features");
        check.args(["--package", package]);
        if !features.is_empty() {
            check.args(["--features", features]);
        }
        run(check.args(["--", "-D", "warnings"]))?;
    }
    without_graphics()?;
    Ok(format!("{} combinations", combinations.len()))
}

/// Checks that pictures by the processor need no graphics stack: it takes minutes to compile.
fn without_graphics() -> anyhow::Result<()> {
    let tree = "tree --locked --edges normal --prefix none --package neurotess-cli --no-default-features --features render";
    let tree = output(&mut cargo(tree))?;
    let graphics = ["wgpu ", "naga ", "winit ", "eframe "];
    let found = tree
        .lines()
        .find(|line| graphics.iter().any(|name| line.starts_with(name)));
    match found {
        Some(found) => anyhow::bail!("the feature 'render' of the command must not need {found}"),
        None => Ok(()),
    }
}

/// Packs every crate that is for others. What a package would build is not built again.
pub(crate) fn package() -> anyhow::Result<String> {
    let pack = "package --workspace --exclude xtask --exclude neurotess-testing \
                --exclude neurotess-testing-macros --exclude neurotess-python --exclude neurotess-wasm --no-verify --allow-dirty --locked \
                --target-dir target/features";
    run(&mut cargo(pack)).map(|()| "every crate packs".into())
}
