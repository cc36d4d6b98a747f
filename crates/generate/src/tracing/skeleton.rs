//! The tracing as a forest of nodes that the following steps mend.
//!
//! Parents come before their children at all times, so that every step is a sweep over an array
//! and no tree is too deep.

use std::sync::OnceLock;

use glam::DVec3;
use neurotess_mesh::{SectionNumber, SwcType};
use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Soma};

/// Stands for "no node" where an index of one is stored.
pub(crate) const NONE: u32 = u32::MAX;

/// A point on its way to become a tracing point. µm, relative to the morphology's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SkeletonNode {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// Index of the parent, [`NONE`] for a root.
    pub(crate) parent: u32,
    /// What a root hangs on.
    pub(crate) root: Root,
    /// The [label](neurotess_morphology::SampleLabels) of the sample.
    pub(crate) sample: i64,
    /// Type of its section.
    pub(crate) kind: SwcType,
    /// The section that it lies on.
    pub(crate) section: SectionNumber,
}

/// Adds the samples of a soma, parents first, and says which nodes they are.
fn push_samples(
    soma: &Soma,
    label: impl Fn(usize) -> i32,
    nodes: &mut Vec<SkeletonNode>,
) -> Vec<u32> {
    let mut node_of = vec![NONE; soma.samples.len()];
    for start in 0..soma.samples.len() {
        // Up to one that is a node, or the first; then down again.
        let mut ancestors = vec![start];
        let up = |&last: &usize| soma.samples[last].parent.map(|parent| parent as usize);
        while let Some(above) = ancestors.last().and_then(up)
            && node_of[above] == NONE
            && ancestors.len() <= soma.samples.len()
        {
            ancestors.push(above);
        }
        for at in ancestors.into_iter().rev() {
            if node_of[at] != NONE {
                continue;
            }
            let sample = &soma.samples[at];
            let parent = sample
                .parent
                .map_or(NONE, |parent| node_of[parent as usize]);
            node_of[at] = nodes.len() as u32;
            nodes.push(SkeletonNode {
                center: sample.position.as_dvec3(),
                radius: f64::from(sample.radius),
                parent,
                root: Root::Free,
                sample: label(at).into(),
                kind: SwcType::SOMA,
                section: SectionNumber::SOMA,
            });
        }
    }
    node_of
}

/// What a root hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Root {
    /// Nothing, or it is no root.
    Free,
    /// A soma, whose surface the neurite has yet to reach or to leave.
    Soma(u32),
    /// A soma; the node is the neurite's first ring on it.
    Insertion(u32),
}

/// The forest of nodes.
///
/// Lists of children are borrowed from the skeleton, and whatever changes nodes borrows all of it: the
/// compiler refuses a list that is used after what it lists has changed. What changes no link, a center
/// or a radius, may change under the lists through [`shapes`](Skeleton::shapes).
#[derive(Debug, Default)]
pub(crate) struct Skeleton {
    nodes: Vec<SkeletonNode>,
    /// Listed at first use.
    children: OnceLock<Children>,
}

/// Children of every node, in order.
#[derive(Debug, PartialEq)]
pub(crate) struct Children {
    start: Vec<u32>,
    list: Vec<u32>,
}

impl Children {
    fn list(nodes: &[SkeletonNode]) -> Self {
        let mut start = vec![0_u32; nodes.len() + 1];
        for node in nodes.iter().filter(|n| n.parent != NONE) {
            start[node.parent as usize + 1] += 1;
        }
        for i in 1..start.len() {
            start[i] += start[i - 1];
        }
        let mut list = vec![0; *start.last().unwrap_or(&0) as usize];
        // Each start moves to its end as the list is filled: the next node's start.
        for (index, node) in nodes.iter().enumerate() {
            if node.parent != NONE {
                let slot = &mut start[node.parent as usize];
                list[*slot as usize] = index as u32;
                *slot += 1;
            }
        }
        start.rotate_right(1);
        start[0] = 0;
        Self { start, list }
    }

    pub(crate) fn of(&self, node: u32) -> &[u32] {
        let node = node as usize;
        &self.list[self.start[node] as usize..self.start[node + 1] as usize]
    }
}

/// Nodes whose links stay as they are.
pub(crate) struct Shapes<'a>(&'a mut [SkeletonNode]);

