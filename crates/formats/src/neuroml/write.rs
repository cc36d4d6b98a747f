//! Writing NeuroML 2.

use std::collections::HashMap;
use std::io::{self, BufWriter, Write};
use std::ops::Range;

use glam::Vec3;
use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Soma, SomaKind};

use super::order::neurites_begun;
use crate::Warning;
use crate::losses::Losses;
use crate::number::decimal;

/// The group of each kind, its term in the Gene Ontology, and how its segments are called.
const GROUPS: [(&str, &str, &[NeuriteKind]); 4] = [
    ("soma_group", "GO:0043025", &[NeuriteKind::SOMA]),
    ("axon_group", "GO:0030424", &[NeuriteKind::AXON]),
    (
        "dendrite_group",
        "GO:0030425",
        &[NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE],
    ),
    (
        "apical_dends",
        "GO:0097440",
        &[NeuriteKind::APICAL_DENDRITE],
    ),
];

/// What libNeuroML and exporters know groups by that are unbranched sections.
const SECTION: &str = "sao864921383";

/// Writes a morphology as a cell of NeuroML 2: a segment for each link between points, in the groups that its
/// conventions name. A soma of frusta stays so; any other is a sphere. What the format cannot say is returned: numbers
/// of samples, custom types.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(morphology: &Morphology, writer: impl Write) -> io::Result<Vec<Warning>> {
    let mut file = File {
        morphology,
        writer: BufWriter::with_capacity(1 << 16, writer),
        kinds: Vec::new(),
        sections: Vec::new(),
    };
    file.begin()?;
    let places = file.somata()?;
    file.neurites(&places)?;
    file.end()?;
    let mut losses = Losses::default();
    losses.add(
        "soma_as_sphere",
        "a soma is written as its sphere",
        morphology.somata.iter().filter(|s| is_other(s)).count() as u64,
    );
    let lost = |kind: NeuriteKind| kind != NeuriteKind::UNDEFINED && name(kind).is_none();
    losses.add(
        "types_lost",
        "a section is written without its type",
        morphology.sections.iter().filter(|s| lost(s.kind)).count() as u64,
    );
    let before: usize = morphology.somata.iter().map(samples).sum();
    let in_order = (before as i64 + 1..).zip(&morphology.sample_ids);
    losses.add(
        "renumbered",
        "a sample's number is not kept",
        in_order.filter(|(own, id)| own != *id).count() as u64,
    );
    losses.spines(morphology);
    Ok(losses.into_warnings())
}

/// What segments of a neurite's kind are called; nothing for custom kinds and somata within neurites.
fn name(kind: NeuriteKind) -> Option<&'static str> {
    match kind {
        NeuriteKind::AXON => Some("axon"),
        NeuriteKind::BASAL_DENDRITE => Some("dend"),
        NeuriteKind::APICAL_DENDRITE => Some("apic"),
        _ => None,
    }
}

/// Whether a soma is neither a sphere nor frusta.
fn is_other(soma: &Soma) -> bool {
    !matches!(soma.kind, SomaKind::Point | SomaKind::Cylinders)
}

/// Samples of a soma that are written.
fn samples(soma: &Soma) -> usize {
    match soma.kind {
        SomaKind::Cylinders => soma.samples.len(),
        _ => 1,
    }
}

/// A place on a segment that has been written: its number, and how far along it.
type Place = (usize, f64);

struct File<'a, W: Write> {
    morphology: &'a Morphology,
    writer: BufWriter<W>,
    /// Kind of each segment that has been written.
    kinds: Vec<NeuriteKind>,
    /// Segments of each section, without those that a neurite's first point is in.
    sections: Vec<Range<usize>>,
}

