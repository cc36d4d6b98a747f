//! From elements to records. NeuroML 2 has segments in `<morphology>`, NeuroML 1 (MorphML) in `<segments>` and
//! `<cables>`: see `version_1.rs`.

use super::records::{Group, Records, Segment, Span, Spread};
use super::version_1::Cables;
use crate::sample::Sample;
use crate::text::Located;
use crate::xml::{Document, Element, Part};

/// Reads the elements of a file.
pub(super) fn records(text: &str) -> Located<Records> {
    let mut document = Document::new(text);
    let mut records = Records::default();
    let mut cables = Cables::default();
    // In the notes of the first cell.
    let mut in_notes = false;
    while let Some(part) = document.next_part()? {
        match part {
            Part::Begin(element) => {
                in_notes |= element.name == "notes" && records.notes.is_empty();
                let [above, parent] = document.parents();
                if records.morphologies <= 1 {
                    cables.element(&element, parent, &mut records)?;
                }
                records.element(&element, [above, parent])?;
            }
            Part::Text(text) if in_notes => records.notes.push_str(&text),
            Part::Text(text) => cables.text(&text),
            Part::End => in_notes = false,
        }
    }
    cables.finish(&mut records)?;
    Ok(records)
}

impl Records {
    /// Takes an element in, by its name and by what it is directly in: `<proximal>` also stands in
    /// `<inhomogeneousParameter>`, where it is no place.
    fn element(&mut self, element: &Element, [above, parent]: [&str; 2]) -> Located<()> {
        match (parent, &*element.name) {
            (_, "morphology" | "segments") => {
                self.morphologies += 1;
                if self.morphologies == 2 {
                    self.second = element.line;
                }
            }
            (_, "instance") => {
                self.instances += 1;
                if self.instances == 1 {
                    self.first_instance = element.line;
                }
            }
            (parent, name) if self.morphologies == 1 => match parent {
                "morphology" => self.of_morphology(element, name)?,
                "segment" => self.of_segment(element, name)?,
                "segmentGroup" => self.of_group(element, name)?,
                "path" | "subTree" if above == "segmentGroup" => self.of_span(element, name)?,
                _ => {}
            },
            _ => {}
        }
        Ok(())
    }

    fn of_morphology(&mut self, element: &Element, name: &str) -> Located<()> {
        match name {
            "segment" => self.segments.push(Segment {
                id: element.whole("id")?,
                name: element.attribute("name").unwrap_or_default(),
                line: element.line,
                ..Segment::default()
            }),
            "segmentGroup" => self.groups.push(Group {
                id: element.attribute("id").unwrap_or_default(),
                term: element.attribute("neuroLexId").unwrap_or_default(),
                ..Group::default()
            }),
            _ => {}
        }
        Ok(())
    }

    fn of_segment(&mut self, element: &Element, name: &str) -> Located<()> {
        let Some(segment) = self.segments.last_mut() else {
            return Ok(());
        };
        match name {
            "parent" => {
                let id = element.whole("segment")?;
                let along = element.real_if_any("fractionAlong")?.unwrap_or(1.0);
                if !(0.0..=1.0).contains(&along) {
                    return Err(element.fault("fractionAlong", along.to_string()));
                }
                segment.parent = Some((id, along));
            }
            "proximal" => segment.proximal = Some(end(element)?),
            "distal" => segment.distal = Some(end(element)?),
            _ => {}
        }
        Ok(())
    }

    fn of_group(&mut self, element: &Element, name: &str) -> Located<()> {
        let Some(group) = self.groups.last_mut() else {
            return Ok(());
        };
        match name {
            "member" => group.members.push(element.whole("segment")?),
            "path" => group.spans.push(Span::new(Spread::Path)),
            "subTree" => group.spans.push(Span::new(Spread::Subtree)),
            "include" => group.includes.extend(element.attribute("segmentGroup")),
            _ => {}
        }
        Ok(())
    }

    fn of_span(&mut self, element: &Element, name: &str) -> Located<()> {
        let group = self.groups.last_mut();
        let Some(span) = group.and_then(|group| group.spans.last_mut()) else {
            return Ok(());
        };
        match name {
            "from" => span.from = Some(element.whole("segment")?),
            "to" => span.to = Some(element.whole("segment")?),
            _ => {}
        }
        Ok(())
    }
}

/// An end of a segment; both have diameters.
fn end(element: &Element) -> Located<Sample> {
    Ok(Sample {
        position: element.reals(["x", "y", "z"])?,
        radius: element.diameter("diameter")? / 2.0,
        line: element.line,
    })
}
