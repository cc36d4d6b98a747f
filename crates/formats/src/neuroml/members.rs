//! Which segments a group has: single ones, paths, subtrees, and those of groups that it includes.

use std::collections::HashMap;

use super::records::{Group, Records, Span, Spread};

/// The segments of all groups, by index.
pub(super) struct Members<'a> {
    groups: &'a [Group],
    /// Of each group the groups that it includes.
    included: Vec<Vec<usize>>,
    index: HashMap<i64, usize>,
    parents: &'a [Option<usize>],
    children: Vec<Vec<usize>>,
    /// The last group that each segment, and each group, was found for: many groups include many others, and marks are
    /// ten times faster than sets.
    segments_seen: Vec<usize>,
    groups_seen: Vec<usize>,
}

/// No group.
const NONE: usize = usize::MAX;

impl<'a> Members<'a> {
    /// `parents`: index of each segment's parent, without circles.
    pub(super) fn of(records: &'a Records, parents: &'a [Option<usize>]) -> Self {
        let mut children = vec![Vec::new(); parents.len()];
        for (i, parent) in parents.iter().enumerate() {
            if let Some(parent) = parent {
                children[*parent].push(i);
            }
        }
        let groups = &records.groups;
        let names = groups.iter().enumerate();
        let names: HashMap<&str, usize> = names.map(|(i, group)| (&*group.id, i)).collect();
        let find = |name: &String| names.get(&**name).copied();
        let segments = records.segments.iter().enumerate();
        Self {
            groups,
            included: groups
                .iter()
                .map(|group| group.includes.iter().filter_map(find).collect())
                .collect(),
            index: segments.map(|(i, segment)| (segment.id, i)).collect(),
            parents,
            children,
            segments_seen: vec![NONE; parents.len()],
            groups_seen: vec![NONE; groups.len()],
        }
    }

    /// Segments of a group and of all that it includes, each once; groups that include one another end.
    pub(super) fn all(&mut self, group: usize) -> Vec<usize> {
        let groups = self.groups;
        let mut found = Vec::new();
        let mut open = vec![group];
        self.groups_seen[group] = group;
        while let Some(at) = open.pop() {
            for id in &groups[at].members {
                if let Some(&segment) = self.index.get(id) {
                    self.add(group, segment, &mut found);
                }
            }
            for span in &groups[at].spans {
                self.add_span(group, span, &mut found);
            }
            for &included in &self.included[at] {
                if self.groups_seen[included] != group {
                    self.groups_seen[included] = group;
                    open.push(included);
                }
            }
        }
        found
    }

    fn add(&mut self, group: usize, segment: usize, found: &mut Vec<usize>) {
        if self.segments_seen[segment] != group {
            self.segments_seen[segment] = group;
            found.push(segment);
        }
    }

    fn add_span(&mut self, group: usize, span: &Span, found: &mut Vec<usize>) {
        let segment = |id: Option<i64>| id.and_then(|id| self.index.get(&id)).copied();
        let segments = match (span.spread, segment(span.from), segment(span.to)) {
            (Spread::Path, Some(from), Some(to)) => {
                // Some writers name the far end first.
                let path = self.path(from, to).or_else(|| self.path(to, from));
                path.unwrap_or_default()
            }
            (_, None, Some(to)) => self.up(to).collect(),
            (_, Some(from), to) => self.subtree(from, to),
            (_, None, None) => Vec::new(),
        };
        for segment in segments {
            self.add(group, segment, found);
        }
    }

    /// Segments from one to another that is below it; nothing if it is not.
    fn path(&self, from: usize, to: usize) -> Option<Vec<usize>> {
        let mut path = Vec::new();
        for segment in self.up(to) {
            path.push(segment);
            if segment == from {
                return Some(path);
            }
        }
        None
    }

    /// A segment and all above it.
    fn up(&self, segment: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(segment), |&i| self.parents[i])
    }

    /// A segment and all below it, but none below `to`.
    fn subtree(&self, from: usize, to: Option<usize>) -> Vec<usize> {
        let mut subtree = Vec::new();
        let mut open = vec![from];
        while let Some(segment) = open.pop() {
            subtree.push(segment);
            if Some(segment) != to {
                open.extend(&self.children[segment]);
            }
        }
        subtree
    }
}
