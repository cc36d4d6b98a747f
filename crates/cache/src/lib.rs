//! What opening a circuit computes, kept in a file beside it, so that the next opening only reads it: the coarse
//! mesh of each tracing, and what exploration draws of it.
//!
//! **Theory.** An entry is found by a hash of all that its content follows from ([`Key`]): the traced points, the
//! options, the program's version. So nothing is ever out of date: what has changed is not found. A cache
//! never changes what is drawn, only when; it can be deleted at any time.
//!
//! **Practice.** [`Cache::open`] reads the index, [`Cache::mesh`] and [`Cache::proxy`] give what is there and
//! compute what is not, from many threads, and [`Cache::finish`] writes. The file is replaced as a whole once it is
//! complete ([`neurotess_output`]). Another run that writes it at the same time is not waited for: then this one
//! writes nothing. A file that is damaged is not used, and replaced.
//!
//! The file lies beside the circuit, or in the user's folder for caches where that cannot be written. **Why not** one
//! file for each entry? A thousand small files in the folder of a circuit are a nuisance, on network drives most
//! of all. **Why not** always the user's folder? Who opens a circuit that others have opened before gets
//! what they computed, and whoever deletes or moves a circuit has deleted or moved its cache.
//!
//! ```
//! use neurotess_cache::Cache;
//! use neurotess_generate::{GenerateOptions, generate};
//!
//! let cell = neurotess_synth::grow(&neurotess_synth::Options::sample(neurotess_synth::Kind::Star));
//! let folder = tempfile::tempdir()?;
//! let file = folder.path().join("circuit.ntcache");
//! for found in [0, 1] {
//!     let cache = Cache::at(vec![file.clone()]).with_least_points(0);
//!     let options = GenerateOptions::default();
//!     let (mesh, _) = cache.mesh(&cell, &options, || generate(&cell, &options))?;
//!     assert!(!mesh.mesh.patches.is_empty());
//!     assert_eq!(cache.finish().found, found);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod file;
mod key;
mod places;
mod writing;

use std::collections::HashSet;
use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use neurotess_generate::{GenerateOptions, Generated};
use neurotess_mesh::{ByteReader, ByteWriter, BytesError};
use neurotess_morphology::Morphology;
#[cfg(feature = "gpu")]
use neurotess_render::Proxy;
use thiserror::Error;

pub use file::FileError;
pub use key::Key;
pub use places::{EXTENSION, places};

use file::CacheFile;
use writing::Writing;

/// Fewest points of tracings whose meshes were missing for a cache to be written: fewer are meshed within a
/// second, and would only leave files in the folders of small circuits. In an unoptimized build, 20 cells of 5,000
/// points take 0.4 s on two cores.
pub const MIN_POINTS: usize = 100_000;

/// How many proxies are computed in the time of a mesh, about: in a profile of opening 1,000 cells of 5,000 points,
/// meshes took 75 % of the time, proxies 8 %.
#[cfg(feature = "gpu")]
const PROXIES_OF_MESH: usize = 10;

/// A circuit's cache while it is opened.
#[derive(Debug)]
pub struct Cache {
    files: Vec<OldFile>,
    writing: Mutex<Writing>,
    found: AtomicUsize,
    computed: AtomicUsize,
    damaged: AtomicUsize,
    /// Entries that were found.
    used: Mutex<HashSet<Key>>,
    warnings: Vec<CacheWarning>,
}

/// A file that may be read and replaced.
#[derive(Debug)]
struct OldFile {
    path: PathBuf,
    content: Option<CacheFile>,
    /// Whether it may be replaced: not what somebody else has given this name.
    ours: bool,
    /// Whether there is something that cannot be read.
    unusable: bool,
}

/// What a cache was good for.
#[derive(Debug, Default)]
pub struct Summary {
    /// Meshes that were found.
    pub found: usize,
    /// Meshes that were not there and have been generated.
    pub computed: usize,
    /// The file that was written.
    pub written: Option<PathBuf>,
    /// The file that another run was writing, so that this one did not.
    pub taken: Option<PathBuf>,
    /// What was wrong with files.
    pub warnings: Vec<CacheWarning>,
}

/// What was wrong with a cache. Nothing is missing because of it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CacheWarning {
    /// A file that is not used.
    #[error("{}: the cache is not used, since {why}", .path.display())]
    Unused {
        /// The file.
        path: PathBuf,
        /// Why not.
        why: FileError,
    },
    /// Entries that are not used.
    #[error("{}: {count} damaged entries of the cache are not used", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// How many.
        count: usize,
    },
    /// Nothing can be written.
    #[error("no cache is written: {why}; --no-cache goes without")]
    NotWritten {
        /// What is in the way.
        why: neurotess_output::OutputError,
    },
}

impl Cache {
    /// The cache of a circuit: of the file that it is opened by. See [`places`].
    pub fn open(circuit: &std::path::Path) -> Self {
        Self::at(places(circuit))
    }

