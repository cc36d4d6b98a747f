//! From flat nodes, as files have them, to the arrays of model 1.
//!
//! **Theory.** A node names its parent; whatever order the nodes come in, children keep theirs.
//! Samples of type 1 that hang together form a soma, one per tree; a tree whose soma is not its
//! root is hung up by the soma instead. What is left are the neurites, which are walked
//! depth-first and cut into sections at forks and where the type changes.
//!
//! **Practice.** Linear in the nodes but for a sort of the (few) somata, and iterative: a tree
//! 60,000 forks deep is a matter of a stack on the heap. Building what a writer made of a
//! [`Morphology`] gives an equal one; the rules that choose the main soma and the origin use only
//! what survives the rounding to `f32` for that reason.

mod marks;
mod notes;
mod origin;
mod sections;
mod size;
mod skeleton;
mod somata;
mod tree;
mod within;

use glam::DVec3;
use thiserror::Error;

pub use notes::{BuildNote, Oddity};

use crate::{
    Attachment, FileSection, FileSectionId, Morphology, NeuriteKind, Point, Section, SectionId,
    Soma, SomaSample,
};
use notes::Notes;
use origin::Frame;
use sections::Collector;
use size::Size;
use somata::Somata;
use tree::{Links, NONE};

/// One sample as a file gives it, its parent found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The file's own number of it.
    pub id: i64,
    /// What it belongs to.
    pub kind: NeuriteKind,
    /// Center (µm, the file's coordinates).
    pub position: DVec3,
    /// Radius (µm); zero or less is noted and kept.
    pub radius: f64,
    /// Index of the parent among the nodes.
    pub parent: Option<u32>,
    /// The section of the file that it is from, where the format has sections; none of a soma.
    pub section: Option<FileSectionId>,
}

/// What [`Morphology::from_nodes`] gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The arrays.
    pub morphology: Morphology,
    /// What was odd, each oddity once, in the order of [`Oddity`].
    pub notes: Vec<BuildNote>,
}

/// Why nodes are no morphology. `node` is an index into them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BuildError {
    /// The parent is not among the nodes.
    #[error("node {node}: its parent is not among the nodes")]
    UnknownParent {
        /// Index of the child.
        node: u32,
    },
    /// The node is an ancestor of itself.
    #[error("node {node}: it is its own ancestor")]
    Cycle {
        /// The first node of the cycle in the order given.
        node: u32,
    },
    /// A coordinate or the radius is not a number, or beyond [`Morphology::MAX_COORDINATE`].
    #[error("node {node}: a number is not finite or out of range")]
    OutOfRange {
        /// Index of the node.
        node: u32,
    },
    /// More nodes than 32 bits can count.
    #[error("{nodes} nodes are more than {max} can number", max = u32::MAX)]
    TooMany {
        /// How many there are.
        nodes: usize,
    },
}

impl Morphology {
    /// The greatest coordinate or radius (µm) taken: beyond, differences overflow `f32`.
    pub const MAX_COORDINATE: f64 = 1e37;

    /// Cells with a coordinate beyond this one (µm, as `f32`) get an origin of their own.
    pub const FARTHEST_UNSHIFTED: f32 = 4096.0;

    /// Orders nodes depth-first, cuts them into sections and tells the somata apart.
    ///
    /// Children keep the order of the nodes. No node gives an empty morphology.
    ///
    /// # Errors
    /// See [`BuildError`]; whatever is merely odd is told in [`Built::notes`].
    pub fn from_nodes(
        name: impl Into<String>,
        header: Vec<String>,
        nodes: &[Node],
    ) -> Result<Built, BuildError> {
        build(name.into(), header, nodes, Traced::Samples, &[])
    }

    /// Like [`from_nodes`](Self::from_nodes), for formats that trace somata as outlines: the
    /// samples of a soma are what [`Soma::from_outlines`] takes, whatever their radii. `sections`: those of the file, in
    /// its order, which nodes name ([`Node::section`]).
    ///
    /// # Errors
    /// See [`BuildError`].
    pub fn from_outlined_nodes(
        name: impl Into<String>,
        header: Vec<String>,
        nodes: &[Node],
        sections: &[FileSection],
    ) -> Result<Built, BuildError> {
        build(name.into(), header, nodes, Traced::Outlines, sections)
    }

