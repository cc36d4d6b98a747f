//! Folders of precomputed data, as programs write and browsers read them.

mod circuits;
mod folders;
mod reading;
mod serve;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use neurotess_precomputed::{Export, LevelOptions};
use tempfile::TempDir;

neurotess_testing::main!();

/// A folder with tracings `in/1.swc` and on, each a soma with an axon, and room for others.
struct Folders(TempDir);

impl Folders {
    fn with(cells: usize) -> Self {
        let folders = Self(tempfile::tempdir().expect("a folder"));
        fs::create_dir(folders.path("in")).expect("made");
        for n in 1..=cells {
            let mut text = "1 1 0 0 0 5 -1\n2 2 0 9 0 1 1\n".to_owned();
            for id in 3..4 + n % 5 {
                text += &format!("{id} 2 0 {} 0 1 {}\n", 9 * id, id - 1);
            }
            fs::write(folders.path(&format!("in/{n}.swc")), text).expect("written");
        }
        folders
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Of `in`, with two coarse levels.
    fn export(&self, out: &str) -> Export {
        Export::new([self.path("in")])
            .into(self.path(out))
            .levels(coarse())
    }

    /// Bytes of all files below a folder by name.
    fn files(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = BTreeMap::new();
        let root = self.path(out);
        collect(&root, &root, &mut files);
        files
    }
}

fn coarse() -> LevelOptions {
    LevelOptions {
        max_error: 0.5,
        count: 2,
    }
}

fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(root, &path, files);
        } else {
            let name = path.strip_prefix(root).expect("below").to_string_lossy();
            files.insert(name.replace('\\', "/"), fs::read(&path).expect("read"));
        }
    }
}
