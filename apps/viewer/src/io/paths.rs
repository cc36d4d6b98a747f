//! Completion of paths that are typed.

use std::fs;
use std::path::{Path, PathBuf, is_separator};

/// A name in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Name {
    pub(crate) name: String,
    pub(crate) is_folder: bool,
}

/// The full path of a typed one: `~` is the user's home folder, relative paths start from `folder`.
pub(crate) fn whole(typed: &Path, folder: &Path) -> PathBuf {
    match (typed.strip_prefix("~"), directories::UserDirs::new()) {
        (Ok(rest), Some(dirs)) => dirs.home_dir().join(rest),
        _ => folder.join(typed),
    }
}

/// The typed text up to the last separator, and the name begun after it.
pub(crate) fn parted(typed: &str) -> (&str, &str) {
    let after = typed.rfind(is_separator).map_or(0, |at| at + 1);
    typed.split_at(after)
}

/// Whether a name starts with the begun one. Hidden names match only if their dot was typed.
pub(crate) fn goes_on(name: &str, begun: &str) -> bool {
    let hidden = name.starts_with('.') && !begun.starts_with('.');
    let same = |(a, b): (char, char)| a.to_lowercase().eq(b.to_lowercase());
    let letters = begun.chars().count();
    !hidden && name.chars().count() >= letters && name.chars().zip(begun.chars()).all(same)
}

/// The typed text, completed by what all matching names have in common, if there is any.
pub(crate) fn completed<'a>(
    typed: &str,
    names: impl IntoIterator<Item = &'a Name>,
) -> Option<String> {
    let (before, begun) = parted(typed);
    let fitting = names.into_iter().filter(|n| goes_on(&n.name, begun));
    let fitting: Vec<&Name> = fitting.collect();
    // Names that match in upper and lower case take precedence over those that match without.
    let exact: Vec<&Name> = fitting
        .iter()
        .copied()
        .filter(|n| n.name.starts_with(begun))
        .collect();
    let fitting = if exact.is_empty() { fitting } else { exact };
    let (first, others) = fitting.split_first()?;
    let mut common = first.name.as_str();
    for other in others {
        let pairs = common.char_indices().zip(other.name.chars());
        let same = pairs.take_while(|((_, a), b)| a == b).last();
        let end = same.map_or(0, |((at, a), _)| at + a.len_utf8());
        common = &common[..end];
    }
    let slash = others.is_empty() && first.is_folder;
    let whole = format!("{before}{common}{}", if slash { "/" } else { "" });
    (whole.len() > typed.len()).then_some(whole)
}

/// Folders, and files of an extension, in a folder.
pub(crate) fn read(folder: &Path, extension: &str) -> Vec<Name> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let named = entries.filter_map(|entry| {
        let is_folder = entry.path().is_dir();
        let fits = entry.path().extension().is_some_and(|e| e == extension);
        let name = entry.file_name().to_string_lossy().into_owned();
        (is_folder || fits).then_some(Name { name, is_folder })
    });
    let mut names: Vec<Name> = named.collect();
    names.sort_by_key(|n| (!n.is_folder, n.name.to_lowercase()));
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Vec<Name> {
        let name = |name: &str, is_folder| Name {
            name: name.into(),
            is_folder,
        };
        vec![
            name("cells", true),
            name("cell_a.swc", false),
            name("cell_b.swc", false),
            name("Über.swc", false),
            name(".config", true),
        ]
    }

    #[test]
    fn tab_adds_what_is_certain() {
        let names = names();
        let all = |typed| completed(typed, &names);
        assert_eq!(all("/data/c").as_deref(), Some("/data/cell"));
        assert_eq!(all("/data/cell"), None, "three ways");
        assert_eq!(all("/data/cell_").as_deref(), None);
        assert_eq!(all("cells").as_deref(), Some("cells/"));
        assert_eq!(all("cell_a").as_deref(), Some("cell_a.swc"));
        assert_eq!(all("~/CELL_B").as_deref(), Some("~/cell_b.swc"));
        assert_eq!(all("ü").as_deref(), Some("Über.swc"));
        assert_eq!(all("."), Some(".config/".into()));
        assert_eq!(all("nothing"), None);
    }

    #[test]
    fn hidden_names_are_not_listed_unasked() {
        assert!(!goes_on(".config", "") && goes_on(".config", ".c") && goes_on("cells", ""));
        assert!(!goes_on("ce", "cells"));
    }

    #[test]
    fn paths_start_from_the_folder() {
        let folder = Path::new("/a/b");
        assert_eq!(whole(Path::new("c.swc"), folder), Path::new("/a/b/c.swc"));
        assert_eq!(whole(Path::new("/c.swc"), folder), Path::new("/c.swc"));
        assert_eq!(parted("a/b/c"), ("a/b/", "c"));
        assert_eq!(parted("c"), ("", "c"));
    }
}
