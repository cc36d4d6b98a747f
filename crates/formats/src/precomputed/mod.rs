//! Skeletons of neuroglancer's precomputed data, in a folder with an `info`: a file for each, named by its id, or shards.
//! cloud-volume packs the files of a folder by gzip, as `ID.gz`. Positions are nm after the transform of the `info`, radii nm as they are: nobody scales them.
//!
//! A path names one as `FOLDER/ID`, also where shards hold it.

mod info;
mod murmur;
mod shards;
mod skeleton;

use std::fs;
use std::path::{Path, PathBuf};

use crate::packed::unpacked;
use crate::warning::Warnings;
use crate::{Fault, Read, ReadError, ReadOptions, read_regular};
use info::Info;
pub use murmur::murmur;
pub use shards::{Located, Shards};

/// Short name of the format.
const NAME: &str = "precomputed";

/// A folder of skeletons.
#[derive(Clone, Debug)]
pub struct Skeletons {
    folder: PathBuf,
    info: Info,
}

impl Skeletons {
    /// The skeletons of a folder: its own, or those that belong to its segmentation. None if it has none.
    ///
    /// # Errors
    /// The `info` is broken.
    pub fn open(folder: &Path) -> Result<Option<Self>, ReadError> {
        let Some(text) = info_of(folder) else {
            return Ok(None);
        };
        let of = |folder: &Path, fault| {
            ReadError::of_file(&folder.join(INFO).display().to_string(), fault)
        };
        if let Some(inner) = info::folder_of_skeletons(&text) {
            let inner = folder.join(inner);
            return match info_of(&inner) {
                Some(text) => {
                    let info = Info::parse(&text).map_err(|fault| of(&inner, fault))?;
                    Ok(info.map(|info| Self {
                        folder: inner,
                        info,
                    }))
                }
                None => Ok(None),
            };
        }
        let info = Info::parse(&text).map_err(|fault| of(folder, fault))?;
        Ok(info.map(|info| Self {
            folder: folder.to_path_buf(),
            info,
        }))
    }

    /// Where they lie: a path of one is that of this folder and its id.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The ids of all, ascending.
    ///
    /// # Errors
    /// The folder or a shard cannot be read.
    pub fn ids(&self) -> Result<Vec<u64>, ReadError> {
        let at = |path: &Path, fault| ReadError::of_file(&path.display().to_string(), fault);
        let entries = fs::read_dir(&self.folder);
        let entries = entries.map_err(|e| at(&self.folder, Fault::Io(e)))?;
        let mut ids = Vec::new();
        for entry in entries.flatten() {
            let path = entry.path();
            match &self.info.shards {
                None => ids.extend(id_of(&path)),
                Some(shards) if path.extension().is_some_and(|e| e == "shard") => {
                    ids.extend(shards.ids(&path).map_err(|fault| at(&path, fault))?);
                }
                Some(_) => {}
            }
        }
        ids.sort_unstable();
        ids.dedup();
        Ok(ids)
    }

    /// The file that holds a skeleton, whether it is there or not.
    fn file(&self, id: u64) -> PathBuf {
        if let Some(shards) = &self.info.shards {
            return shards.file(&self.folder, id);
        }
        let plain = self.folder.join(id.to_string());
        let packed = self.folder.join(format!("{id}.gz"));
        if packed.is_file() && !plain.exists() {
            packed
        } else {
            plain
        }
    }

    fn bytes(&self, id: u64) -> Result<Vec<u8>, Fault> {
        match &self.info.shards {
            Some(shards) => shards
                .object(&self.folder, id)?
                .ok_or(Fault::NoSkeleton { id }),
            None => unpacked(read_regular(&self.file(id)).map_err(Fault::Io)?),
        }
    }
}

/// Name of the file that describes a folder.
const INFO: &str = "info";

fn info_of(folder: &Path) -> Option<String> {
    let bytes = read_regular(&folder.join(INFO)).ok()?;
    String::from_utf8(bytes).ok()
}

/// The id that a path ends with.
fn id_of(path: &Path) -> Option<u64> {
    let name = path.file_name()?.to_str()?;
    name.strip_suffix(".gz").unwrap_or(name).parse().ok()
}

/// The file that holds the skeleton that a path names; none if it names none.
pub(crate) fn file_of(path: &Path) -> Option<PathBuf> {
    let id = id_of(path)?;
    let skeletons = Skeletons::open(path.parent()?).ok()??;
    Some(skeletons.file(id))
}

/// Reads the skeleton that a path names; none if it names none.
pub(crate) fn read(path: &Path, options: &ReadOptions) -> Option<Result<Read, ReadError>> {
    let id = id_of(path)?;
    let skeletons = match Skeletons::open(path.parent()?) {
        Ok(skeletons) => skeletons?,
        Err(e) => return Some(Err(e)),
    };
    let name = path.display().to_string();
    let read = || {
        let bytes = skeletons.bytes(id)?;
        let mut warnings = Warnings::default();
        let forest = skeleton::forest(&bytes, &skeletons.info, &mut warnings)?;
        let morphology = forest.build(&id.to_string(), &mut warnings);
        Ok((morphology.map_err(|(_, fault)| fault)?, warnings))
    };
    let made = read().map_err(|fault| ReadError::of_file(&name, fault));
    Some(made.and_then(|(morphology, warnings)| {
        Ok(Read {
            morphology,
            format: NAME,
            warnings: warnings.finish(&name, options)?,
        })
    }))
}

/// What is wrong with it.
fn broken(reason: impl Into<String>) -> Fault {
    let reason = reason.into();
    Fault::Precomputed { reason }
}
