//! From elements to records: segments and groups of the first morphology.

use glam::DVec3;
use neurotess_morphology::Morphology;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use crate::Fault;
use crate::sample::Sample;
use crate::text::Located;

/// A frustum of a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Segment {
    pub(super) id: i64,
    pub(super) name: String,
    pub(super) line: u64,
    /// Number of the parent, and how far along it this one begins: 0 at its start, 1 at its end.
    pub(super) parent: Option<(i64, f64)>,
    pub(super) proximal: Option<Sample>,
    pub(super) distal: Option<Sample>,
}

/// Segments that belong together.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    pub(super) id: String,
    /// What it is, in the terms of the NeuroLex and Gene ontologies.
    pub(super) term: String,
    pub(super) members: Vec<i64>,
    /// Other groups, by name.
    pub(super) includes: Vec<String>,
}

/// What is of interest in a file.
#[derive(Default)]
pub(super) struct Records {
    /// Of the first morphology.
    pub(super) segments: Vec<Segment>,
    pub(super) groups: Vec<Group>,
    pub(super) notes: String,
    /// Morphologies in the file, and the line of the second.
    pub(super) morphologies: u64,
    pub(super) second: u64,
    /// Placed cells of networks, and the line of the first.
    pub(super) instances: u64,
    pub(super) first_instance: u64,
}

/// Reads the elements of a file.
pub(super) fn records(text: &str) -> Located<Records> {
    let mut scan = Scan {
        text,
        at: 0,
        line: 1,
        records: Records::default(),
        in_notes: false,
    };
    let mut reader = Reader::from_str(text);
    loop {
        let start = reader.buffer_position();
        let event = reader.read_event();
        scan.go_to(start);
        match event {
            Err(e) => {
                scan.go_to(reader.error_position());
                let reason = e.to_string();
                return Err((scan.line, Fault::Xml { reason }));
            }
            Ok(Event::Start(element)) => scan.element(&element)?,
            Ok(Event::Empty(element)) => {
                scan.element(&element)?;
                scan.in_notes = false;
            }
            Ok(Event::Text(text)) if scan.in_notes => {
                let text: &str = &text;
                scan.records.notes.push_str(text.trim());
            }
            Ok(Event::End(_)) => scan.in_notes = false,
            Ok(Event::Eof) => return Ok(scan.records),
            Ok(_) => {}
        }
    }
}

struct Scan<'a> {
    text: &'a str,
    at: usize,
    line: u64,
    records: Records,
    /// In the notes of the first cell.
    in_notes: bool,
}

impl Scan<'_> {
    /// Counts the lines up to a byte.
    fn go_to(&mut self, position: u64) {
        let to = usize::try_from(position).map_or(self.text.len(), |p| p.min(self.text.len()));
        if to > self.at {
            let passed = &self.text.as_bytes()[self.at..to];
            self.line += memchr::memchr_iter(b'\n', passed).count() as u64;
            self.at = to;
        }
    }

    fn element(&mut self, element: &BytesStart) -> Located<()> {
        let name = element.local_name();
        let name: &str = name.as_ref();
        // Blanks before the element belong to the text that precedes it.
        let first = self.records.morphologies == 1;
        match name {
            "notes" => self.in_notes = self.records.notes.is_empty(),
            "morphology" => {
                self.records.morphologies += 1;
                if self.records.morphologies == 2 {
                    self.records.second = self.line;
                }
            }
            "instance" => {
                self.records.instances += 1;
                if self.records.instances == 1 {
                    self.records.first_instance = self.line;
                }
            }
            "segment" if first => {
                let segment = Segment {
                    id: self.whole(element, name, "id")?,
                    name: attribute(element, "name").unwrap_or_default(),
                    line: self.line,
                    ..Segment::default()
                };
                self.records.segments.push(segment);
            }
            "parent" if first => {
                let id = self.whole(element, name, "segment")?;
                let along = match attribute(element, "fractionAlong") {
                    Some(_) => self.real(element, name, "fractionAlong")?,
                    None => 1.0,
                };
                if !(0.0..=1.0).contains(&along) {
                    return Err(self.fault(name, "fractionAlong", along.to_string()));
                }
                if let Some(segment) = self.records.segments.last_mut() {
                    segment.parent = Some((id, along));
                }
            }
            "proximal" | "distal" if first => {
                let sample = Sample {
                    position: DVec3::new(
                        self.real(element, name, "x")?,
                        self.real(element, name, "y")?,
                        self.real(element, name, "z")?,
                    ),
                    radius: self.real(element, name, "diameter")? / 2.0,
                    line: self.line,
                };
                if let Some(segment) = self.records.segments.last_mut() {
                    let end = match name {
                        "proximal" => &mut segment.proximal,
                        _ => &mut segment.distal,
                    };
                    *end = Some(sample);
                }
            }
            "segmentGroup" if first => self.records.groups.push(Group {
                id: attribute(element, "id").unwrap_or_default(),
                term: attribute(element, "neuroLexId").unwrap_or_default(),
                ..Group::default()
            }),
            "member" if first => {
                let id = self.whole(element, name, "segment")?;
                if let Some(group) = self.records.groups.last_mut() {
                    group.members.push(id);
                }
            }
            "include" if first => {
                let included = attribute(element, "segmentGroup");
                if let (Some(group), Some(id)) = (self.records.groups.last_mut(), included) {
                    group.includes.push(id);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn whole(&self, element: &BytesStart, name: &str, key: &'static str) -> Located<i64> {
        let text = attribute(element, key).unwrap_or_default();
        let number = text.trim().parse();
        number.map_err(|_| self.fault(name, key, text))
    }

    fn real(&self, element: &BytesStart, name: &str, key: &'static str) -> Located<f64> {
        let text = attribute(element, key).unwrap_or_default();
        let number = fast_float2::parse::<f64, _>(text.trim());
        let in_range = number
            .ok()
            .filter(|n| n.abs() <= Morphology::MAX_COORDINATE);
        in_range.ok_or_else(|| self.fault(name, key, text))
    }

    fn fault(&self, element: &str, attribute: &'static str, text: String) -> (u64, Fault) {
        let element = element.to_owned();
        (
            self.line,
            Fault::Attribute {
                element,
                attribute,
                text,
            },
        )
    }
}

fn attribute(element: &BytesStart, key: &str) -> Option<String> {
    let attribute = element.try_get_attribute(key).ok()??;
    let value = attribute.normalized_value(XmlVersion::Explicit1_0).ok()?;
    Some(value.into_owned())
}
