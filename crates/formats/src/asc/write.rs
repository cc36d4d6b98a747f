//! Writing Neurolucida ASC.

use std::io::{self, BufWriter, Write};

use neurotess_morphology::{Morphology, NeuriteKind};

use crate::Warning;
use crate::losses::Losses;
use crate::number::decimal;
use crate::outlines::outlines;

/// Deepest indentation; deep trees would be all blanks.
const DEEPEST: usize = 20;

/// Writes a morphology as ASC; children begin with a copy of the point that they branch from, so
/// that every reader sees the same frusta. What the format cannot say is returned: numbers of
/// samples, types that change within a tree, custom types, somata other than outlines.
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
        text: String::new(),
    };
    for line in &morphology.header {
        for line in line.split(['\n', '\r']) {
            writeln!(file.writer, "; {line}")?;
        }
    }
    for outline in outlines(morphology) {
        writeln!(file.writer, "(\"CellBody\"\n  (Color Red)\n  (CellBody)")?;
        for (position, radius) in outline {
            file.point(1, position, radius)?;
        }
        writeln!(file.writer, ")")?;
    }
    let mut losses = Losses::of(morphology);
    let retyped = file.trees()?;
    file.writer.flush()?;
    losses.add(
        "types_changed",
        "a section is written with its tree's type or as a dendrite",
        retyped,
    );
    Ok(losses.into_warnings())
}

/// Word of a tree's type; `None` where the format has none.
fn word(kind: NeuriteKind) -> Option<&'static str> {
    match kind {
        NeuriteKind::AXON => Some("(Color Blue)\n  (Axon)"),
        NeuriteKind::BASAL_DENDRITE => Some("(Color Red)\n  (Dendrite)"),
        NeuriteKind::APICAL_DENDRITE => Some("(Color Magenta)\n  (Apical)"),
        _ => None,
    }
}

struct File<'a, W: Write> {
    morphology: &'a Morphology,
    writer: BufWriter<W>,
    /// The row being made.
    text: String,
}

impl<W: Write> File<'_, W> {
    /// All trees; how many sections are not of the type that they are written with.
    fn trees(&mut self) -> io::Result<u64> {
        let morphology = self.morphology;
        let pieces = morphology.pieces();
        let mut children = vec![0_u32; morphology.points.len()];
        for fork in pieces
            .iter()
            .filter_map(|piece| piece.branch_point(morphology))
        {
            children[fork] += 1;
        }
        // Of each open fork: how many children are still to come.
        let mut open: Vec<u32> = Vec::new();
        let mut kind = NeuriteKind::UNDEFINED;
        let mut retyped = 0;
        for piece in &pieces {
            let section = &morphology.sections[piece.section.index()];
            let forks = children[piece.points.end - 1];
            match piece.branch_point(morphology) {
                Some(fork) => {
                    let fork = morphology.points[fork];
                    self.point(open.len(), fork.position, fork.radius)?;
                }
                None => {
                    // No type at all reads back as none; a custom one would be lost in silence.
                    kind = section.kind;
                    let custom = kind != NeuriteKind::UNDEFINED && word(kind).is_none();
                    kind = if custom {
                        NeuriteKind::BASAL_DENDRITE
                    } else {
                        kind
                    };
                    let word = word(kind).unwrap_or("(Color White)");
                    writeln!(self.writer, "( {word}")?;
                }
            }
            retyped += u64::from(section.kind != kind);
            for point in &morphology.points[piece.points.clone()] {
                self.point(open.len(), point.position, point.radius)?;
            }
            if forks > 0 {
                self.line(open.len(), "(")?;
                open.push(forks);
                continue;
            }
            loop {
                let Some(left) = open.last_mut() else {
                    writeln!(self.writer, ")")?;
                    break;
                };
                *left -= 1;
                if *left > 0 {
                    self.line(open.len() - 1, "|")?;
                    break;
                }
                open.pop();
                self.line(open.len(), ")")?;
            }
        }
        Ok(retyped)
    }

    fn line(&mut self, depth: usize, word: &str) -> io::Result<()> {
        let indent = 2 * (depth + 1).min(DEEPEST);
        writeln!(self.writer, "{:indent$}{word}", "")
    }

    fn point(&mut self, depth: usize, position: glam::Vec3, radius: f32) -> io::Result<()> {
        let mut text = std::mem::take(&mut self.text);
        text.clear();
        text.push('(');
        for axis in 0..3 {
            decimal(&mut text, position[axis], self.morphology.origin[axis]);
            text.push(' ');
        }
        decimal(&mut text, 2.0 * radius, 0.0);
        text.push(')');
        let written = self.line(depth, &text);
        self.text = text;
        written
    }
}