impl Shapes<'_> {
    pub(crate) fn node(&self, index: u32) -> &SkeletonNode {
        &self.0[index as usize]
    }

    pub(crate) fn set_radius(&mut self, index: u32, radius: f64) {
        self.0[index as usize].radius = radius;
    }

    pub(crate) fn set_center(&mut self, index: u32, center: DVec3) {
        self.0[index as usize].center = center;
    }

    pub(crate) fn set_root(&mut self, index: u32, root: Root) {
        self.0[index as usize].root = root;
    }
}

impl Skeleton {
    /// Nodes of sections of these kinds (`None`: all). A tree whose parent is of another kind becomes free.
    /// `as_neurites`: by soma, whether its samples are nodes, too, with the neurites as their children.
    pub(crate) fn new(
        morphology: &Morphology,
        kinds: Option<&[NeuriteKind]>,
        as_neurites: &[bool],
    ) -> Self {
        let kept = |kind: NeuriteKind| kinds.is_none_or(|kinds| kinds.contains(&kind));
        let mut new_index = vec![NONE; morphology.points.len()];
        let mut nodes = Vec::with_capacity(morphology.points.len());
        let labels = morphology.sample_labels();
        let somata = morphology.somata.iter().enumerate().zip(as_neurites);
        let node_of: Vec<Vec<u32>> = somata
            .map(|((index, soma), &as_neurite)| match as_neurite {
                true => push_samples(soma, |sample| labels.of_soma(index, sample), &mut nodes),
                false => Vec::new(),
            })
            .collect();
        for (id, section) in morphology.sections.iter().enumerate() {
            if !kept(section.kind) {
                continue;
            }
            let (mut parent, root) = match section.attachment {
                Attachment::Section(parent) => {
                    let last = morphology.sections[parent.index()].end as usize - 1;
                    (new_index[last], Root::Free)
                }
                Attachment::Soma { soma, sample } => {
                    let node = node_of[soma as usize].get(sample as usize);
                    match node {
                        Some(&node) => (node, Root::Free),
                        None => (NONE, Root::Soma(soma)),
                    }
                }
                Attachment::Free => (NONE, Root::Free),
            };
            for point in section.range() {
                let traced = morphology.points[point];
                new_index[point] = nodes.len() as u32;
                nodes.push(SkeletonNode {
                    center: traced.position.as_dvec3(),
                    radius: f64::from(traced.radius),
                    parent,
                    root: if parent == NONE { root } else { Root::Free },
                    sample: labels.of_point(point).into(),
                    kind: SwcType(section.kind.0),
                    section: SectionNumber(id as i32 + 1),
                });
                parent = new_index[point];
            }
        }
        Self::from_nodes(nodes)
    }

    /// A skeleton of nodes whose parents come before them.
    pub(crate) fn from_nodes(nodes: Vec<SkeletonNode>) -> Self {
        Self {
            nodes,
            children: OnceLock::new(),
        }
    }

    pub(crate) fn nodes(&self) -> &[SkeletonNode] {
        &self.nodes
    }

    pub(crate) fn node(&self, index: u32) -> &SkeletonNode {
        &self.nodes[index as usize]
    }

    /// Children of every node.
    pub(crate) fn children(&self) -> &Children {
        self.children.get_or_init(|| Children::list(&self.nodes))
    }

    /// The nodes, of which all but the links may change, beside the lists of children.
    pub(crate) fn shapes(&mut self) -> (Shapes<'_>, &Children) {
        let children = self.children.get_or_init(|| Children::list(&self.nodes));
        (Shapes(&mut self.nodes), children)
    }

    /// Changes a node, but for what it hangs on: where it is, how thick, and the point that it is labeled as.
    pub(crate) fn set_point(
        &mut self,
        index: u32,
        label: SkeletonNode,
        center: DVec3,
        radius: f64,
    ) {
        let node = &mut self.nodes[index as usize];
        *node = SkeletonNode {
            center,
            radius,
            parent: node.parent,
            root: node.root,
            ..label
        };
    }

    /// Nodes to add to and to link anew; children are listed anew afterwards.
    pub(crate) fn links(&mut self) -> &mut Vec<SkeletonNode> {
        self.children.take();
        &mut self.nodes
    }

