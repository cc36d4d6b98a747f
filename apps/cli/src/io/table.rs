//! Tables: CSV, or TSV for files of that name.

use std::io::{BufWriter, Write};
use std::path::Path;

use clap::Args;
use neurotess::output::OutputError;

use super::output;

/// Where a table goes.
#[derive(Args, Clone, Debug)]
pub(crate) struct TableArgs {
    /// File of the table, with tabs if it ends in .tsv; - for standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub(crate) csv: std::path::PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub(crate) force: bool,
}

/// Writes the rows of a table.
pub(crate) type Rows = csv::Writer<BufWriter<Box<dyn Write>>>;

/// Writes a table: all of it or nothing. `fill` writes the rows, heading first; its error is the
/// result.
///
/// # Errors
/// That of `fill`, or the file cannot be written.
pub(crate) fn write<T>(
    args: &TableArgs,
    fill: impl FnOnce(&mut Rows) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    write_to(&args.csv, delimiter(&args.csv), args.force, fill)
}

/// As [`write`], with another delimiter than the name says.
pub(crate) fn write_to<T>(
    out: &Path,
    delimiter: u8,
    force: bool,
    fill: impl FnOnce(&mut Rows) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let mut output = output::begin(out, force)?;
    let file = output.file().try_clone();
    let file = file.map_err(|e| OutputError::broken(out, e))?;
    let to: Box<dyn Write> = Box::new(file);
    let mut rows = csv::WriterBuilder::new()
        .delimiter(delimiter)
        .from_writer(BufWriter::new(to));
    let filled = fill(&mut rows).map_err(|e| match e.downcast::<csv::Error>() {
        Ok(e) => OutputError::broken(out, std::io::Error::other(e)).into(),
        Err(other) => other,
    })?;
    rows.flush().map_err(|e| OutputError::broken(out, e))?;
    drop(rows);
    output.finish()?;
    Ok(filled)
}

fn delimiter(out: &Path) -> u8 {
    match out
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("tsv"))
    {
        true => b'\t',
        false => b',',
    }
}

/// A number as a cell: nothing where there is none.
pub(crate) fn cell(number: f64) -> String {
    match number.is_finite() {
        true => number.to_string(),
        false => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tsv_has_tabs_and_no_number_is_empty() {
        assert_eq!(delimiter(Path::new("a.TSV")), b'\t');
        assert_eq!(delimiter(Path::new("-")), b',');
        assert_eq!(cell(0.25), "0.25");
        assert_eq!(cell(f64::NAN), "");
    }
}
