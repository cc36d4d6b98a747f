//! Tests that need more than Rust: a graphics adapter, the reference data beside the workspace,
//! another program. Where it is missing, such a test **counts as skipped and says why**; it does not
//! return early and pass.
//!
//! Whether a test is skipped is decided when it runs, on the machine on which it runs. libtest cannot do
//! that: `#[ignore]` is decided when the test is compiled. So each package has one test program,
//! `tests/it/main.rs`, with `harness = false` in its `Cargo.toml`, which looks like this:
//!
//! ```text
//! fn gpu() -> Result<(), String> {
//!     Err("no graphics adapter".into())
//! }
//!
//! #[neurotess_testing::test(needs(gpu))]
//! fn a_picture_is_drawn() { /* takes the device, and panics if there is none */ }
//!
//! #[neurotess_testing::test]
//! fn a_number_is_added() {}
//!
//! neurotess_testing::main!();
//! ```
//!
//! A **need** is a function that returns what is missing, called once per program, before the first
//! test that has it. With `NEUROTESS_REQUIRE_GPU=1` a test whose need `gpu` is missing fails; so with
//! the other needs, each by its name.
//!
//! After its tests a program lists those that took longest (`took 3.214 s NAME`).
//!
//! Unit tests, beside the code, keep libtest. `cargo xtask test` checks that no program mixes the two.
#![forbid(unsafe_code)]

mod failure;
mod harness;
mod instructions;
mod lane;
mod need;
mod python;
mod shared;

pub use failure::keep_note;
pub use harness::{Test, run};
pub use instructions::{counted_case, instructions, valgrind};
pub use lane::{cases, full, is_full};
pub use need::Need;
pub use neurotess_testing_macros::test;
pub use python::python_with;
pub use shared::{shared, shared_data, workspace};

/// What the attribute registers tests with.
#[doc(hidden)]
pub use inventory as registry;

/// The `main` of a test program. It runs all functions of the program with the attribute
/// `#[neurotess_testing::test]`. `main!(finally: …)` evaluates an expression after them.
#[macro_export]
macro_rules! main {
    () => {
        $crate::main!(finally: ());
    };
    (finally: $finally:expr) => {
        /// Without it, a test with the attribute does not compile: nobody would run it.
        #[doc(hidden)]
        #[allow(non_upper_case_globals, reason = "its name is the compiler's message")]
        pub(crate) const END_THIS_FILE_WITH_neurotess_testing_main: () = ();

        fn main() -> ::std::process::ExitCode {
            let code = $crate::run();
            $finally;
            code
        }
    };
}

/// Keeps a line that is shown if the test fails, as libtest keeps what tests print. With `--nocapture`
/// it is printed at once.
#[macro_export]
macro_rules! note {
    ($($text:tt)*) => { $crate::keep_note(&::std::format!($($text)*)) };
}
