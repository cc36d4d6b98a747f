//! Plots as files.

use std::io::Write;
use std::path::Path;

use neurotess::output::{Existing, write_whole};
use neurotess::plot::Plot;

/// Size (pixels) of a figure.
const SIZE: [u32; 2] = [900, 480];

/// Writes a plot: its numbers if the file is called `.csv`, else a figure. Returns what is said then.
pub(crate) fn plot(path: &Path, plot: &Plot) -> Result<String, String> {
    let is_table = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    let text = if is_table { plot.csv() } else { plot.svg(SIZE) };
    write_whole(path, Existing::Replace, |to| to.write_all(text.as_bytes()))
        .map_err(|e| e.to_string())?;
    Ok(format!("Saved {}", path.display()))
}
