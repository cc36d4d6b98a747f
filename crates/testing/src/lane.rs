//! The two lanes of `cargo xtask test`: what every change pays for, and everything.

/// The need of tests that only the full lane runs: those that take long, or that check what seldom changes.
/// CONTRIBUTING.md lists them with the reason.
///
/// # Errors
/// In the quick lane, which `NEUROTESS_FULL=1` makes the full one.
pub fn full() -> Result<(), String> {
    let missing = || "full lane only: cargo xtask test --full".to_owned();
    is_full().then_some(()).ok_or_else(missing)
}

/// Whether this is the full lane: for tests that try a part of their cases in the quick one.
pub fn is_full() -> bool {
    std::env::var_os("NEUROTESS_FULL").is_some_and(|value| value == "1")
}

/// How many cases a test tries: few in the quick lane, many in the full one.
pub fn cases<N>(quick: N, full: N) -> N {
    if is_full() { full } else { quick }
}
