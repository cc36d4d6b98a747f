//! Writing SWC so that reading it back gives an equal morphology.
//!
//! Rows are the soma's samples, then the points in depth-first order. Numbers are the shortest
//! decimals that give the same `f32`, with the origin added and taken off again.

use std::io::{self, BufWriter, Write};

use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Section, Soma};

use crate::Warning;
use crate::losses::Losses;
use crate::number::decimal;

/// Writes a morphology as SWC.
///
/// Samples keep their numbers; where these repeat, are negative or too few, the rows are numbered
/// from 1 on. What SWC cannot say is returned: outlines of somata that would be read as something else,
/// which become a sphere of their radius, and neurites of type 1 on the soma, which get no type. Only other
/// formats have those.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(morphology: &Morphology, writer: impl Write) -> io::Result<Vec<Warning>> {
    let mut rows = Rows {
        morphology,
        writer: BufWriter::with_capacity(1 << 16, writer),
        ids: Ids::of(morphology),
        text: String::new(),
        is_sphere: morphology.somata.iter().map(is_read_otherwise).collect(),
        untyped: untyped(morphology),
    };
    for line in morphology
        .header
        .iter()
        .flat_map(|entry| entry.split(['\n', '\r']))
    {
        let line = line.replace('\0', " ");
        let line = line.trim_end();
        writeln!(
            rows.writer,
            "#{}{line}",
            if line.is_empty() { "" } else { " " }
        )?;
    }
    for soma in 0..morphology.somata.len() {
        rows.soma(soma)?;
    }
    for (section, &untyped) in morphology.sections.iter().zip(&rows.untyped.clone()) {
        rows.section(section, untyped)?;
    }
    rows.writer.flush()?;
    let mut losses = Losses::default();
    let count = |list: &[bool]| list.iter().filter(|&&it| it).count() as u64;
    losses.add(
        "soma_as_sphere",
        "the outline of a soma is written as a sphere of its radius",
        count(&rows.is_sphere),
    );
    losses.add(
        "types_changed",
        "a section of type 1 on the soma is written without a type",
        count(&rows.untyped),
    );
    losses.spines(morphology);
    Ok(losses.into_warnings())
}

/// Whether the samples of a soma would be read as another one: outlines of formats that have them.
fn is_read_otherwise(soma: &Soma) -> bool {
    let read = Soma::from_samples(soma.samples.clone());
    let most = 1e-4 * soma.radius.abs();
    (read.radius - soma.radius).abs() > most || read.center.distance(soma.center) > most
}

/// Which sections would be read as the soma's.
fn untyped(morphology: &Morphology) -> Vec<bool> {
    let mut untyped: Vec<bool> = Vec::with_capacity(morphology.sections.len());
    for section in &morphology.sections {
        let on_soma = match section.attachment {
            Attachment::Soma { .. } | Attachment::Free => true,
            Attachment::Section(parent) => untyped[parent.index()],
        };
        untyped.push(on_soma && section.kind == NeuriteKind::SOMA);
    }
    untyped
}

/// Numbers of the samples.
struct Ids {
    /// Of each soma's samples.
    somata: Vec<Vec<i64>>,
    /// Of the points.
    points: Vec<i64>,
}

impl Ids {
    fn of(morphology: &Morphology) -> Self {
        let own = |s: &Soma| s.samples.iter().map(|s| s.id).collect();
        let somata: Vec<Vec<i64>> = morphology.somata.iter().map(own).collect();
        let mut all: Vec<i64> = somata.iter().flatten().copied().collect();
        all.extend(&morphology.sample_ids);
        all.sort_unstable();
        let unique = all.windows(2).all(|w| w[0] < w[1]) && all.first().is_none_or(|&id| id >= 0);
        if unique && morphology.sample_ids.len() == morphology.points.len() {
            return Self {
                somata,
                points: morphology.sample_ids.clone(),
            };
        }
        let mut next = 1..;
        let somata = somata
            .iter()
            .map(|s| next.by_ref().take(s.len()).collect())
            .collect();
        let points = next.take(morphology.points.len()).collect();
        Self { somata, points }
    }
}

/// Where rows are written to.
struct Rows<'a, W: Write> {
    morphology: &'a Morphology,
    writer: BufWriter<W>,
    ids: Ids,
    /// The row being made.
    text: String,
    /// By soma: whether it is written as a sphere.
    is_sphere: Vec<bool>,
    /// By section: whether it is written without its type.
    untyped: Vec<bool>,
}

impl<W: Write> Rows<'_, W> {
    fn soma(&mut self, index: usize) -> io::Result<()> {
        let soma = &self.morphology.somata[index];
        if self.is_sphere[index] {
            let id = self.ids.somata[index][0];
            return self.row(id, 1, soma.center, soma.radius, -1);
        }
        for (i, sample) in soma.samples.iter().enumerate() {
            let ids = &self.ids.somata[index];
            let parent = sample.parent.map_or(-1, |p| ids[p as usize]);
            self.row(ids[i], 1, sample.position, sample.radius, parent)?;
        }
        Ok(())
    }

    fn section(&mut self, section: &Section, untyped: bool) -> io::Result<()> {
        let morphology = self.morphology;
        let kind = if untyped { 0 } else { section.kind.0 };
        let mut parent = match section.attachment {
            Attachment::Free => -1,
            Attachment::Soma { soma, .. } if self.is_sphere[soma as usize] => {
                self.ids.somata[soma as usize][0]
            }
            Attachment::Soma { soma, sample } => self.ids.somata[soma as usize][sample as usize],
            Attachment::Section(id) => {
                self.ids.points[morphology.sections[id.index()].end as usize - 1]
            }
        };
        for i in section.range() {
            let point = morphology.points[i];
            let id = self.ids.points[i];
            self.row(id, kind, point.position, point.radius, parent)?;
            parent = id;
        }
        Ok(())
    }

    fn row(
        &mut self,
        id: i64,
        kind: i32,
        position: glam::Vec3,
        radius: f32,
        parent: i64,
    ) -> io::Result<()> {
        use std::fmt::Write as _;
        let text = &mut self.text;
        text.clear();
        let _ = write!(text, "{id} {kind} "); // a String takes all
        for axis in 0..3 {
            decimal(text, position[axis], self.morphology.origin[axis]);
            text.push(' ');
        }
        decimal(text, radius, 0.0);
        let _ = writeln!(text, " {parent}");
        self.writer.write_all(text.as_bytes())
    }
}
