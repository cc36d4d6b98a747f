//! XML as every reader of it wants it: elements with their line, their attributes as numbers, and what they are
//! in. Nothing is read ahead and nothing recurses, so that depth costs no more than the bytes that open it.

use glam::DVec3;
use neurotess_morphology::Morphology;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use crate::Fault;
use crate::text::{BOM, Located, refuse_other_text};

/// What comes next in a file.
pub(crate) enum Part<'a> {
    /// An element begins; one without content ends at once.
    Begin(Element<'a>),
    /// The innermost element ends.
    End,
    /// Text between elements, without blanks around it.
    Text(String),
}

/// The beginning of an element.
pub(crate) struct Element<'a> {
    start: BytesStart<'a>,
    /// Name without prefix.
    pub(crate) name: String,
    /// Line that it begins in.
    pub(crate) line: u64,
}

/// A file that is read from its beginning to its end.
pub(crate) struct Document<'a> {
    text: &'a str,
    reader: Reader<&'a [u8]>,
    at: usize,
    line: u64,
    /// Names of the elements that the next part is in, the outermost first.
    open: Vec<String>,
}

/// The text of a file in UTF-8; bytes that are none become signs for that, which only names and notes can have.
pub(crate) fn text(bytes: &[u8]) -> Located<std::borrow::Cow<'_, str>> {
    refuse_other_text(bytes)?;
    let bytes = bytes.strip_prefix(BOM).unwrap_or(bytes);
    Ok(String::from_utf8_lossy(bytes))
}

impl<'a> Document<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        let mut reader = Reader::from_str(text);
        reader.config_mut().expand_empty_elements = true;
        Self {
            text,
            reader,
            at: 0,
            line: 1,
            open: Vec::new(),
        }
    }

    /// The next part; nothing at the end.
    pub(crate) fn next_part(&mut self) -> Located<Option<Part<'a>>> {
        loop {
            let start = self.reader.buffer_position();
            let event = self.reader.read_event();
            self.go_to(start);
            match event {
                Err(e) => {
                    self.go_to(self.reader.error_position());
                    let reason = e.to_string();
                    return Err((self.line, Fault::Xml { reason }));
                }
                Ok(Event::Start(start)) => {
                    let name = start.local_name();
                    let name: &str = name.as_ref();
                    let name = name.to_owned();
                    self.open.push(name.clone());
                    let line = self.line;
                    return Ok(Some(Part::Begin(Element { start, name, line })));
                }
                Ok(Event::End(_)) => {
                    self.open.pop();
                    return Ok(Some(Part::End));
                }
                Ok(Event::Text(text)) => {
                    let text: &str = &text;
                    if !text.trim().is_empty() {
                        return Ok(Some(Part::Text(text.trim().to_owned())));
                    }
                }
                Ok(Event::CData(text)) => {
                    let text: &str = &text;
                    return Ok(Some(Part::Text(text.trim().to_owned())));
                }
                Ok(Event::Eof) => return Ok(None),
                Ok(_) => {}
            }
        }
    }

    /// What the element that was begun last is in, the inner one last; empty outside.
    pub(crate) fn parents(&self) -> [&str; 2] {
        let above = |levels: usize| {
            let index = self.open.len().checked_sub(levels + 1);
            index.map_or("", |i| &self.open[i])
        };
        [above(2), above(1)]
    }

    /// Counts the lines up to a byte.
    fn go_to(&mut self, position: u64) {
        let to = usize::try_from(position).map_or(self.text.len(), |p| p.min(self.text.len()));
        if to > self.at {
            let passed = &self.text.as_bytes()[self.at..to];
            self.line += memchr::memchr_iter(b'\n', passed).count() as u64;
            self.at = to;
        }
    }
}

impl Element<'_> {
    /// The text of an attribute, if it is there.
    pub(crate) fn attribute(&self, key: &str) -> Option<String> {
        let attribute = self.start.try_get_attribute(key).ok()??;
        let value = attribute.normalized_value(XmlVersion::Explicit1_0).ok()?;
        Some(value.into_owned())
    }

    /// A whole number that has to be there.
    pub(crate) fn whole(&self, key: &'static str) -> Located<i64> {
        let text = self.attribute(key).unwrap_or_default();
        let number = text.trim().parse();
        number.map_err(|_| self.fault(key, text))
    }

    /// A number that has to be there.
    pub(crate) fn real(&self, key: &'static str) -> Located<f64> {
        self.real_within(key, Morphology::MAX_COORDINATE)
    }

    /// A diameter that has to be there, of which the half is kept.
    pub(crate) fn diameter(&self, key: &'static str) -> Located<f64> {
        self.real_within(key, 2.0 * Morphology::MAX_COORDINATE)
    }

    fn real_within(&self, key: &'static str, limit: f64) -> Located<f64> {
        let text = self.attribute(key).unwrap_or_default();
        let number = fast_float2::parse::<f64, _>(text.trim());
        let in_range = number.ok().filter(|n| n.abs() <= limit);
        in_range.ok_or_else(|| self.fault(key, text))
    }

    /// A number that may be missing; what is there has to be one.
    pub(crate) fn real_if_any(&self, key: &'static str) -> Located<Option<f64>> {
        match self.attribute(key) {
            None => Ok(None),
            Some(_) => self.real(key).map(Some),
        }
    }

    /// A whole number that may be missing; what is there has to be one.
    pub(crate) fn whole_if_any(&self, key: &'static str) -> Located<Option<i64>> {
        match self.attribute(key) {
            None => Ok(None),
            Some(_) => self.whole(key).map(Some),
        }
    }

    /// A radius or diameter that may be missing; one that is no number, or below zero, is.
    #[cfg(feature = "xml")]
    pub(crate) fn radius_if_any(&self, key: &'static str) -> Located<Option<f64>> {
        let text = self.attribute(key).unwrap_or_default();
        if text.trim().eq_ignore_ascii_case("nan") || text.is_empty() {
            return Ok(None);
        }
        // A radius is judged again where the cell is built.
        self.diameter(key).map(|size| (size >= 0.0).then_some(size))
    }

    /// Three numbers that have to be there.
    pub(crate) fn reals(&self, keys: [&'static str; 3]) -> Located<DVec3> {
        let [x, y, z] = keys;
        Ok(DVec3::new(self.real(x)?, self.real(y)?, self.real(z)?))
    }

    /// The fault of an attribute that is missing or not what it should be.
    pub(crate) fn fault(&self, attribute: &'static str, text: String) -> (u64, Fault) {
        let element = self.name.clone();
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
