//! Records of formats that trace neurons as points, each with its parent: one tree or several.

use std::collections::HashMap;

use neurotess_morphology::{BuildError, Morphology, NeuriteKind, Node};

use crate::Fault;
use crate::sample::Sample;
use crate::text::Located;
use crate::warning::Warnings;

/// Traced points in the order of the file.
#[derive(Default)]
pub(crate) struct Forest {
    nodes: Vec<Node>,
    lines: Vec<u64>,
    /// Comments to keep.
    pub(crate) header: Vec<String>,
}

impl Forest {
    /// Appends a point and gives its index. One without radius has 0, which is told as such.
    pub(crate) fn push(
        &mut self,
        id: i64,
        kind: NeuriteKind,
        sample: Sample,
        parent: Option<u32>,
    ) -> u32 {
        let index = self.nodes.len() as u32;
        self.nodes.push(Node {
            id,
            kind,
            position: sample.position,
            radius: sample.radius,
            parent,
            section: None,
        });
        self.lines.push(sample.line);
        index
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(crate) fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    pub(crate) fn line(&self, index: u32) -> u64 {
        self.lines[index as usize]
    }

    pub(crate) fn set_parent(&mut self, index: u32, parent: u32) {
        self.nodes[index as usize].parent = Some(parent);
    }

    #[cfg(feature = "json")]
    pub(crate) fn set_radius(&mut self, index: u32, radius: f64) {
        self.nodes[index as usize].radius = radius;
    }

    /// Index of the point of each number, those from `first` on.
    pub(crate) fn by_number(&self, first: u32) -> Located<HashMap<i64, u32>> {
        let mut index = HashMap::new();
        for i in first..self.nodes.len() as u32 {
            let id = self.node(i).id;
            if let Some(other) = index.insert(id, i) {
                let first_line = self.line(other);
                return Err((self.line(i), Fault::RepeatedId { id, first_line }));
            }
        }
        Ok(index)
    }

    /// Gives edges a direction, away from `first` and from the first node of each further tree; edges that close loops are
    /// left out, and told by the line of the first.
    pub(crate) fn direct(
        &mut self,
        links: &[[u32; 2]],
        first: u32,
        line: impl Fn(usize) -> u64,
        warnings: &mut Warnings,
    ) {
        let count = self.len();
        let mut beside: Vec<Vec<(u32, usize)>> = vec![Vec::new(); count];
        for (edge, &[a, b]) in links.iter().enumerate() {
            beside[a as usize].push((b, edge));
            beside[b as usize].push((a, edge));
        }
        let mut reached = vec![false; count];
        let mut used = vec![false; links.len()];
        let mut open = Vec::new();
        for root in std::iter::once(first).chain(0..count as u32) {
            if std::mem::replace(&mut reached[root as usize], true) {
                continue;
            }
            open.push(root);
            while let Some(node) = open.pop() {
                for &(other, edge) in &beside[node as usize] {
                    if !std::mem::replace(&mut reached[other as usize], true) {
                        used[edge] = true;
                        self.set_parent(other, node);
                        open.push(other);
                    }
                }
            }
        }
        let mut loops = used.iter().enumerate().filter(|(_, used)| !**used);
        if let Some((edge, _)) = loops.next() {
            let message = "an edge that closes a loop: left out, for trees have none";
            let count = 1 + loops.count() as u64;
            warnings.add_many(line(edge), "loops_left_out", message, count);
        }
    }

    /// The morphology, its oddities told to `warnings`.
    pub(crate) fn build(self, name: &str, warnings: &mut Warnings) -> Located<Morphology> {
        let Self {
            nodes,
            lines,
            header,
        } = self;
        if nodes.is_empty() {
            return Err((1, Fault::NoSample));
        }
        let line = |node: u32| lines[node as usize];
        let built = Morphology::from_nodes(name, header, &nodes).map_err(|e| match e {
            BuildError::Cycle { node } => {
                let id = nodes[node as usize].id;
                (line(node), Fault::Cycle { id })
            }
            BuildError::OutOfRange { node } => {
                let (column, text) = ("a number", "too large".into());
                (line(node), Fault::OutOfRange { column, text })
            }
            BuildError::UnknownParent { .. } | BuildError::TooMany { .. } => (1, Fault::TooMany),
        })?;
        warnings.add_notes(built.notes, line);
        Ok(built.morphology)
    }
}
