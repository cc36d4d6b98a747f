//! Cells in a window that is not ours, between what the program draws itself: they hide what is behind them, and are
//! hidden by what is before them.
//!
//! `cargo run --release -p neurotess --example in_another_window -- [CELL] [--out FILE.png]`
//!
//! With `--out`, one frame goes into a file, and there is no window. All that neurotess does is in `cells.rs`.

mod cells;
mod file;
mod host;
mod window;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut cell = PathBuf::from("samples/purkinje.swc");
    let mut arguments = std::env::args_os().skip(1);
    let mut out = None;
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--out") => out = arguments.next().map(PathBuf::from),
            _ => cell = argument.into(),
        }
    }
    match out {
        Some(out) => file::save(&cell, &out),
        None => window::show(cell),
    }
}
