//! Tables: CSV, or TSV for files of that name.

use std::io::{BufWriter, Write};
use std::path::{Component, Path, PathBuf};

use clap::Args;
use neurotess::formats;
use neurotess::output::OutputError;

use super::output;

/// Where a table goes.
#[derive(Args, Clone, Debug)]
pub(crate) struct TableArgs {
    /// File of the table, with tabs if it ends in .tsv; - for standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub(crate) csv: PathBuf,
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

/// A path as a table names it that goes to `out`: from the table's folder on if it is below that, so that both may be
/// moved together, else from the root on. So it means the same wherever the table is read.
pub(crate) fn named_from(out: &Path, path: &Path) -> String {
    let (file, member) = formats::member(path);
    let path = rooted(file);
    let folder = (!output::is_standard(out)).then(|| rooted(out));
    let folder = folder.as_deref().and_then(Path::parent);
    let below = folder.and_then(|folder| path.strip_prefix(folder).ok());
    let named = below.unwrap_or(&path).display();
    member.map_or_else(|| named.to_string(), |member| format!("{named}#{member}"))
}

/// The path from the root on, without `..`, which would need the folder to stay in which the command runs. The name
/// itself is no link that is followed: one into a store of data has the extension, the other may not.
fn rooted(path: &Path) -> PathBuf {
    // Only where the system knows no current folder is there none; then the path stays as it is.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    if !path.components().any(|part| part == Component::ParentDir) {
        return path;
    }
    let (folder, name) = (path.parent(), path.file_name());
    let folder = folder.and_then(|folder| folder.canonicalize().ok());
    match (folder, name) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => path,
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
    fn paths_in_a_table_mean_the_same_wherever_it_is_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path().canonicalize().expect("it is there");
        std::fs::create_dir_all(root.join("a/b")).expect("made");
        std::fs::write(root.join("a/m.h5"), "").expect("written");
        let named = |out: &str, path: &str| named_from(&root.join(out), &root.join(path));
        let whole = |path: &str| root.join(path).display().to_string();
        assert_eq!(
            named("t.csv", "a/c.swc"),
            Path::new("a/c.swc").display().to_string()
        );
        assert_eq!(
            named("a/../t.csv", "a/b/../c.swc"),
            named("t.csv", "a/c.swc")
        );
        assert_eq!(named("a/b/t.csv", "a/c.swc"), whole("a/c.swc"));
        assert_eq!(named("a/b/t.csv", "a/b/../m.h5#c/d"), whole("a/m.h5#c/d"));
        let out = Path::new("-");
        assert_eq!(named_from(out, &root.join("a/c.swc")), whole("a/c.swc"));
        assert!(Path::new(&named_from(out, Path::new("c.swc"))).is_absolute());
    }

    #[test]
    fn tsv_has_tabs_and_no_number_is_empty() {
        assert_eq!(delimiter(Path::new("a.TSV")), b'\t');
        assert_eq!(delimiter(Path::new("-")), b',');
        assert_eq!(cell(0.25), "0.25");
        assert_eq!(cell(f64::NAN), "");
    }
}
