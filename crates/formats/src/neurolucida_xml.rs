//! Neurolucida XML of MBF Bioscience: contours, and trees of nested branches, as Neurolucida ASC has them, with
//! diameters `d` in µm. The format has no public specification; what follows is what files have.
//!
//! Contours named `CellBody`, `Cell Body` or `Soma` are outlines of the soma. A tree's type says what it is. Markers and
//! other contours are left out with a count; spines are places beside the tree.

use neurotess_morphology::NeuriteKind;

use crate::named::Part as Named;
use crate::sample::Sample;
use crate::text::Located;
use crate::traced::{SPINES_LEFT_OUT, Tracing};
use crate::warning::Warnings;
use crate::xml::{Document, Element, Part};
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text, xml};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_text(Format::NeurolucidaXml, name, options, |name, warnings| {
        let text = xml::text(bytes)?;
        let tracing = Tracer::trace(&text, warnings)?;
        if tracing.outlines.is_empty() && tracing.points.is_empty() {
            let (root, element) = ("mbf", "tree");
            return Err((1, Fault::NoElement { root, element }));
        }
        tracing.build(name, warnings)
    })
}

/// What points belong to.
enum Open {
    /// A soma's outline.
    Outline(Vec<Sample>),
    /// A tree or a branch of one: the point that the next one hangs on, and whether that is the first of it.
    Branch { last: Option<u32>, starts: bool },
    /// A spine, which ends at its last point.
    Spine(Option<Sample>),
    /// The file's description, which is kept.
    Description,
    /// Whatever else.
    Other,
}

struct Tracer<'w> {
    tracing: Tracing,
    /// What is open, the outermost first.
    open: Vec<Open>,
    /// Of the tree that is open.
    kind: NeuriteKind,
    warnings: &'w mut Warnings,
}

impl<'w> Tracer<'w> {
    fn trace(text: &str, warnings: &'w mut Warnings) -> Located<Tracing> {
        let mut document = Document::new(text);
        let mut tracer = Self {
            tracing: Tracing::default(),
            open: Vec::new(),
            kind: NeuriteKind::UNDEFINED,
            warnings,
        };
        while let Some(part) = document.next_part()? {
            match part {
                Part::Begin(element) => tracer.begin(&element)?,
                Part::End => tracer.end(),
                Part::Text(text) => tracer.text(&text),
            }
        }
        Ok(tracer.tracing)
    }

    fn begin(&mut self, element: &Element) -> Located<()> {
        let within = self.open.last();
        let open = match &*element.name {
            "contour" => self.contour(element),
            "tree" => self.tree(element),
            "branch" => match within {
                Some(&Open::Branch { last, .. }) => Open::Branch { last, starts: true },
                _ => Open::Other,
            },
            "description" if within.is_some() => Open::Description,
            "spine" => {
                let (code, message) = SPINES_LEFT_OUT;
                self.warnings.add(element.line, code, message);
                Open::Spine(None)
            }
            "marker" => {
                let message = "a marker: left out";
                self.warnings.add(element.line, "markers_left_out", message);
                Open::Other
            }
            "point" => {
                self.point(element)?;
                Open::Other
            }
            _ => Open::Other,
        };
        self.open.push(open);
        Ok(())
    }

    fn contour(&mut self, element: &Element) -> Open {
        let name = element.attribute("name").unwrap_or_default();
        if Named::of_name(&name) == Some(Named::Soma) {
            return Open::Outline(Vec::new());
        }
        self.warnings.add(
            element.line,
            "contours_left_out",
            "a contour that is not of a soma: left out",
        );
        Open::Other
    }

    fn tree(&mut self, element: &Element) -> Open {
        let named = element.attribute("type").unwrap_or_default();
        let named = Named::of_name(&named).filter(|&named| named != Named::Soma);
        if named.is_none() {
            self.warnings.add(
                element.line,
                "untyped_tree",
                "a tree of no type: taken as undefined",
            );
        }
        self.kind = named.map_or(NeuriteKind::UNDEFINED, Named::kind);
        let (last, starts) = (None, true);
        Open::Branch { last, starts }
    }

    fn point(&mut self, element: &Element) -> Located<()> {
        let kind = self.kind;
        let within = match self.open.last_mut() {
            None | Some(Open::Other | Open::Description) => return Ok(()),
            Some(within) => within,
        };
        let sample = Sample {
            position: element.reals(["x", "y", "z"])?,
            radius: element.radius_if_any("d")?.unwrap_or(0.0) / 2.0,
            line: element.line,
        };
        match within {
            Open::Outline(outline) => outline.push(sample),
            Open::Spine(end) => *end = Some(sample),
            Open::Branch { last, starts } => {
                let starts = std::mem::take(starts);
                *last = Some(self.tracing.push(sample, kind, *last, starts));
            }
            Open::Description | Open::Other => {}
        }
        Ok(())
    }

    fn text(&mut self, text: &str) {
        if let Some(Open::Description) = self.open.last() {
            let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
            self.tracing.header.extend(lines.map(str::to_owned));
        }
    }

    fn end(&mut self) {
        match self.open.pop() {
            Some(Open::Outline(outline)) if !outline.is_empty() => {
                self.tracing.outlines.push(outline);
            }
            Some(Open::Spine(Some(end))) => self.tracing.spines.push(end.position),
            _ => {}
        }
    }
}