impl<W: Write> File<'_, W> {
    fn begin(&mut self) -> io::Result<()> {
        let id = identifier(&self.morphology.name);
        let w = &mut self.writer;
        writeln!(w, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
        writeln!(
            w,
            "<neuroml xmlns=\"http://www.neuroml.org/schema/neuroml2\" \
             xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
             xsi:schemaLocation=\"http://www.neuroml.org/schema/neuroml2 \
             https://raw.githubusercontent.com/NeuroML/NeuroML2/development/Schemas/NeuroML2/NeuroML_v2.3.xsd\" \
             id=\"{id}\">"
        )?;
        writeln!(w, "  <cell id=\"{id}\">")?;
        if !self.morphology.header.is_empty() {
            let notes = self.morphology.header.join("\n").replace("]]>", "]] >");
            writeln!(w, "    <notes><![CDATA[{notes}]]></notes>")?;
        }
        writeln!(w, "    <morphology id=\"morphology_{id}\">")
    }

    /// Writes somata, and gives the place of each sample.
    fn somata(&mut self) -> io::Result<Vec<Vec<Place>>> {
        let morphology = self.morphology;
        let mut places = Vec::with_capacity(morphology.somata.len());
        for soma in &morphology.somata {
            places.push(match soma.kind {
                SomaKind::Cylinders => self.frusta(soma)?,
                _ => {
                    let sphere = (soma.center, soma.radius);
                    let segment =
                        self.segment(NeuriteKind::SOMA, "soma", None, Some(sphere), sphere)?;
                    vec![(segment, 1.0); soma.samples.len()]
                }
            });
        }
        Ok(places)
    }

    /// A soma of frusta, its samples from the root on.
    fn frusta(&mut self, soma: &Soma) -> io::Result<Vec<Place>> {
        let count = soma.samples.len();
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut open = Vec::new();
        for (i, sample) in soma.samples.iter().enumerate() {
            match sample.parent {
                Some(parent) => children[parent as usize].push(i),
                None => open.push(i),
            }
        }
        let end = |i: usize| (soma.samples[i].position, soma.samples[i].radius);
        let mut places: Vec<Option<Place>> = vec![None; count];
        while let Some(i) = open.pop() {
            for &child in &children[i] {
                let start = places[i].is_none().then(|| end(i));
                let segment =
                    self.segment(NeuriteKind::SOMA, "soma", places[i], start, end(child))?;
                places[i].get_or_insert((segment, 0.0));
                places[child] = Some((segment, 1.0));
            }
            open.extend(children[i].iter().rev());
        }
        Ok(places
            .into_iter()
            .map(|place| place.unwrap_or((0, 1.0)))
            .collect())
    }

    fn neurites(&mut self, somata: &[Vec<Place>]) -> io::Result<()> {
        let morphology = self.morphology;
        let end = |i: usize| (morphology.points[i].position, morphology.points[i].radius);
        let mut places: Vec<Option<Place>> = vec![None; morphology.points.len()];
        let pieces = neurites_begun(morphology);
        // Of each point that is a fork: the type of what is written first of its children.
        let mut first_child: HashMap<usize, NeuriteKind> = HashMap::new();
        for piece in &pieces {
            if let Some(fork) = piece.branch_point(morphology) {
                let kind = morphology.sections[piece.section.index()].kind;
                first_child.entry(fork).or_insert(kind);
            }
        }
        // Of each section: where its neurite begins on a soma.
        let mut bases: Vec<Option<Place>> = Vec::with_capacity(morphology.sections.len());
        for section in &morphology.sections {
            bases.push(match section.attachment {
                Attachment::Section(parent) => bases[parent.index()],
                Attachment::Soma { soma, sample } => Some(somata[soma as usize][sample as usize]),
                Attachment::Free => None,
            });
        }
        for piece in &pieces {
            let section = &morphology.sections[piece.section.index()];
            let base = bases[piece.section.index()];
            let named = name(section.kind);
            let kind = named.map_or(NeuriteKind::UNDEFINED, |_| section.kind);
            let named = named.unwrap_or("segment");
            let first_segment = self.kinds.len();
            let mut before = piece.branch_point(morphology);
            for point in piece.points.clone() {
                // The first point of a neurite is the proximal end of what follows it.
                if let Some(before) = before {
                    let start = places[before].is_none().then(|| end(before));
                    let parent = places[before].or(base);
                    let segment = self.segment(kind, named, parent, start, end(point))?;
                    places[before].get_or_insert((segment, 0.0));
                    places[point] = Some((segment, 1.0));
                } else if piece.points.len() == 1 && first_child.get(&point) != Some(&section.kind)
                {
                    let segment = self.segment(kind, named, base, Some(end(point)), end(point))?;
                    places[point] = Some((segment, 1.0));
                }
                before = Some(point);
            }
            self.sections.push(first_segment..self.kinds.len());
        }
        Ok(())
    }

    /// Writes a segment and gives its number.
    fn segment(
        &mut self,
        kind: NeuriteKind,
        named: &str,
        parent: Option<Place>,
        start: Option<(Vec3, f32)>,
        end: (Vec3, f32),
    ) -> io::Result<usize> {
        let id = self.kinds.len();
        self.kinds.push(kind);
        writeln!(
            self.writer,
            "      <segment id=\"{id}\" name=\"{named}_{id}\">"
        )?;
        match parent {
            Some((parent, along)) if along < 1.0 => writeln!(
                self.writer,
                "        <parent segment=\"{parent}\" fractionAlong=\"{along}\"/>"
            )?,
            Some((parent, _)) => {
                writeln!(self.writer, "        <parent segment=\"{parent}\"/>")?;
            }
            None => {}
        }
        if let Some(start) = start {
            self.point("proximal", start)?;
        }
        self.point("distal", end)?;
        writeln!(self.writer, "      </segment>")?;
        Ok(id)
    }

    fn point(&mut self, element: &str, (position, radius): (Vec3, f32)) -> io::Result<()> {
        let mut text = format!("        <{element}");
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            text.push_str(&format!(" {name}=\""));
            decimal(&mut text, position[axis], self.morphology.origin[axis]);
            text.push('"');
        }
        text.push_str(" diameter=\"");
        decimal(&mut text, 2.0 * radius, 0.0);
        writeln!(self.writer, "{text}\"/>")
    }

    fn end(mut self) -> io::Result<()> {
        for (id, term, kinds) in GROUPS {
            let members = self.kinds.iter().enumerate();
            let mut members = members.filter(|(_, kind)| kinds.contains(kind)).peekable();
            if members.peek().is_none() {
                continue;
            }
            writeln!(
                self.writer,
                "      <segmentGroup id=\"{id}\" neuroLexId=\"{term}\">"
            )?;
            for (segment, _) in members {
                writeln!(self.writer, "        <member segment=\"{segment}\"/>")?;
            }
            writeln!(self.writer, "      </segmentGroup>")?;
        }
        for (number, segments) in std::mem::take(&mut self.sections).into_iter().enumerate() {
            if segments.is_empty() {
                continue;
            }
            writeln!(
                self.writer,
                "      <segmentGroup id=\"section_{number}\" neuroLexId=\"{SECTION}\">"
            )?;
            for segment in segments {
                writeln!(self.writer, "        <member segment=\"{segment}\"/>")?;
            }
            writeln!(self.writer, "      </segmentGroup>")?;
        }
        writeln!(self.writer, "    </morphology>\n  </cell>\n</neuroml>")?;
        self.writer.flush()
    }
}

/// A name as NeuroML takes it: letters, digits and underscores, no digit first.
fn identifier(name: &str) -> String {
    let sign = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = name.chars().map(sign).collect();
    match name.chars().next() {
        Some(first) if !first.is_ascii_digit() => name,
        _ => format!("cell_{name}"),
    }
}
