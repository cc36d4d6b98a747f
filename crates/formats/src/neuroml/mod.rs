//! NeuroML 2 and 1: cells of segments, frusta that hang on one another anywhere along their parent.
//!
//! A segment has a distal end, and a proximal one where that is not its parent's; both give
//! **diameters** in µm. One that begins part of the way along its parent gets a point of its own
//! there, so the parent's frustum is cut in two of the same shape. One whose proximal end is apart from
//! its parent is a tree of its own, for the way between them is no neurite. A root that ends where it begins
//! is a spherical soma. What a segment is is told by its groups, else by its name. Of several cells
//! the first is read, and networks are left out, both with a warning.

mod joints;
mod kinds;
mod layout;
mod members;
mod order;
mod records;
mod scan;
mod version_1;
mod write;

use neurotess_morphology::{BuildError, Morphology, NeuriteKind, Node};

use crate::sample::Sample;
use crate::text::Located;
use crate::warning::Warnings;
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text, xml};
use joints::Joint;
use layout::Layout;
use records::Records;
pub use write::write;

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_text(Format::NeuroMl, name, options, |name, warnings| {
        interpret(bytes, name, warnings)
    })
}

fn interpret(bytes: &[u8], name: &str, warnings: &mut Warnings) -> Located<Morphology> {
    let text = xml::text(bytes)?;
    let records = scan::records(&text)?;
    if records.segments.is_empty() {
        return Err((1, Fault::NoMorphology));
    }
    if records.morphologies > 1 {
        warnings.add_many(
            records.second,
            "other_cells_left_out",
            "another cell in the file: only the first is read",
            records.morphologies - 1,
        );
    }
    if records.instances > 0 {
        warnings.add_many(
            records.first_instance,
            "network_left_out",
            "a cell of a network: places are not read",
            records.instances,
        );
    }
    let layout = Layout::of(&records)?;
    if let Some((line, count)) = layout.gaps {
        warnings.add_many(
            line,
            "gap",
            "a segment that begins apart from its parent: a tree of its own, the way there is no neurite",
            count,
        );
    }
    let (nodes, lines) = nodes(&records, &layout);
    let header = records.notes.lines().map(|l| l.trim().to_owned());
    let header = header.filter(|l| !l.is_empty()).collect();
    let built = Morphology::from_nodes(name, header, &nodes).map_err(|e| match e {
        BuildError::Cycle { node } | BuildError::OutOfRange { node } => {
            (lines[node as usize], Fault::OwnAncestor)
        }
        BuildError::UnknownParent { .. } | BuildError::TooMany { .. } => (1, Fault::TooMany),
    })?;
    warnings.add_notes(built.notes, |node| lines[node as usize]);
    Ok(built.morphology)
}

/// Nodes and their lines.
fn nodes(records: &Records, layout: &Layout) -> (Vec<Node>, Vec<u64>) {
    let mut made = Made::default();
    let mut stations: Vec<Stations> = vec![Vec::new(); records.segments.len()];
    for &i in &layout.order {
        let kind = layout.kinds[i];
        let [start, distal] = layout.ends[i];
        let parent = layout.parents[i];
        let hung = match (parent, layout.joints[i]) {
            (Some(p), Joint::Along(along)) => Some((at(&stations[p], along), layout.kinds[p])),
            (_, Joint::None) | (None, _) => None,
        };
        let own = made.start(start, kind, hung);
        let start = made.sample(own);
        let mut here = own;
        let mut places = vec![(0.0, own)];
        // A point of its own that the segment also ends at.
        let sphere = hung.is_none_or(|(on, _)| on != own) && same(&start, &distal);
        let between = if sphere { &[][..] } else { &layout.inner[i] };
        for &along in between {
            here = made.push(joints::along(&start, &distal, along), kind, Some(here));
            places.push((along, here));
        }
        if !sphere {
            here = made.push(distal, kind, Some(here));
        }
        places.push((1.0, here));
        stations[i] = places;
    }
    (made.nodes, made.lines)
}

/// A segment's nodes, once they are made: where along it they are, and their index.
type Stations = Vec<(f64, u32)>;

/// The station nearest to a place along the segment.
fn at(stations: &Stations, along: f64) -> u32 {
    let off = |s: &&(f64, u32)| (s.0 - along).abs();
    let nearest = stations.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.map_or(0, |s| s.1)
}

fn same(a: &Sample, b: &Sample) -> bool {
    a.position == b.position && a.radius == b.radius
}

#[derive(Default)]
struct Made {
    nodes: Vec<Node>,
    lines: Vec<u64>,
}

impl Made {
    /// The node that a segment starts at: its parent's where both are one point of one thing, else
    /// one of its own.
    fn start(&mut self, start: Sample, kind: NeuriteKind, hung: Option<(u32, NeuriteKind)>) -> u32 {
        let Some((on, parents_kind)) = hung else {
            return self.push(start, kind, None);
        };
        // A neurite's way through its soma is no part of it.
        if same(&start, &self.sample(on)) && !joints::leaves_soma(parents_kind, kind) {
            return on;
        }
        self.push(start, kind, Some(on))
    }

    fn push(&mut self, sample: Sample, kind: NeuriteKind, parent: Option<u32>) -> u32 {
        let index = self.nodes.len() as u32;
        self.nodes.push(Node {
            id: i64::from(index) + 1,
            kind,
            position: sample.position,
            radius: sample.radius,
            parent,
            section: None,
        });
        self.lines.push(sample.line);
        index
    }

    fn sample(&self, node: u32) -> Sample {
        let at = &self.nodes[node as usize];
        Sample {
            position: at.position,
            radius: at.radius,
            line: self.lines[node as usize],
        }
    }
}
