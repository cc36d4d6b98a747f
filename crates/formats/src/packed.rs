//! Files packed by gzip, as `cell.swc.gz`: RFC 1952, told by their first two bytes.

use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::{Fault, budget};

/// First bytes of every file of gzip; no format of morphologies begins so.
const GZIP: &[u8] = b"\x1f\x8b";

/// The content of a file of gzip, and any other as it is.
///
/// # Errors
/// It is not whole, or would be far larger than itself: see [`budget`].
pub fn unpacked(bytes: Vec<u8>) -> Result<Vec<u8>, Fault> {
    if !bytes.starts_with(GZIP) {
        return Ok(bytes);
    }
    let most = budget::most(bytes.len() as u64);
    let mut content = Vec::new();
    let mut unpacking = MultiGzDecoder::new(&*bytes).take(most.saturating_add(1));
    match unpacking.read_to_end(&mut content) {
        Ok(_) if content.len() as u64 > most => Err(Fault::PackedTooLarge { most }),
        Ok(_) => Ok(content),
        Err(e) => Err(Fault::Packed {
            reason: e.to_string(),
        }),
    }
}

/// Whether a file begins as those of gzip do.
#[cfg(feature = "h5")]
pub(crate) fn is_packed(path: &Path) -> bool {
    let mut begin = [0; 2];
    let read = crate::regular(path).and_then(|()| std::fs::File::open(path));
    let read = read.and_then(|mut file| file.read_exact(&mut begin));
    read.is_ok() && begin == GZIP
}

/// The name of a file without the ending `.gz`, if it has it.
pub fn unpacked_name(path: &Path) -> &Path {
    let packed = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    let stem = path
        .to_str()
        .filter(|_| packed)
        .map(|name| &name[..name.len() - 3]);
    stem.map_or(path, Path::new)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn packed(content: &[u8]) -> Vec<u8> {
        let mut packing = GzEncoder::new(Vec::new(), Compression::default());
        packing.write_all(content).expect("memory takes it");
        packing.finish().expect("memory takes it")
    }

    #[test]
    fn content_comes_back_and_broken_files_are_faults() {
        let file = packed(b"1 1 0 0 0 5 -1\n");
        assert_eq!(unpacked(file.clone()).expect("whole"), b"1 1 0 0 0 5 -1\n");
        let twice = [file.clone(), file.clone()].concat();
        assert_eq!(unpacked(twice).expect("two members").len(), 30);
        assert_eq!(unpacked(b"plain".to_vec()).expect("as it is"), b"plain");
        for cut in 2..file.len() {
            assert!(unpacked(file[..cut].to_vec()).is_err(), "{cut}");
        }
    }

    #[test]
    fn what_would_fill_memory_is_refused() {
        let bomb = packed(&vec![b' '; 103_000_000]);
        let fault = unpacked(bomb).expect_err("too large");
        assert!(matches!(fault, Fault::PackedTooLarge { .. }), "{fault}");
    }

    #[test]
    fn names_lose_the_last_ending_only() {
        let name = |path: &str| unpacked_name(Path::new(path)).display().to_string();
        assert_eq!(name("a/b.swc.gz"), "a/b.swc");
        assert_eq!(name("b.SWC.GZ"), "b.SWC");
        assert_eq!((name("b.swc"), name(".gz")), ("b.swc".into(), ".gz".into()));
    }
}
