//! A tracing taken apart into the nodes that a file would have, and put together again.

use std::collections::HashSet;

use glam::DVec3;

use super::EditError;
use crate::{
    Attachment, BuildError, FileSectionId, Morphology, NeuriteKind, Node, Point, SectionId, Soma,
};

/// The nodes of a tracing: the samples of its somata, then its points in depth-first order.
pub(super) struct Nodes {
    pub(super) nodes: Vec<Node>,
    /// So many of them, the first, belong to somata. Parents of the others stand before their children.
    pub(super) somata: usize,
    /// Places of spines that are not in the tree (µm, the file's coordinates).
    pub(super) spines: Vec<DVec3>,
    /// Whether the somata were traced as outlines.
    outlined: bool,
}

/// What an edit makes of nodes.
pub(super) struct Edits {
    pub(super) nodes: Vec<Node>,
    /// Places of spines that are not in the tree, where they are others now.
    pub(super) spines: Option<Vec<DVec3>>,
    /// How far the tracing has moved (µm), where its nodes do not tell because others have taken their places.
    pub(super) largest_move: Option<f64>,
    /// So many of the nodes are new; counted only by edits that also take some away.
    pub(super) came: usize,
    /// Samples or pieces that the edit could not mend.
    pub(super) left: usize,
    /// Whether samples get new numbers.
    pub(super) renumbered: bool,
}

impl Edits {
    /// Edited nodes, each in the place of the one it was.
    pub(super) fn in_place(nodes: Vec<Node>) -> Self {
        Self {
            nodes,
            spines: None,
            largest_move: None,
            came: 0,
            left: 0,
            renumbered: false,
        }
    }
}

impl Nodes {
    pub(super) fn of(morphology: &Morphology) -> Self {
        let mut nodes = Vec::new();
        let mut first_of_soma = Vec::with_capacity(morphology.somata.len());
        for soma in &morphology.somata {
            let first = nodes.len() as u32;
            first_of_soma.push(first);
            nodes.extend(soma.samples.iter().map(|sample| Node {
                id: sample.id,
                kind: NeuriteKind::SOMA,
                position: morphology.origin + sample.position.as_dvec3(),
                radius: f64::from(sample.radius),
                parent: sample.parent.map(|p| first + p),
                section: None,
            }));
        }
        let somata = nodes.len();
        let known = morphology.known_file_sections();
        nodes.reserve(morphology.points.len());
        for section in &morphology.sections {
            let mut parent = match section.attachment {
                Attachment::Free => None,
                Attachment::Soma { soma, sample } => Some(first_of_soma[soma as usize] + sample),
                Attachment::Section(id) => {
                    Some(somata as u32 + morphology.sections[id.index()].end - 1)
                }
            };
            for point in section.range() {
                let next = nodes.len() as u32;
                nodes.push(Node {
                    id: morphology.sample_ids[point],
                    kind: section.kind,
                    position: global(morphology, &morphology.points[point]),
                    radius: f64::from(morphology.points[point].radius),
                    parent: parent.replace(next),
                    section: FileSectionId::new(known.of_points[point]),
                });
            }
        }
        let spines = morphology.spines.iter();
        let spines = spines.map(|spine| morphology.origin + spine.as_dvec3());
        let as_samples = |soma: &Soma| Soma::from_samples(soma.samples.clone()) == *soma;
        Self {
            nodes,
            somata,
            spines: spines.collect(),
            outlined: !morphology.somata.iter().all(as_samples),
        }
    }

    /// The tracing of edited nodes.
    pub(super) fn rebuilt(
        &self,
        morphology: &Morphology,
        edits: &Edits,
    ) -> Result<Morphology, BuildError> {
        let mut rebuilt = morphology.rebuilt(&edits.nodes, self.outlined)?.morphology;
        let spines = edits.spines.as_ref().unwrap_or(&self.spines).iter();
        let spines = spines.map(|&spine| (spine - rebuilt.origin).as_vec3());
        rebuilt.spines = spines.filter(|spine| spine.is_finite()).collect();
        if edits.renumbered {
            number_anew(&mut rebuilt);
        }
        Ok(rebuilt)
    }

