//! XML scenes of nsol, which NeuroTessMesh opens with `-xml`.
//!
//! ```xml
//! <scene version="0.1"><morphology>
//!   <columns><column id="0"><minicolumn id="0">
//!     <neuron gid="0" layer="2" morphologicalType="PYRAMIDAL" functionalType="EXCITATORY">
//!       <transform>1,0,0,0, 0,1,0,40, 0,0,1,0, 0,0,0,1</transform>     row by row
//!     </neuron>
//!   </minicolumn></column></columns>
//!   <neuronmorphologies><neuronmorphology neurons="0,1" swc="cell.swc"/></neuronmorphologies>
//! </morphology></scene>
//! ```
//!
//! A path is taken as it is, else relative to the scene's folder. Where two neurons have one gid, the
//! first wins, as in nsol. Morphologies are not moved before they are placed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use neurotess_formats::read_regular;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use crate::listed::{self, Cell};
use crate::sonata::folder_of;
use crate::{Circuit, CircuitError, Fault, Warning, transform};

/// Opens a scene.
pub(crate) fn open(path: &Path) -> Result<Circuit, CircuitError> {
    let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
    let text = String::from_utf8_lossy(&bytes);
    read(path, &text)
}

/// Whether a file begins like a scene.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    let begin = &bytes[..bytes.len().min(4096)];
    memchr::memmem::find(begin, b"<scene").is_some()
}

pub(crate) fn read(path: &Path, text: &str) -> Result<Circuit, CircuitError> {
    let file = path.display().to_string();
    let mut scan = Scan {
        file: &file,
        folder: folder_of(path),
        column: String::new(),
        minicolumn: String::new(),
        cells: vec![],
        gids: BTreeSet::new(),
        files: BTreeMap::new(),
        numbers: None,
        repeated: 0,
        skipping: false,
    };
    let mut reader = Reader::from_str(text);
    loop {
        let at = reader.buffer_position();
        let line = || 1 + lines(text, at) as u64;
        match reader.read_event() {
            Err(e) => {
                let reason = e.to_string();
                return Err(CircuitError::at_line(
                    &file,
                    line(),
                    "",
                    Fault::Xml { reason },
                ));
            }
            Ok(Event::Start(element)) => scan.element(&element, &line, false)?,
            Ok(Event::Empty(element)) => scan.element(&element, &line, true)?,
            Ok(Event::Text(text)) => {
                if let Some(numbers) = &mut scan.numbers {
                    let text: &str = &text;
                    numbers.push_str(text);
                }
            }
            Ok(Event::End(element)) => {
                let name = element.local_name();
                let name: &str = name.as_ref();
                if name == "transform" {
                    scan.transform(&line)?;
                }
            }
            Ok(Event::Eof) => break,
            Ok(_) => {}
        }
    }
    let Scan {
        mut cells,
        files,
        repeated,
        ..
    } = scan;
    if cells.is_empty() {
        return Err(CircuitError::new(
            &file,
            "scene.morphology.columns",
            Fault::Missing,
        ));
    }
    for cell in &mut cells {
        cell.file = files.get(&cell.id).cloned();
    }
    let mut warnings = Vec::new();
    if repeated > 0 {
        let message = format!("{repeated} neurons have the gid of another: the first is taken");
        let warning = Warning::new(&file, "neuron gid", "gid_repeated", message);
        warnings.push(warning.times(repeated));
    }
    Ok(listed::circuit(path, "nsol", &cells, warnings, vec![]))
}

fn lines(text: &str, at: u64) -> usize {
    let at = usize::try_from(at).map_or(text.len(), |at| at.min(text.len()));
    memchr::memchr_iter(b'\n', &text.as_bytes()[..at]).count()
}

struct Scan<'a> {
    file: &'a str,
    folder: &'a Path,
    column: String,
    minicolumn: String,
    cells: Vec<Cell>,
    gids: BTreeSet<u64>,
    /// Morphology by gid.
    files: BTreeMap<u64, PathBuf>,
    /// Text of the transform that is open.
    numbers: Option<String>,
    repeated: u64,
    /// In a neuron whose gid was there already.
    skipping: bool,
}

