//! `cargo xtask soak [MINUTES]`: property tests and fuzzers with seeds that nobody tried before.
//!
//! The test command draws the same cases everywhere, so that a commit that passes once passes always. This
//! one looks for what those cases missed. A counterexample is shrunk and printed with its seed; it becomes
//! a test of its own.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::Context;

use crate::lane::Lane;
use crate::steps;

/// Crates with property tests or fuzzers that need no GPU.
const PACKAGES: [&str; 7] = [
    "morphology",
    "formats",
    "circuit",
    "mesh",
    "generate",
    "refine",
    "union",
];
/// Trees of the first round, which is all about trees.
const TREES: &str = "100000";

/// Runs rounds until the time is over: at least the trees, and one round of everything.
pub(crate) fn run(minutes: Option<&str>) -> anyhow::Result<()> {
    let minutes: u64 = minutes
        .unwrap_or("10")
        .parse()
        .context("MINUTES is a number")?;
    let until = Instant::now() + Duration::from_secs(60 * minutes);
    let first = SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs();
    let trees = "test --release --locked -p neurotess-refine --test it -- closed::bushy";
    let seed = first.to_string();
    run_with(
        trees,
        &[("PROPTEST_RNG_SEED", &seed), ("NEUROTESS_TREES", TREES)],
    )?;
    let packages = PACKAGES
        .map(|name| format!(" -p neurotess-{name}"))
        .concat();
    let everything = format!("test --release --locked{packages} --tests --no-fail-fast");
    for seed in first + 1.. {
        let seed = seed.to_string();
        let seeds = [
            ("PROPTEST_RNG_SEED", seed.as_str()),
            ("NEUROTESS_FUZZ_SEED", seed.as_str()),
            ("NEUROTESS_FUZZ_SECONDS", "20"),
        ];
        run_with(&everything, &seeds)?;
        if Instant::now() > until {
            break;
        }
    }
    println!("\nnothing found from seed {first} on");
    Ok(())
}

fn run_with(arguments: &str, variables: &[(&str, &str)]) -> anyhow::Result<()> {
    for (name, value) in variables {
        println!("   {name}={value}");
    }
    let variables = variables.iter().copied().chain(Lane::Full.variables());
    steps::run(steps::cargo(arguments).envs(variables))
}