    /// The node of a point.
    pub(super) fn of_point(&self, point: usize) -> usize {
        self.somata + point
    }

    /// The nodes of a section, and before them the one that it branches from, unless that is a soma's.
    pub(super) fn of_section(&self, morphology: &Morphology, id: SectionId) -> Vec<usize> {
        let section = &morphology.sections[id.index()];
        let from = section
            .parent()
            .map(|p| morphology.sections[p.index()].end as usize - 1);
        let points = from.into_iter().chain(section.range());
        points.map(|point| self.of_point(point)).collect()
    }

    /// The node with a number.
    pub(super) fn find(&self, sample: i64) -> Result<usize, EditError> {
        let mut found = (0..self.nodes.len()).filter(|&i| self.nodes[i].id == sample);
        match (found.next(), found.next()) {
            (Some(node), None) => Ok(node),
            (Some(_), Some(_)) => Err(EditError::RepeatedSample { sample }),
            (None, _) => {
                let (least, most) = self.numbers();
                Err(EditError::NoSample {
                    sample,
                    least,
                    most,
                })
            }
        }
    }

    /// The nodes with these numbers; an error names all numbers that no node has.
    pub(super) fn find_all(&self, samples: &[i64]) -> Result<Vec<usize>, EditError> {
        let known: HashSet<i64> = self.nodes.iter().map(|node| node.id).collect();
        let unknown = samples.iter().copied().filter(|n| !known.contains(n));
        let unknown: Vec<i64> = unknown.collect();
        if unknown.len() > 1 {
            let (least, most) = self.numbers();
            return Err(EditError::NoSamples {
                samples: unknown,
                least,
                most,
            });
        }
        samples.iter().map(|&sample| self.find(sample)).collect()
    }

    /// The least and the greatest number of a sample; 0 without samples.
    fn numbers(&self) -> (i64, i64) {
        let ids = || self.nodes.iter().map(|node| node.id);
        (ids().min().unwrap_or(0), ids().max().unwrap_or(0))
    }

    /// The nodes that are kept. One whose parent is not kept becomes a root.
    pub(super) fn remaining(&self, kept: &[bool]) -> Vec<Node> {
        let mut number = vec![0_u32; kept.len()];
        let mut remaining: Vec<Node> = Vec::new();
        for (i, node) in self.nodes.iter().enumerate().filter(|&(i, _)| kept[i]) {
            number[i] = remaining.len() as u32;
            remaining.push(*node);
        }
        // Not in the same pass: samples of a soma may stand before their parents.
        for node in &mut remaining {
            let kept_parent = node.parent.filter(|&p| kept[p as usize]);
            node.parent = kept_parent.map(|p| number[p as usize]);
        }
        remaining
    }

    /// Number of the tree of each node, from 0 on in the order of the roots, and how many trees there are.
    pub(super) fn trees(&self) -> (Vec<u32>, usize) {
        const UNKNOWN: u32 = u32::MAX;
        let mut tree = vec![UNKNOWN; self.nodes.len()];
        let mut count = 0;
        let mut way = Vec::new();
        for node in 0..self.nodes.len() {
            // Samples of a soma may stand before their parents.
            let mut at = node;
            while tree[at] == UNKNOWN {
                way.push(at);
                match self.nodes[at].parent {
                    Some(parent) => at = parent as usize,
                    None => {
                        tree[at] = count;
                        count += 1;
                    }
                }
            }
            let found = tree[at];
            for step in way.drain(..) {
                tree[step] = found;
            }
        }
        (tree, count as usize)
    }
}

/// A point in the file's coordinates (µm).
pub(super) fn global(morphology: &Morphology, point: &Point) -> DVec3 {
    morphology.origin + point.position.as_dvec3()
}

/// Numbers all samples from 1 on in the order in which files have them.
fn number_anew(morphology: &mut Morphology) {
    let somata = morphology.somata.iter_mut();
    let of_somata = somata.flat_map(|soma| soma.samples.iter_mut().map(|sample| &mut sample.id));
    let ids = of_somata.chain(morphology.sample_ids.iter_mut());
    for (id, number) in ids.zip(1..) {
        *id = number;
    }
}
