//! Source files that our pages name in backticks are there.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::bail;
use walkdir::{DirEntry, WalkDir};

use crate::steps::root;

/// Ends of names of source files. Pages name files of users by other ends.
const ENDS: [&str; 3] = [".rs", ".wgsl", ".ts"];

/// An error that names each page and what it names in vain.
pub(crate) fn check() -> anyhow::Result<String> {
    let (mut sources, mut pages) = (BTreeSet::new(), Vec::new());
    let files = WalkDir::new(root())
        .into_iter()
        .filter_entry(is_ours)
        .filter_map(Result::ok);
    for file in files.filter(|entry| entry.file_type().is_file()) {
        let path = file.path();
        let name = slashed(path.strip_prefix(root())?);
        if name.ends_with(".md") {
            pages.push((name, fs::read_to_string(path)?));
        } else if is_source(&name) {
            sources.insert(format!("/{name}"));
        }
    }
    let (mut count, mut faults) = (0, Vec::new());
    for (page, text) in &pages {
        for name in named(text) {
            count += 1;
            let end = format!("/{name}");
            if !sources.iter().any(|source| source.ends_with(&end)) {
                faults.push(format!("{page}: {name}"));
            }
        }
    }
    if !faults.is_empty() {
        bail!(
            "pages name files that are not there:\n   {}",
            faults.join("\n   ")
        );
    }
    Ok(format!("{count} files that pages name are there"))
}

/// Not what is built or installed.
fn is_ours(entry: &DirEntry) -> bool {
    let name = entry.file_name().to_string_lossy();
    let hidden = name.starts_with('.') && entry.depth() > 0;
    !hidden && !["target", "node_modules", "shared"].contains(&name.as_ref())
}

fn slashed(path: &Path) -> String {
    let parts = path.iter().map(|part| part.to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}

fn is_source(name: &str) -> bool {
    ENDS.iter().any(|end| name.ends_with(end))
}

/// What a page names in backticks that looks like the path of a source file.
fn named(text: &str) -> impl Iterator<Item = &str> {
    let is_path = |name: &str| {
        let of_path = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
        name.chars().all(of_path) && !name.starts_with(['.', '/'])
    };
    let quoted = text.split('`').skip(1).step_by(2);
    quoted.filter(move |name| is_source(name) && is_path(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_in_backticks_are_named() {
        let text =
            "`union/src/merge.rs` and `a.swc`, `x.rs y`, `.rs`, `../a.rs`, tidy.rs, `sky.wgsl`";
        let found: Vec<&str> = named(text).collect();
        assert_eq!(found, ["union/src/merge.rs", "sky.wgsl"]);
    }

    #[test]
    fn a_path_is_written_with_slashes() {
        let path: std::path::PathBuf = ["a", "b.rs"].iter().collect();
        assert_eq!(slashed(&path), "a/b.rs");
    }
}
