//! Where caches lie.

use std::path::{Path, PathBuf};

/// Extension of caches.
pub const EXTENSION: &str = "ntcache";

/// The files that may be the cache of a circuit: `NAME.ntcache` beside the file that describes it; where that
/// folder cannot be written, a file in the user's folder for caches, named by a hash of the circuit's path.
pub fn places(circuit: &Path) -> Vec<PathBuf> {
    let absolute = circuit.canonicalize();
    let absolute = absolute.unwrap_or_else(|_| circuit.to_path_buf());
    let beside = circuit.with_extension(EXTENSION);
    let hash = blake3::hash(absolute.as_os_str().as_encoded_bytes());
    let name = format!("{}.{EXTENSION}", &hash.to_hex()[..32]);
    let user = directories::ProjectDirs::from("", "", "neurotess");
    let user = user.map(|folders| folders.cache_dir().join("circuits").join(name));
    std::iter::once(beside).chain(user).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cache_is_beside_its_circuit_first_and_has_one_name_elsewhere() {
        let folder = tempfile::tempdir().expect("a folder");
        let circuit = folder.path().join("circuit_config.json");
        std::fs::write(&circuit, "{}").expect("written");
        let there = places(&circuit);
        assert_eq!(there[0], folder.path().join("circuit_config.ntcache"));
        let around = folder.path().join(".").join("circuit_config.json");
        assert_eq!(places(&around)[1..], there[1..]);
        let other = places(&folder.path().join("other.json"));
        assert!(other[1..].iter().all(|place| !there.contains(place)));
    }
}
