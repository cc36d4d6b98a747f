//! NeuroML 1, whose morphologies are MorphML: `<segment id parent cable>` in `<segments>`, and `<cable>`s, unbranched
//! runs of segments, that name their groups and how far along its parent a run begins
//! (<https://neuroml.org/neuroml1>). CATMAID and neuroConstruct write it. Coordinates are in the unit of
//! `length_units`.

use std::collections::HashMap;

use super::records::{Group, Records, Segment};
use crate::Fault;
use crate::text::Located;
use crate::unit::micrometers;
use crate::xml::Element;

/// What NeuroML 1 has beside segments.
#[derive(Default)]
pub(super) struct Cables {
    /// Line and text of the unit of lengths.
    unit: Option<(u64, String)>,
    /// Of each segment the cable, with the line.
    of_segments: Vec<(i64, Option<i64>)>,
    cables: Vec<Cable>,
    /// Groups of cables.
    groups: Vec<(String, Vec<i64>)>,
    /// In the name of a cable's group.
    in_group: bool,
}

/// A run of segments.
struct Cable {
    id: i64,
    name: String,
    /// How far along its parent the first segment begins.
    along: f64,
    groups: Vec<String>,
}

impl Cables {
    /// Takes in what is of NeuroML 1: elements of the first cell, segments among them.
    pub(super) fn element(
        &mut self,
        element: &Element,
        parent: &str,
        records: &mut Records,
    ) -> Located<()> {
        match (parent, &*element.name) {
            (_, "neuroml" | "morphml") => {
                let names = ["length_units", "lengthUnits"];
                let unit = names.into_iter().find_map(|name| element.attribute(name));
                self.unit = unit.map(|unit| (element.line, unit));
            }
            ("segments", "segment") => {
                let id = element.whole("id")?;
                let parent = element.whole_if_any("parent")?;
                records.segments.push(Segment {
                    id,
                    name: element.attribute("name").unwrap_or_default(),
                    line: element.line,
                    // Some writers give roots -1.
                    parent: parent
                        .filter(|&parent| parent >= 0)
                        .map(|parent| (parent, 1.0)),
                    ..Segment::default()
                });
                let cable = element.whole_if_any("cable")?;
                self.of_segments.push((id, cable));
            }
            ("cables", "cable") => {
                let names = ["fract_along_parent", "fractAlongParent"];
                let along = names.map(|name| element.real_if_any(name));
                let [older, newer] = along;
                let along = older?.or(newer?).unwrap_or(1.0);
                if !(0.0..=1.0).contains(&along) {
                    return Err(element.fault("fract_along_parent", along.to_string()));
                }
                self.cables.push(Cable {
                    id: element.whole("id")?,
                    name: element.attribute("name").unwrap_or_default(),
                    along,
                    groups: Vec::new(),
                });
            }
            ("cable", "group") => self.in_group = true,
            ("cables", "cablegroup") => {
                let name = element.attribute("name").unwrap_or_default();
                self.groups.push((name, Vec::new()));
            }
            ("cablegroup", "cable") => {
                let id = element.whole("id")?;
                if let Some((_, cables)) = self.groups.last_mut() {
                    cables.push(id);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes the name of a cable's group.
    pub(super) fn text(&mut self, text: &str) {
        if let (true, Some(cable)) = (self.in_group, self.cables.last_mut()) {
            cable.groups.push(text.to_owned());
        }
        self.in_group = false;
    }

    /// Makes groups of cables, gives segments the places where their cables begin, and micrometers of coordinates.
    pub(super) fn finish(mut self, records: &mut Records) -> Located<()> {
        let of_segments = std::mem::take(&mut self.of_segments).into_iter();
        let cable_of: HashMap<i64, i64> = of_segments
            .filter_map(|(segment, cable)| cable.map(|cable| (segment, cable)))
            .collect();
        self.add_groups(&cable_of, records);
        self.place(&cable_of, records);
        match self.unit {
            Some((line, unit)) => scale(records, line, unit),
            None => Ok(()),
        }
    }

    /// Makes one group of each name, in the order of the file; a cable's own name is that of a group, too.
    fn add_groups(&mut self, cable_of: &HashMap<i64, i64>, records: &mut Records) {
        let mut segments: HashMap<i64, Vec<i64>> = HashMap::new();
        for segment in &records.segments {
            if let Some(&cable) = cable_of.get(&segment.id) {
                segments.entry(cable).or_default().push(segment.id);
            }
        }
        let mut index: HashMap<String, usize> = HashMap::new();
        let mut add = |name: &String, cables: &[i64]| {
            let i = *index.entry(name.clone()).or_insert_with(|| {
                records.groups.push(Group {
                    id: name.clone(),
                    ..Group::default()
                });
                records.groups.len() - 1
            });
            let ids = cables.iter().filter_map(|cable| segments.get(cable));
            records.groups[i].members.extend(ids.flatten());
        };
        for cable in &self.cables {
            for name in cable.groups.iter().chain([&cable.name]) {
                add(name, &[cable.id]);
            }
        }
        for (name, cables) in &self.groups {
            add(name, cables);
        }
    }

    /// Gives the first segment of each cable the place where it begins.
    fn place(&self, cable_of: &HashMap<i64, i64>, records: &mut Records) {
        let along: HashMap<i64, f64> = self.cables.iter().map(|c| (c.id, c.along)).collect();
        for segment in &mut records.segments {
            let cable = cable_of.get(&segment.id);
            let place = cable.and_then(|cable| along.get(cable));
            if let (Some((parent, along)), Some(&place)) = (&mut segment.parent, place)
                && cable_of.get(parent) != cable
            {
                *along = place;
            }
        }
    }
}

fn scale(records: &mut Records, line: u64, unit: String) -> Located<()> {
    let scale = micrometers(&unit).ok_or((line, Fault::Unit { unit }))?;
    for segment in &mut records.segments {
        let ends = [&mut segment.proximal, &mut segment.distal];
        for end in ends.into_iter().flatten() {
            end.position *= scale;
            end.radius *= scale;
        }
    }
    Ok(())
}