    /// A tracing of nodes that come from another one, with its sections of the file.
    pub(crate) fn rebuilt(&self, nodes: &[Node], outlined: bool) -> Result<Built, BuildError> {
        let somata_are = match outlined {
            true => Traced::Outlines,
            false => Traced::Samples,
        };
        let known = self.known_file_sections();
        let (name, header) = (self.name.clone(), self.header.clone());
        let mut built = build(name, header, nodes, somata_are, &known.sections)?;
        built.morphology.file_sections.told = known.told;
        Ok(built)
    }
}

/// How a format traces somata.
#[derive(Clone, Copy)]
enum Traced {
    /// By samples of which each has a radius that means something.
    Samples,
    /// By outlines, perhaps several in a stack.
    Outlines,
}

fn build(
    name: String,
    header: Vec<String>,
    nodes: &[Node],
    somata_are: Traced,
    sections: &[FileSection],
) -> Result<Built, BuildError> {
    let mut parents = checked_parents(nodes)?;
    let mut links = Links::of(&parents);
    let order = tree::parents_first(&parents, &links)?;
    let mut notes = Notes::default();

    let mut somata = Somata::find(nodes, &parents, order.as_deref(), &mut notes);
    let typed = !nodes.iter().all(is_soma);
    // Formats with outlines name the soma, so that no region's index is taken for it.
    if !typed && matches!(somata_are, Traced::Samples) {
        within::neurites_of_type_1(&mut somata, nodes, &parents, &mut notes);
    }
    if tree::hang_up_by(&mut parents, &somata.tops) {
        links = Links::of(&parents);
    }
    if matches!(somata_are, Traced::Samples) {
        if typed && somata.gather_marks(nodes, &mut parents) {
            links = Links::of(&parents);
        }
        somata.merge_coincident(nodes, &mut notes);
    }
    if let [_, second, ..] = &somata.members[..] {
        let count = somata.members.len() as u64;
        notes.add_many(Oddity::SeveralSomata, second[0], count);
    }
    let roots = match somata_are {
        Traced::Samples => within::RootsInSomata::find(nodes, &parents, &somata, &mut notes),
        Traced::Outlines => within::RootsInSomata::default(),
    };
    let walk = Walk {
        nodes,
        parents: &parents,
        links: &links,
        somata: &somata,
        roots: &roots,
        typed,
    };
    let starts = walk.starts(&mut notes);
    let frame = Frame::choose(nodes, walk.anchor(&starts));

    let mut morphology = Morphology {
        name,
        origin: frame.origin,
        somata: walk.somata(&frame, somata_are, &mut notes),
        header,
        ..Morphology::default()
    };
    let mut collector = Collector::new(sections, nodes.len());
    walk.neurites(&starts, &frame, &mut morphology, &mut collector);
    morphology.file_sections = collector.finish(&morphology.sections);
    let is_of_soma = |i: u32| is_soma(&nodes[i as usize]) && somata.of(i) != NONE;
    notes.radii(nodes, is_of_soma);
    if morphology.somata.is_empty() {
        skeleton::note(nodes, &mut notes);
    }
    match size::size(nodes, is_of_soma) {
        Size::Plausible => {}
        Size::TooLarge => notes.add(Oddity::TooLarge, 0),
        Size::TooSmall => notes.add(Oddity::TooSmall, 0),
    }
    Ok(Built {
        morphology,
        notes: notes.into_vec(),
    })
}

/// Parents with [`NONE`] for "has none"; everything about single nodes is checked here.
fn checked_parents(nodes: &[Node]) -> Result<Vec<u32>, BuildError> {
    if nodes.len() >= NONE as usize {
        return Err(BuildError::TooMany { nodes: nodes.len() });
    }
    let checked = |(i, node): (usize, &Node)| {
        let largest = node.position.abs().max_element().max(node.radius.abs());
        let nan = node.position.is_nan() || node.radius.is_nan();
        if nan || largest > Morphology::MAX_COORDINATE {
            return Err(BuildError::OutOfRange { node: i as u32 });
        }
        match node.parent {
            Some(p) if p as usize >= nodes.len() => {
                Err(BuildError::UnknownParent { node: i as u32 })
            }
            Some(p) => Ok(p),
            None => Ok(NONE),
        }
    };
    nodes.iter().enumerate().map(checked).collect()
}

/// All that is known when the arrays are filled.
struct Walk<'a> {
    nodes: &'a [Node],
    parents: &'a [u32],
    links: &'a Links,
    somata: &'a Somata,
    roots: &'a within::RootsInSomata,
    /// Whether types say anything: they do not where all are the soma's.
    typed: bool,
}

