//! Batches, as programs run them.

mod resume;
mod runs;

use std::fs;
use std::path::{Path, PathBuf};

use neurotess_batch::Batch;
use neurotess_recipe::MeshOptions;
use tempfile::TempDir;

neurotess_testing::main!();

/// A folder with tracings, and one for meshes.
struct Folders(TempDir);

impl Folders {
    /// So many tracings in `in`: `0.swc` and on.
    fn with(cells: usize) -> Self {
        let folders = Self(tempfile::tempdir().expect("a folder"));
        fs::create_dir(folders.path("in")).expect("made");
        for n in 0..cells {
            folders.write(&format!("in/{n}.swc"), &tracing(n));
        }
        folders
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    /// Of `in`, at level 1, into `out`, by two workers.
    fn batch(&self) -> Batch {
        Batch::new([self.path("in")])
            .options(MeshOptions::default().with_level(1))
            .into(self.path("out"))
            .workers(2)
    }

    /// Names of what is in `out`, sorted.
    fn made(&self) -> Vec<String> {
        let Ok(files) = fs::read_dir(self.path("out")) else {
            return Vec::new();
        };
        let name = |file: fs::DirEntry| file.file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = files.map(|file| name(file.expect("read"))).collect();
        names.sort();
        names
    }
}

/// A soma with an axon, the longer the larger `n` is.
fn tracing(n: usize) -> String {
    let mut text = "1 1 0 0 0 5 -1\n2 2 0 9 0 1 1\n".to_owned();
    for id in 3..10 + n {
        text += &format!("{id} 2 0 {} 0 1 {}\n", 5 * id, id - 1);
    }
    text
}

fn stem(path: impl AsRef<Path>) -> String {
    let stem = path.as_ref().file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}
