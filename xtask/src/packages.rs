//! Whether each feature builds alone, and whether each crate can be packed.

use crate::steps::{cargo, run};

/// What is checked without warnings: a package and its features. All of them together are what the
/// workspace builds anyway.
const COMBINATIONS: &[(&str, &str)] = &[
    ("neurotess", ""),
    ("neurotess", "asc"),
    ("neurotess", "h5"),
    ("neurotess", "neuroml"),
    ("neurotess", "circuit"),
    ("neurotess", "synth"),
    ("neurotess", "synth,circuit"),
    ("neurotess", "render"),
    ("neurotess", "render,circuit"),
    ("neurotess-cli", ""),
    ("neurotess-cli", "render"),
    ("neurotess-python", ""),
    ("neurotess-python", "render"),
];

/// Dependencies are checked, not run: optimizing what is built for them (macros) would take longest.
const UNOPTIMIZED: &str = "profile.dev.package.\"*\".opt-level=0";

/// Checks each combination of features. They have a folder of their own, so that what the workspace has built
/// stays.
pub(crate) fn features() -> anyhow::Result<String> {
    for (package, features) in COMBINATIONS {
        let mut check = cargo("check --locked --no-default-features --target-dir target/features");
        check.args(["--config", UNOPTIMIZED, "--package", package]);
        if !features.is_empty() {
            check.args(["--features", features]);
        }
        run(check.env("RUSTFLAGS", "-D warnings"))?;
    }
    Ok(format!("{} combinations", COMBINATIONS.len()))
}

/// Packs every crate that is for others. What a package would build is not built again.
pub(crate) fn package() -> anyhow::Result<String> {
    let pack = "package --workspace --exclude xtask --exclude neurotess-testing \
                --exclude neurotess-testing-macros --exclude neurotess-python --no-verify --allow-dirty --locked \
                --target-dir target/features";
    run(&mut cargo(pack)).map(|()| "every crate packs".into())
}