impl Walk<'_> {
    /// First nodes of the neurites, in the order given.
    fn starts(&self, notes: &mut Notes) -> Vec<u32> {
        let mut starts = Vec::new();
        let (mut first_free, mut free) = (NONE, 0);
        for (i, &parent) in (0_u32..).zip(self.parents) {
            if self.somata.of(i) != NONE {
                continue;
            }
            if self.roots.member(i).is_some() {
                starts.push(i);
            } else if parent == NONE {
                free += 1;
                first_free = first_free.min(i);
                starts.push(i);
            } else if self.somata.of(parent) != NONE {
                starts.push(i);
            }
        }
        let lone_tree = self.somata.members.is_empty() && free == 1;
        if free > 0 && !lone_tree {
            notes.add_many(Oddity::Disconnected, first_free, free);
        }
        starts
    }

    /// The node that the origin is put near: the main soma's first sample, else the first point.
    fn anchor(&self, starts: &[u32]) -> Option<DVec3> {
        let soma = self.somata.members.first().and_then(|m| m.first());
        let node = soma.or(starts.first())?;
        Some(self.nodes[*node as usize].position)
    }

    fn somata(&self, frame: &Frame, traced: Traced, notes: &mut Notes) -> Vec<Soma> {
        let soma = |members: &Vec<u32>| {
            let sample = |&m: &u32| {
                let node = &self.nodes[m as usize];
                let parent = self.parents[m as usize];
                SomaSample {
                    id: node.id,
                    position: frame.place(node.position),
                    radius: node.radius as f32,
                    parent: (parent != NONE).then(|| self.somata.sample(parent)),
                }
            };
            let samples = members.iter().map(sample).collect();
            match traced {
                Traced::Samples => {
                    let soma = Soma::from_samples(samples);
                    notes.fork(&soma, members);
                    notes.soma(&soma, members);
                    soma
                }
                Traced::Outlines => {
                    let soma = Soma::from_outlines(samples);
                    notes.soma(&soma, members);
                    soma
                }
            }
        };
        self.somata.members.iter().map(soma).collect()
    }

    /// Depth first; the stack holds the first nodes of sections still to come.
    fn neurites(
        &self,
        starts: &[u32],
        frame: &Frame,
        into: &mut Morphology,
        collector: &mut Collector<'_>,
    ) {
        into.points.reserve_exact(self.nodes.len());
        into.sample_ids.reserve_exact(self.nodes.len());
        let mut stack = Vec::new();
        for &start in starts {
            stack.push((start, self.attachment(start)));
            while let Some((first, attachment)) = stack.pop() {
                let id = SectionId(into.sections.len() as u32);
                let last = self.section(first, attachment, frame, into, collector);
                let pushed = stack.len();
                let children = self.links.children(last);
                stack.extend(children.map(|child| (child, Attachment::Section(id))));
                stack[pushed..].reverse();
            }
        }
    }

    fn attachment(&self, start: u32) -> Attachment {
        let on = match self.parents[start as usize] {
            NONE => self.roots.member(start),
            parent => Some(parent),
        };
        match on {
            None => Attachment::Free,
            Some(p) => Attachment::Soma {
                soma: self.somata.of(p),
                sample: self.somata.sample(p),
            },
        }
    }

    /// Appends one section and returns its last node.
    fn section(
        &self,
        first_node: u32,
        attachment: Attachment,
        frame: &Frame,
        into: &mut Morphology,
        collector: &mut Collector<'_>,
    ) -> u32 {
        let traced = self.nodes[first_node as usize].kind;
        let kind = match self.typed {
            true => traced,
            false => NeuriteKind::UNDEFINED,
        };
        let first = into.points.len() as u32;
        let mut at = first_node;
        loop {
            let node = &self.nodes[at as usize];
            collector.push(node);
            let position = frame.place(node.position);
            into.points.push(Point {
                position,
                radius: node.radius as f32,
            });
            into.sample_ids.push(node.id);
            match self.links.only_child(at) {
                Some(child) if self.nodes[child as usize].kind == traced => at = child,
                _ => break,
            }
        }
        let end = into.points.len() as u32;
        let id = SectionId(into.sections.len() as u32);
        collector.end_section(id, first as usize..end as usize, first_node);
        into.sections.push(Section {
            kind,
            attachment,
            first,
            end,
        });
        at
    }
}

/// Whether a sample belongs to a soma by its type.
fn is_soma(node: &Node) -> bool {
    node.kind == NeuriteKind::SOMA
}
