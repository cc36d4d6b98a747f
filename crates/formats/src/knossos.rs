//! Skeletons of webKnossos and KNOSSOS, `.nml` as NeuroML has it: things of nodes, and edges without a direction
//! (<https://docs.webknossos.org>, NML files).
//!
//! Coordinates are voxels, and `<scale>` says how large one is: nanometers, unless it names a unit. Radii are in that
//! unit in webKnossos; KNOSSOS, which tells its version in `<createdin>` or `<lastsavedin>`, has voxels along x. Each
//! thing is a tree, and all things are one cell. What a thing is, is told by its name; a node that is commented `soma` is
//! the soma.

use std::collections::HashSet;

use glam::DVec3;
use neurotess_morphology::NeuriteKind;

use crate::forest::Forest;
use crate::named::Part as Named;
use crate::sample::Sample;
use crate::text::Located;
use crate::unit::micrometers;
use crate::warning::Warnings;
use crate::xml::{Document, Element, Part};
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text, xml};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_text(Format::Knossos, name, options, |name, warnings| {
        let text = xml::text(bytes)?;
        let records = Records::of(&text)?;
        if records.nodes.is_empty() {
            let (root, element) = ("things", "node");
            return Err((1, Fault::NoElement { root, element }));
        }
        records.forest(warnings)?.build(name, warnings)
    })
}

/// What is of interest in a file.
#[derive(Default)]
struct Records {
    /// Size of a voxel and micrometers in its unit.
    scale: Option<(DVec3, f64)>,
    is_desktop: bool,
    /// What the thing is whose nodes come.
    named: Option<Named>,
    nodes: Vec<(i64, NeuriteKind, Sample)>,
    edges: Vec<Edge>,
    /// Nodes that comments call somata.
    somata: HashSet<i64>,
}

struct Edge {
    line: u64,
    ends: [i64; 2],
}

impl Records {
    fn of(text: &str) -> Located<Self> {
        let mut document = Document::new(text);
        let mut records = Self::default();
        while let Some(part) = document.next_part()? {
            if let Part::Begin(element) = part {
                let [_, parent] = document.parents();
                records.element(&element, parent)?;
            }
        }
        Ok(records)
    }

    fn element(&mut self, element: &Element, parent: &str) -> Located<()> {
        match (parent, &*element.name) {
            ("parameters", "scale") => {
                let unit = element.attribute("unit");
                let factor = micrometers(unit.as_deref().unwrap_or("nm"));
                let fault = || element.fault("unit", unit.unwrap_or_default());
                let factor = factor.ok_or_else(fault)?;
                self.scale = Some((element.reals(["x", "y", "z"])?, factor));
            }
            ("parameters", "createdin" | "lastsavedin") => self.is_desktop = true,
            (_, "thing") => {
                let name = element.attribute("name").unwrap_or_default();
                self.named = Named::of_name(&name);
            }
            ("nodes", "node") => {
                let sample = Sample {
                    position: element.reals(["x", "y", "z"])?,
                    radius: element.radius_if_any("radius")?.unwrap_or(0.0),
                    line: element.line,
                };
                let kind = self.named.map_or(NeuriteKind::UNDEFINED, Named::kind);
                self.nodes.push((element.whole("id")?, kind, sample));
            }
            ("edges", "edge") => self.edges.push(Edge {
                line: element.line,
                ends: [element.whole("source")?, element.whole("target")?],
            }),
            ("comments", "comment") => {
                let content = element.attribute("content").unwrap_or_default();
                let letters = content.chars().filter(char::is_ascii_alphabetic);
                let letters: String = letters.collect::<String>().to_ascii_lowercase();
                if letters == "soma" || letters == "cellbody" {
                    self.somata.extend(element.whole_if_any("node")?);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn forest(self, warnings: &mut Warnings) -> Located<Forest> {
        if self.scale.is_none() {
            let message = "no <scale>: voxels are taken as micrometers";
            warnings.add(1, "unknown_unit", message);
        }
        let (voxel, unit) = self.scale.unwrap_or((DVec3::ONE, 1.0));
        let radius_unit = if self.is_desktop {
            voxel.x * unit
        } else {
            unit
        };
        let mut forest = Forest::default();
        for &(id, kind, sample) in &self.nodes {
            let sample = Sample {
                position: sample.position * voxel * unit,
                radius: sample.radius * radius_unit,
                line: sample.line,
            };
            // A mark without a size would be a soma of none.
            let soma = self.somata.contains(&id) && sample.radius > 0.0;
            let kind = if soma { NeuriteKind::SOMA } else { kind };
            forest.push(id, kind, sample, None);
        }
        let links = self.links(&forest)?;
        let line = |edge: usize| self.edges.get(edge).map_or(1, |edge| edge.line);
        forest.direct(&links, 0, line, warnings);
        Ok(forest)
    }

    /// The nodes at the ends of each edge.
    fn links(&self, forest: &Forest) -> Located<Vec<[u32; 2]>> {
        let index = forest.by_number(0)?;
        let node = |edge: &Edge, id: i64| {
            let unknown = (edge.line, Fault::UnknownEnd { id });
            index.get(&id).copied().ok_or(unknown)
        };
        let links = self.edges.iter().map(|edge| {
            let [source, target] = edge.ends;
            Ok([node(edge, source)?, node(edge, target)?])
        });
        links.collect()
    }
}