    /// A cache in these files: all are read, and the first that can be written is.
    pub fn at(paths: Vec<PathBuf>) -> Self {
        let mut warnings = Vec::new();
        let open = |path: PathBuf| {
            let opened = CacheFile::open(&path);
            let ours = !matches!(opened, Err(FileError::Foreign | FileError::Link));
            let unusable = opened.is_err();
            let content = opened.unwrap_or_else(|why| {
                let path = path.clone();
                warnings.push(CacheWarning::Unused { path, why });
                None
            });
            OldFile {
                path,
                content,
                ours,
                unusable,
            }
        };
        let files: Vec<OldFile> = paths.into_iter().map(open).collect();
        let targets = files.iter().filter(|file| file.ours);
        let targets = targets.map(|file| file.path.clone()).collect();
        let mut writing = Writing::new(targets, MIN_POINTS);
        if files.iter().any(|file| file.ours && file.unusable) {
            writing.insist();
        }
        Self {
            writing: Mutex::new(writing),
            files,
            found: AtomicUsize::default(),
            computed: AtomicUsize::default(),
            damaged: AtomicUsize::default(),
            used: Mutex::default(),
            warnings,
        }
    }

    /// The same cache, which is written if meshes of as many points were missing, instead of [`MIN_POINTS`].
    #[must_use]
    pub fn with_least_points(self, points: usize) -> Self {
        lock(&self.writing).set_least_points(points);
        self
    }

    /// The mesh of a tracing with its key: the one that is there, which differs from what `generate` gives in
    /// [`soma_seconds`](Generated::soma_seconds) only, or what `generate` gives.
    ///
    /// # Errors
    /// What `generate` says.
    pub fn mesh<E>(
        &self,
        morphology: &Morphology,
        options: &GenerateOptions,
        generate: impl FnOnce() -> Result<Generated, E>,
    ) -> Result<(Generated, Key), E> {
        let key = Key::of_mesh(morphology, options);
        if let Some(generated) = self.get(&key, Generated::read_bytes) {
            self.found.fetch_add(1, Ordering::Relaxed);
            return Ok((generated, key));
        }
        let generated = generate()?;
        self.computed.fetch_add(1, Ordering::Relaxed);
        let mut bytes = ByteWriter::default();
        if generated.write_bytes(&mut bytes) {
            self.put(&key, bytes, morphology.points.len());
        }
        Ok((generated, key))
    }

    /// What exploration draws of a mesh with this key, all color keys 0.
    #[cfg(feature = "gpu")]
    pub fn proxy(&self, key: &Key, mesh: &neurotess_mesh::CoarseMesh) -> Proxy {
        let key = key.derived("proxy");
        let there = self.get(&key, |bytes| Proxy::read_bytes(bytes, mesh.tracing.len()));
        there.unwrap_or_else(|| {
            let proxy = Proxy::new(mesh, &[]);
            let mut bytes = ByteWriter::default();
            proxy.write_bytes(&mut bytes);
            self.put(&key, bytes, mesh.tracing.len() / PROXIES_OF_MESH);
            proxy
        })
    }

    /// An entry, if it is there and sound.
    fn get<T>(
        &self,
        key: &Key,
        read: impl Fn(&mut ByteReader<'_>) -> Result<T, BytesError>,
    ) -> Option<T> {
        for file in self.files.iter().filter_map(|file| file.content.as_ref()) {
            let Some(bytes) = file.get(key) else { continue };
            let value = bytes.ok().and_then(|bytes| {
                let mut reader = ByteReader::new(&bytes);
                let value = read(&mut reader).ok()?;
                reader.end().ok().map(|()| value)
            });
            if value.is_some() {
                lock(&self.used).insert(*key);
                return value;
            }
            self.damaged.fetch_add(1, Ordering::Relaxed);
            lock(&self.writing).insist();
        }
        None
    }

    fn put(&self, key: &Key, bytes: ByteWriter, points: usize) {
        lock(&self.writing).put(*key, bytes.into_bytes(), points);
    }

    /// Writes the file if enough was missing, and tells what the cache was good for. What was in it and was not
    /// asked for is kept, as long as there is room.
    pub fn finish(self) -> Summary {
        let Self {
            files,
            writing,
            found,
            computed,
            damaged,
            used,
            mut warnings,
        } = self;
        let damaged = damaged.into_inner();
        if let Some(file) = files.first().filter(|_| damaged > 0) {
            let (path, count) = (file.path.clone(), damaged);
            warnings.push(CacheWarning::Damaged { path, count });
        }
        let mut summary = Summary {
            found: found.into_inner(),
            computed: computed.into_inner(),
            warnings,
            ..Summary::default()
        };
        let used = used.into_inner().unwrap_or_else(PoisonError::into_inner);
        let writing = writing.into_inner().unwrap_or_else(PoisonError::into_inner);
        match writing.finish(files, &used) {
            Ok(written) => summary.written = written,
            Err(neurotess_output::OutputError::Taken { path }) => summary.taken = Some(path),
            Err(why) => summary.warnings.push(CacheWarning::NotWritten { why }),
        }
        summary
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} meshes from the cache", self.found)?;
        if self.computed > 0 {
            write!(f, ", {} generated", self.computed)?;
        }
        if let Some(path) = &self.written {
            write!(f, ", {} written", path.display())?;
        }
        if let Some(path) = &self.taken {
            write!(f, "; another run writes {}", path.display())?;
        }
        Ok(())
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
