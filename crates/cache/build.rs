//! A hash of the sources that meshes and proxies follow from. A released version has one set of sources, but
//! in the repository a version number lives for months, and a cache of an older build must not be believed.
//! In a published package the folders beside it are missing, and the version stands alone.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::Hasher;
use std::path::Path;

/// What the content of a cache follows from.
const SOURCES: [&str; 7] = [
    "src",
    "../morphology/src",
    "../mesh/src",
    "../refine/src",
    "../generate/src",
    "../render/src/sources/budgeted",
    "../../Cargo.lock",
];

fn main() {
    let mut hasher = DefaultHasher::new();
    for source in SOURCES {
        let path = Path::new(source);
        if path.exists() {
            println!("cargo:rerun-if-changed={source}");
            hash(path, &mut hasher);
        }
    }
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-env=NEUROTESS_SOURCES={:016x}", hasher.finish());
}

fn hash(path: &Path, hasher: &mut DefaultHasher) {
    if let Ok(bytes) = fs::read(path) {
        hasher.write(path.to_string_lossy().as_bytes());
        hasher.write(&bytes);
    } else if let Ok(entries) = fs::read_dir(path) {
        let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        paths.iter().for_each(|path| hash(path, hasher));
    }
}
