//! Files of morphologies as Snudda names them: paths that may begin with `$SNUDDA_DATA` (once `$DATA`), the
//! folder of its data.
//!
//! Which folder that is, is asked in this order, as Snudda does it; the first in which the file exists is taken:
//! the `network-config.json` beside the network, the network itself, the environment variable `SNUDDA_DATA`. Then,
//! as a network often travels with its data: a folder `data` beside it.

use std::path::{Path, PathBuf};

use neurotess_formats::read_regular;

use crate::hdf5::Store;
use crate::sonata::folder_of;

/// How a path names the folder of Snudda's data.
const VARIABLES: [&str; 2] = ["$SNUDDA_DATA", "$DATA"];

/// Finds files of morphologies.
pub(crate) struct Finder {
    /// Of the network.
    folder: PathBuf,
    /// What the variable may stand for.
    data: Vec<PathBuf>,
}

impl Finder {
    pub(crate) fn new(network: &Path, store: &Store) -> Self {
        let folder = folder_of(network).to_path_buf();
        let written = ["meta/snudda_data", "meta/snuddaData", "meta/SnuddaData"];
        let written = written.iter().find_map(|path| store.text(path));
        let named = [
            of_config(&folder.join("network-config.json")),
            written,
            std::env::var("SNUDDA_DATA").ok(),
            Some("data".into()),
        ];
        let named = named.into_iter().flatten();
        let data = named.filter(|name| !name.is_empty());
        Self {
            data: data.map(|name| folder.join(name)).collect(),
            folder,
        }
    }

    /// The file of a name, if it exists.
    pub(crate) fn find(&self, name: &str) -> Option<PathBuf> {
        let Some(variable) = VARIABLES.into_iter().find(|v| name.contains(v)) else {
            return Some(self.folder.join(name)).filter(|path| path.is_file());
        };
        let paths = self
            .data
            .iter()
            .map(|data| PathBuf::from(name.replace(variable, &data.to_string_lossy())));
        paths.into_iter().find(|path| path.is_file())
    }

    /// What to do when files are not there.
    pub(crate) fn remedy(&self) -> String {
        let searched: Vec<String> = self
            .data
            .iter()
            .map(|data| data.display().to_string())
            .collect();
        format!(
            "set the environment variable SNUDDA_DATA to the folder that has Snudda's 'neurons' \
             ($SNUDDA_DATA was searched for as {})",
            searched.join(", ")
        )
    }
}

/// The folder of Snudda's data that a configuration of a network names.
fn of_config(path: &Path) -> Option<String> {
    let bytes = read_regular(path).ok()?;
    let config: serde_json::Value = serde_json::from_slice(&bytes).ok()?;
    let mut names = ["snudda_data", "SnuddaData"].into_iter();
    names.find_map(|name| Some(config.get(name)?.as_str()?.to_owned()))
}