    /// What a fork joins: its parent, if there is one, then its children.
    pub(crate) fn neighbors(&self, fork: u32) -> Vec<u32> {
        let parent = Some(self.node(fork).parent).filter(|&parent| parent != NONE);
        let children = self.children().of(fork).iter().copied();
        parent.into_iter().chain(children).collect()
    }

    /// Leaves nodes out. Their children move to the nearest kept ancestor, or become roots of the
    /// kind that the tree's root was.
    pub(crate) fn retain(&mut self, keep: &[bool]) {
        if keep.iter().all(|&k| k) {
            return;
        }
        // Where children of a node attach: itself if kept, else where it would have attached.
        let mut stands_for: Vec<(u32, Root)> = Vec::with_capacity(self.nodes.len());
        let mut kept = 0;
        for (index, &keep) in keep.iter().enumerate() {
            let node = self.nodes[index];
            let (parent, root) = if node.parent == NONE {
                (NONE, node.root)
            } else {
                stands_for[node.parent as usize]
            };
            if keep {
                stands_for.push((kept as u32, Root::Free));
                self.nodes[kept] = SkeletonNode {
                    parent,
                    root,
                    ..node
                };
                kept += 1;
            } else {
                // A soma's ring that is left out leaves the neurite without one.
                let root = match root {
                    Root::Insertion(soma) => Root::Soma(soma),
                    other => other,
                };
                stands_for.push((parent, root));
            }
        }
        self.links().truncate(kept);
    }

    /// Takes nodes away on which no other node hangs but such as go, too.
    pub(crate) fn cut(&mut self, keep: &[bool]) {
        let mut new_index = vec![NONE; keep.len()];
        let kept = new_index.iter_mut().zip(keep).filter(|(_, keep)| **keep);
        for (new, (index, _)) in (0..).zip(kept) {
            *index = new;
        }
        let nodes = self.links();
        let mut keep = keep.iter();
        nodes.retain(|_| keep.next() == Some(&true));
        for node in nodes.iter_mut().filter(|node| node.parent != NONE) {
            node.parent = new_index[node.parent as usize];
        }
    }

    /// Brings parents before children again after links were changed, depth first.
    pub(crate) fn reorder(&mut self) {
        // Lists of children do not depend on the order of nodes.
        let children = self.children();
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut stack: Vec<u32> = (0..self.nodes.len() as u32)
            .rev()
            .filter(|&i| self.node(i).parent == NONE)
            .collect();
        while let Some(node) = stack.pop() {
            order.push(node);
            stack.extend(children.of(node).iter().rev());
        }
        let mut new_index = vec![NONE; self.nodes.len()];
        for (new, &old) in order.iter().enumerate() {
            new_index[old as usize] = new as u32;
        }
        let moved = |&old: &u32| {
            let node = *self.node(old);
            let parent = match node.parent {
                NONE => NONE,
                parent => new_index[parent as usize],
            };
            SkeletonNode { parent, ..node }
        };
        let nodes = order.iter().map(moved).collect();
        *self = Self::from_nodes(nodes);
    }

    /// Turns free trees whose root has two children round, so that they start at an end.
    pub(crate) fn start_free_trees_at_an_end(&mut self) {
        let paths = self.paths_to_turn();
        if paths.is_empty() {
            return;
        }
        let nodes = self.links();
        for path in paths {
            // A fork on the way becomes a fork of the turned tree: nothing is lost.
            for link in path.windows(2) {
                nodes[link[0] as usize].parent = link[1];
            }
            nodes[path[path.len() - 1] as usize].parent = NONE;
        }
        self.reorder();
    }

    /// From each free root with two children to an end.
    fn paths_to_turn(&self) -> Vec<Vec<u32>> {
        let children = self.children();
        let turns = |root: &u32| {
            let node = self.node(*root);
            let free = node.parent == NONE && node.root == Root::Free;
            free && children.of(*root).len() == 2
        };
        let path = |root: u32| {
            let mut path = vec![root];
            let mut here = root;
            while let [first, ..] = children.of(here) {
                here = *first;
                path.push(here);
            }
            path
        };
        let roots = (0..self.nodes.len() as u32).filter(turns);
        roots.map(path).collect()
    }
}

/// Distance of a point from a segment.
pub(crate) fn off_segment(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let axis = to - from;
    let t =
        ((point - from).dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    point.distance(from + axis * t)
}
