//! Writing SWC so that reading it back gives an equal morphology.
//!
//! Rows are the somata's samples, then the sections in the order of the file that was read, each without a gap: NEURON
//! and SONATA number sections by it, and NEURON 9.0.2 reads another cell where other rows stand between those of a section.
//! Coordinates are the shortest decimals that give the same `f32`, with the origin added and taken off again.

use std::io::{self, BufWriter, Write};

use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Piece, Soma};

use crate::Warning;
use crate::losses::Losses;
use crate::number::decimal;

/// Which numbers samples get.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleNumbers {
    /// Their own where these ascend from row to row; otherwise from 1 on, since NEURON refuses others or reads another cell.
    #[default]
    Ascending,
    /// Their own; from 1 on only where these repeat, are negative or too few.
    Kept,
}

/// Writes a morphology as SWC, its samples with numbers that ascend.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(morphology: &Morphology, writer: impl Write) -> io::Result<Vec<Warning>> {
    write_numbered(morphology, SampleNumbers::default(), writer)
}

/// Writes a morphology as SWC.
///
/// What SWC cannot say is returned: outlines of somata that would be read as something else,
/// which become a sphere of their radius, and neurites of type 1 on the soma, which get no type; only other
/// formats have those. Samples whose numbers are not kept are, too.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write_numbered(
    morphology: &Morphology,
    numbers: SampleNumbers,
    writer: impl Write,
) -> io::Result<Vec<Warning>> {
    let pieces = morphology.pieces_in_file_order();
    let mut rows = Rows {
        morphology,
        writer: BufWriter::with_capacity(1 << 16, writer),
        ids: Ids::of(morphology, &pieces, numbers),
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
    for piece in &pieces {
        rows.piece(piece)?;
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
    losses.add(
        "renumbered",
        "a sample's number is not kept",
        rows.ids.renumbered(morphology),
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
    fn of(morphology: &Morphology, pieces: &[Piece], numbers: SampleNumbers) -> Self {
        let own = |s: &Soma| s.samples.iter().map(|s| s.id).collect();
        let somata: Vec<Vec<i64>> = morphology.somata.iter().map(own).collect();
        let mut all: Vec<i64> = somata.iter().flatten().copied().collect();
        if morphology.sample_ids.len() == morphology.points.len() {
            let of_piece = |piece: &Piece| &morphology.sample_ids[piece.points.clone()];
            all.extend(pieces.iter().flat_map(of_piece));
            if numbers == SampleNumbers::Kept {
                all.sort_unstable();
            }
            let ascend = all.windows(2).all(|w| w[0] < w[1]);
            if ascend && all.first().is_none_or(|&id| id >= 0) {
                let points = morphology.sample_ids.clone();
                return Self { somata, points };
            }
        }
        let mut next = 1..;
        let somata = somata
            .iter()
            .map(|s| next.by_ref().take(s.len()).collect())
            .collect();
        let mut points = vec![0; morphology.points.len()];
        for point in pieces.iter().flat_map(|piece| piece.points.clone()) {
            points[point] = next.next().unwrap_or(i64::MAX);
        }
        Self { somata, points }
    }

    /// How many samples have other numbers than they had.
    fn renumbered(&self, morphology: &Morphology) -> u64 {
        let of_somata = morphology.somata.iter().flat_map(|soma| &soma.samples);
        let of_somata = of_somata
            .map(|sample| sample.id)
            .zip(self.somata.iter().flatten());
        let of_points = morphology.sample_ids.iter().copied().zip(&self.points);
        let all = of_somata.chain(of_points);
        all.filter(|(before, now)| before != *now).count() as u64
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

    fn piece(&mut self, piece: &Piece) -> io::Result<()> {
        let morphology = self.morphology;
        let kind = match self.untyped[piece.section.index()] {
            true => 0,
            false => morphology.sections[piece.section.index()].kind.0,
        };
        let on_soma = piece.attachment(morphology);
        let mut parent = match (on_soma, piece.branch_point(morphology)) {
            (Some(Attachment::Soma { soma, .. }), _) if self.is_sphere[soma as usize] => {
                self.ids.somata[soma as usize][0]
            }
            (Some(Attachment::Soma { soma, sample }), _) => {
                self.ids.somata[soma as usize][sample as usize]
            }
            (_, Some(point)) => self.ids.points[point],
            (_, None) => -1,
        };
        for i in piece.points.clone() {
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
