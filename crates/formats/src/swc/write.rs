//! Writing SWC so that reading it back gives an equal morphology.
//!
//! Rows are the soma's samples, then the points in depth-first order. Numbers are the shortest
//! decimals that give the same `f32`, with the origin added and taken off again.

use std::io::{self, BufWriter, Write};

use neurotess_morphology::{Attachment, Morphology, Section};

use crate::number::decimal;

/// Writes a morphology as SWC.
///
/// Samples keep their numbers; where these repeat, are negative or too few, the rows are numbered
/// from 1 on. A neurite of type 1 on the soma, which only other formats can have, becomes a part of
/// the soma.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(morphology: &Morphology, writer: impl Write) -> io::Result<()> {
    let mut rows = Rows {
        morphology,
        writer: BufWriter::with_capacity(1 << 16, writer),
        ids: Ids::of(morphology),
        text: String::new(),
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
    for section in &morphology.sections {
        rows.section(section)?;
    }
    rows.writer.flush()
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
        let own = |s: &neurotess_morphology::Soma| s.samples.iter().map(|s| s.id).collect();
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
}

impl<W: Write> Rows<'_, W> {
    fn soma(&mut self, index: usize) -> io::Result<()> {
        let soma = &self.morphology.somata[index];
        for (i, sample) in soma.samples.iter().enumerate() {
            let ids = &self.ids.somata[index];
            let parent = sample.parent.map_or(-1, |p| ids[p as usize]);
            self.row(ids[i], 1, sample.position, sample.radius, parent)?;
        }
        Ok(())
    }

    fn section(&mut self, section: &Section) -> io::Result<()> {
        let morphology = self.morphology;
        let mut parent = match section.attachment {
            Attachment::Free => -1,
            Attachment::Soma { soma, sample } => self.ids.somata[soma as usize][sample as usize],
            Attachment::Section(id) => {
                self.ids.points[morphology.sections[id.index()].end as usize - 1]
            }
        };
        for i in section.range() {
            let point = morphology.points[i];
            let id = self.ids.points[i];
            self.row(id, section.kind.0, point.position, point.radius, parent)?;
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