impl Scan<'_> {
    fn element(
        &mut self,
        element: &BytesStart,
        line: &dyn Fn() -> u64,
        empty: bool,
    ) -> Result<(), CircuitError> {
        let name = element.local_name();
        let name: &str = name.as_ref();
        match name {
            "column" => self.column = attribute(element, "id").unwrap_or_default(),
            "minicolumn" => self.minicolumn = attribute(element, "id").unwrap_or_default(),
            "neuron" => {
                let gid = attribute(element, "gid").unwrap_or_default();
                let id = self.whole(&gid, "gid", line)?;
                self.skipping = !self.gids.insert(id);
                if self.skipping {
                    self.repeated += 1;
                    return Ok(());
                }
                let texts = [
                    ("layer", "layer"),
                    ("morphologicalType", "morphological_type"),
                    ("functionalType", "functional_type"),
                ];
                let texts = texts
                    .into_iter()
                    .filter_map(|(key, name)| Some((name, attribute(element, key)?)));
                let place = [("column", &self.column), ("minicolumn", &self.minicolumn)];
                let place = place.map(|(name, id)| (name, id.clone()));
                self.cells.push(Cell {
                    id,
                    placement: Cell::PLACED_AT_ORIGIN,
                    recentered: false,
                    file: None,
                    attributes: texts
                        .chain(place)
                        .map(|(name, text)| (name.to_owned(), text))
                        .collect(),
                });
            }
            "transform" if !empty => self.numbers = Some(String::new()),
            "neuronmorphology" => self.morphology(element, line)?,
            _ => {}
        }
        Ok(())
    }

    fn morphology(
        &mut self,
        element: &BytesStart,
        line: &dyn Fn() -> u64,
    ) -> Result<(), CircuitError> {
        let missing = |key| {
            let key = format!("neuronmorphology {key}");
            CircuitError::at_line(self.file, line(), &key, Fault::Missing)
        };
        let swc = attribute(element, "swc").ok_or_else(|| missing("swc"))?;
        let neurons = attribute(element, "neurons").ok_or_else(|| missing("neurons"))?;
        let path = PathBuf::from(&swc);
        let path = if path.is_file() {
            path
        } else {
            self.folder.join(swc)
        };
        for gid in neurons.split(',').filter(|gid| !gid.trim().is_empty()) {
            let gid = self.whole(gid, "neuronmorphology neurons", line)?;
            self.files.entry(gid).or_insert_with(|| path.clone());
        }
        Ok(())
    }

    /// Ends a transform.
    fn transform(&mut self, line: &dyn Fn() -> u64) -> Result<(), CircuitError> {
        let text = self.numbers.take().unwrap_or_default();
        let wrong = |fault| CircuitError::at_line(self.file, line(), "transform", fault);
        let mut numbers = Vec::with_capacity(16);
        for field in text.split(|c: char| c == ',' || c.is_whitespace()) {
            if field.is_empty() {
                continue;
            }
            let number = field.parse::<f64>().map_err(|_| {
                let (expected, text) = ("a number", field.into());
                wrong(Fault::NotANumber { expected, text })
            });
            numbers.push(number?);
        }
        let found = numbers.len();
        let rows: [f64; 16] = numbers.try_into().map_err(|_| {
            let expected = 16;
            wrong(Fault::Fields { found, expected })
        })?;
        let placement = transform::rigid(rows).ok_or_else(|| wrong(Fault::Transform))?;
        if let Some(cell) = self.cells.last_mut().filter(|_| !self.skipping) {
            cell.placement = placement;
        }
        Ok(())
    }

    fn whole(&self, text: &str, key: &str, line: &dyn Fn() -> u64) -> Result<u64, CircuitError> {
        text.trim().parse().map_err(|_| {
            let (expected, text) = ("a whole number from 0 on", text.into());
            let fault = Fault::NotANumber { expected, text };
            CircuitError::at_line(self.file, line(), key, fault)
        })
    }
}

fn attribute(element: &BytesStart, key: &str) -> Option<String> {
    let attribute = element.try_get_attribute(key).ok()??;
    let value = attribute.normalized_value(XmlVersion::Explicit1_0).ok()?;
    Some(value.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const SCENE: &str = r#"<?xml version="1.0"?>
<scene version="0.1"><morphology><columns><column id="3"><minicolumn id="1">
  <neuron gid="0" layer="2"></neuron>
  <neuron gid="7" morphologicalType="PYRAMIDAL"><transform>
    1,0,0,0, 0,1,0,40, 0,0,1,0, 0,0,0,1</transform></neuron>
  <neuron gid="7"/>
</minicolumn></column></columns>
<neuronmorphologies><neuronmorphology neurons="0, 7" swc="missing.swc"/></neuronmorphologies>
</morphology></scene>"#;

    #[test]
    fn neurons_have_places_and_types() {
        let circuit = read(Path::new("s.xml"), SCENE).expect("a scene");
        let cells = &circuit.populations[0];
        assert_eq!(cells.ids, [0, 7]);
        assert_eq!(cells.positions[1], DVec3::new(0.0, 40.0, 0.0));
        assert_eq!(cells.attributes["layer"].text(0), Some("2"));
        assert_eq!(cells.attributes["column"].text(1), Some("3"));
        assert_eq!(cells.attributes["layer"].text(1), None);
        let codes: Vec<_> = circuit.warnings.iter().map(|w| (w.code, w.count)).collect();
        assert_eq!(codes, [("gid_repeated", 1), ("morphology_missing", 2)]);
    }

    #[test]
    fn faults_name_line_and_element() {
        let message = |from: &str, to: &str| {
            let text = SCENE.replace(from, to);
            read(Path::new("s.xml"), &text).expect_err(from).to_string()
        };
        assert_eq!(
            message("0,40", "0,forty"),
            "s.xml:5: 'transform': is not a number but \"forty\": correct it"
        );
        assert!(message("0,40", "40").contains("15 fields instead of 16"));
        assert!(message("0,40", "0,NaN").contains("5: 'transform': is no rotation"));
        assert!(message("gid=\"0\"", "gid=\"x\"").contains("3: 'gid'"));
        assert!(message("swc=", "asc=").contains("neuronmorphology swc': is missing"));
        assert!(message("</minicolumn>", "").contains("XML is broken"));
    }
}
