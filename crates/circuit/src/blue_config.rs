//! Configurations and cells of Blue Brain's before SONATA, which are not read: what they are, and how they become
//! SONATA.
//!
//! A BlueConfig (also `CircuitConfig`) is text: `Run Default { CircuitPath … CellLibraryFile … }`, see
//! `source/blueconfig.rst` in BlueBrain/sonata-extension. No circuit in MVD2 or MVD3 is public, so a reader could
//! not be tested; Blue Brain's own tools convert them.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use neurotess_formats::regular;

use crate::{CircuitError, Fault};

/// Bytes of a file within which its section `Run` is.
const HEAD: u64 = 64 * 1024;
const OF_MVD3: &str = "convert them by 'brainbuilder sonata from-mvd3 --model-type biophysical -o nodes.h5 \
                       circuit.mvd3', write";
const OF_MVD2: &str =
    "convert them to MVD3 by MVDTool, that by 'brainbuilder sonata from-mvd3', write";
const OF_SONATA: &str = "as these are SONATA already, write";
const OF_NCS: &str =
    "they are older than MVD3: ask for them as MVD3 or SONATA, convert them, write";

/// Why a file is not read, if it is one of these.
pub(crate) fn refusal(path: &Path) -> Option<CircuitError> {
    let file = path.display().to_string();
    if let Some((format, way)) = of_cells(&path.to_string_lossy()) {
        return Some(CircuitError::of_file(&file, Fault::Mvd { format, way }));
    }
    let text = named_like_one(path).then(|| head(path)).flatten()?;
    let cells = cells(&text)?;
    let way = match of_cells(&cells) {
        Some((_, way)) => way,
        None if cells.ends_with("start.ncs") => OF_NCS,
        None => OF_SONATA,
    };
    Some(CircuitError::of_file(
        &file,
        Fault::BlueConfig { cells, way },
    ))
}

/// Format of a file of cells by its extension, and how it becomes SONATA's.
fn of_cells(name: &str) -> Option<(&'static str, &'static str)> {
    let (_, extension) = name.rsplit_once('.')?;
    match &*extension.to_ascii_lowercase() {
        "mvd3" => Some(("MVD3", OF_MVD3)),
        "mvd2" => Some(("MVD2", OF_MVD2)),
        _ => None,
    }
}

/// Whether a file has the name of a configuration: no extension, or one of the usual beginnings.
fn named_like_one(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let usual = ["BlueConfig", "CircuitConfig"];
    path.extension().is_none() || usual.iter().any(|begin| name.starts_with(begin))
}

fn head(path: &Path) -> Option<String> {
    let mut begin = Vec::new();
    regular(path).ok()?;
    File::open(path)
        .ok()?
        .take(HEAD)
        .read_to_end(&mut begin)
        .ok()?;
    Some(String::from_utf8_lossy(&begin).into_owned())
}

/// The file of the cells of a BlueConfig; `None` if the text is none.
fn cells(text: &str) -> Option<String> {
    let mut lines = text.lines().map(str::trim);
    let mut found = lines.any(|line| line == "Run" || line.starts_with("Run "));
    found &= lines
        .clone()
        .find(|line| !line.is_empty())?
        .starts_with('{');
    let section = lines.take_while(|line| !line.starts_with('}'));
    let values: Vec<(&str, &str)> = section
        .filter_map(|line| line.split_once(char::is_whitespace))
        .collect();
    let value = |key: &str| {
        let mut of_key = values.iter().filter(|(name, _)| *name == key);
        of_key.next().map(|(_, value)| value.trim())
    };
    let known = ["CircuitPath", "MorphologyPath", "nrnPath", "METypePath"];
    found &= known.iter().any(|key| value(key).is_some());
    found.then(|| {
        let file = value("CellLibraryFile").unwrap_or("start.ncs");
        let folder = value("CircuitPath").unwrap_or_default();
        Path::new(folder).join(file).display().to_string()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# made by hand\nRun Default\n{\n  CircuitPath /c\n\tMorphologyPath /m\n  \
                        nrnPath /c/edges.h5\n  CellLibraryFile circuit.mvd3\n}\nReport soma\n{\n}\n";

    fn said(name: &str, text: &str) -> Option<String> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        Some(refusal(&path)?.to_string())
    }

    #[test]
    fn the_cells_decide_what_is_to_be_done() {
        let mvd3 = said("BlueConfig", TEXT).expect("a refusal");
        assert!(
            mvd3.contains("its cells are in /c/circuit.mvd3; convert them by 'brainbuilder"),
            "{mvd3}"
        );
        let sonata = TEXT.replace("circuit.mvd3", "/n/nodes.h5");
        let sonata = said("CircuitConfig.in", &sonata).expect("a refusal");
        assert!(
            sonata.contains("in /n/nodes.h5; as these are SONATA already"),
            "{sonata}"
        );
        let older = said("old", &TEXT.replace("CellLibraryFile", "#")).expect("a refusal");
        assert!(older.contains("/c/start.ncs; they are older"), "{older}");
        assert!(said("circuit.mvd2", "").is_some_and(|text| text.contains("MVD2 is not read")));
    }

    #[test]
    fn other_texts_are_none() {
        assert_eq!(said("cell.swc", TEXT), None);
        assert_eq!(said("notes", "Run fast\nand far\n"), None);
        assert_eq!(said("code", "Run Default\n{\n  Fast yes\n}\n"), None);
    }
}
