//! Which segments a group has: single ones, paths, subtrees, and those of groups that it includes.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::records::{Group, Records, Span, Spread};

/// The segments of all groups, by index.
pub(super) struct Members<'a> {
    groups: HashMap<&'a str, &'a Group>,
    index: HashMap<i64, usize>,
    parents: &'a [Option<usize>],
    children: Vec<Vec<usize>>,
}

impl<'a> Members<'a> {
    /// `parents`: index of each segment's parent, without circles.
    pub(super) fn of(records: &'a Records, parents: &'a [Option<usize>]) -> Self {
        let mut children = vec![Vec::new(); parents.len()];
        for (i, parent) in parents.iter().enumerate() {
            if let Some(parent) = parent {
                children[*parent].push(i);
            }
        }
        let segments = records.segments.iter().enumerate();
        Self {
            groups: records.groups.iter().map(|g| (&*g.id, g)).collect(),
            index: segments.map(|(i, segment)| (segment.id, i)).collect(),
            parents,
            children,
        }
    }

    /// Segments of a group and of all that it includes; groups that include one another end.
    pub(super) fn all(&self, group: &'a Group) -> BTreeSet<usize> {
        let mut found = BTreeSet::new();
        let mut seen = HashSet::from([&*group.id]);
        let mut open = vec![group];
        while let Some(group) = open.pop() {
            let members = group.members.iter();
            found.extend(members.filter_map(|id| self.index.get(id)));
            for span in &group.spans {
                self.add_span(span, &mut found);
            }
            for name in &group.includes {
                if let Some(&included) = self.groups.get(&**name)
                    && seen.insert(name)
                {
                    open.push(included);
                }
            }
        }
        found
    }

    fn add_span(&self, span: &Span, found: &mut BTreeSet<usize>) {
        let segment = |id: Option<i64>| id.and_then(|id| self.index.get(&id)).copied();
        match (span.spread, segment(span.from), segment(span.to)) {
            (Spread::Path, Some(from), Some(to)) => {
                // Some writers name the far end first.
                let path = self.path(from, to).or_else(|| self.path(to, from));
                found.extend(path.unwrap_or_default());
            }
            (_, None, Some(to)) => found.extend(self.up(to)),
            (_, Some(from), to) => self.add_subtree(from, to, found),
            (_, None, None) => {}
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
    fn add_subtree(&self, from: usize, to: Option<usize>, found: &mut BTreeSet<usize>) {
        let mut open = vec![from];
        while let Some(segment) = open.pop() {
            found.insert(segment);
            if Some(segment) != to {
                open.extend(&self.children[segment]);
            }
        }
    }
}
