//! Where the morphologies of a population are: folders of files, or **containers**, HDF5 files that have each
//! morphology in a group of its name. MorphIO's collections, which bluepysnap opens, are either, too.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::hdf5::Store;
use crate::{CircuitError, Fault};

/// Morphologies by name.
pub(crate) struct Finder<'a> {
    /// In the order of preference.
    sources: Vec<Source<'a>>,
}

enum Source<'a> {
    /// A folder, and the extension of the files that are meant.
    Folder(&'a Path, &'a str),
    /// A file, and the names of the morphologies in it.
    Container(&'a Path, BTreeSet<String>),
}

impl<'a> Finder<'a> {
    /// `places`: folders with extensions, or containers, in the order of preference. Containers that are none go to
    /// `failures`, once each.
    pub(crate) fn new(
        places: impl Iterator<Item = (&'a Path, &'a str)>,
        failures: &mut Vec<CircuitError>,
    ) -> Self {
        let mut sources = Vec::new();
        let mut files: Vec<&Path> = Vec::new();
        for (path, extension) in places {
            if !path.is_file() {
                sources.push(Source::Folder(path, extension));
            } else if !files.contains(&path) {
                files.push(path);
                match container(path) {
                    Ok(names) => sources.push(Source::Container(path, names)),
                    // Each population of a circuit may name it.
                    Err(e) if failures.iter().any(|known| known.file == e.file) => {}
                    Err(e) => failures.push(e),
                }
            }
        }
        Self { sources }
    }

    /// The file of a name, with or without its extension; in a container `FILE#NAME`.
    pub(crate) fn find(&self, name: &str) -> Option<PathBuf> {
        let mut sources = self.sources.iter();
        let exact = sources.find_map(|source| source.of_name(name));
        exact.or_else(|| self.sources.iter().find_map(|source| source.of_stem(name)))
    }
}

impl Source<'_> {
    fn of_name(&self, name: &str) -> Option<PathBuf> {
        match *self {
            Self::Folder(folder, extension) => {
                let named = folder.join(format!("{name}.{extension}"));
                let bare = folder.join(name);
                let known = bare.extension();
                let known = known.is_some_and(|e| e.eq_ignore_ascii_case(extension));
                let candidates = if known { [bare, named] } else { [named, bare] };
                candidates.into_iter().find(|path| path.is_file())
            }
            Self::Container(file, ref names) => member(file, names, name),
        }
    }

    /// The file that a name like `morph.swc` means in a circuit whose files are all ASC.
    fn of_stem(&self, name: &str) -> Option<PathBuf> {
        let stem = Path::new(name).with_extension("");
        match *self {
            Self::Folder(folder, extension) => {
                let path = folder.join(format!("{}.{extension}", stem.display()));
                path.is_file().then_some(path)
            }
            Self::Container(file, ref names) => member(file, names, stem.to_str()?),
        }
    }
}

fn member(file: &Path, names: &BTreeSet<String>, name: &str) -> Option<PathBuf> {
    let name = name.trim_matches('/');
    names.contains(name).then(|| {
        let mut path = file.as_os_str().to_owned();
        path.push("#");
        path.push(name);
        path.into()
    })
}

/// Groups within groups that are searched: names may have some before them, like a path.
const MAX_DEPTH: u32 = 4;

/// The names of the morphologies in a container.
fn container(path: &Path) -> Result<BTreeSet<String>, CircuitError> {
    let not = |reason: String| {
        let file = path.display().to_string();
        CircuitError::of_file(&file, Fault::NotAContainer { reason })
    };
    let store = Store::open(path).map_err(|e| match e.fault {
        Fault::Hdf5 { reason } => not(format!("not HDF5: {reason}")),
        fault => CircuitError { fault, ..e },
    })?;
    let names = store.groups_with(&["points", "structure"], MAX_DEPTH);
    match names.first().map(String::as_str) {
        Some("") => Err(not("it is one morphology itself".into())),
        Some(_) => Ok(names),
        None => Err(not("none is in it".into())),
    }
}
