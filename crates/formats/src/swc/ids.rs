//! Parents by number to parents by index.
//!
//! Numbers mostly count up from 0 or 1: then the index is a difference. Dense ones in any order
//! get a table, sparse ones a sorted list.

use neurotess_morphology::Node;

use super::rows::Records;
use crate::Fault;
use crate::text::Located;
use crate::warning::Warnings;

/// A table may have this many entries per sample.
const SPARSEST_TABLE: usize = 4;
const NONE: u32 = u32::MAX;

/// Index of the sample with a number.
enum Index {
    /// Numbers count up from this one.
    Counted(i64),
    /// From the least number on.
    Table { least: i64, of: Vec<u32> },
    /// By number.
    Sorted(Vec<(i64, u32)>),
}

/// Gives every node its parent.
pub(super) fn resolve(records: &mut Records, warnings: &mut Warnings) -> Located<()> {
    let Records {
        nodes,
        parents,
        lines,
        ..
    } = records;
    let line = |i: usize| u64::from(lines[i]);
    let index = Index::of(nodes).map_err(|(first, second)| {
        let id = nodes[second].id;
        (
            line(second),
            Fault::RepeatedId {
                id,
                first_line: line(first),
            },
        )
    })?;
    let n = nodes.len();
    for (i, (node, &parent)) in nodes.iter_mut().zip(parents.iter()).enumerate() {
        let id = node.id;
        if parent < 0 {
            if parent != -1 {
                warnings.add(line(i), "root_parent", "a root's parent is not -1");
            }
            continue;
        }
        if parent == id {
            return Err((line(i), Fault::SelfParent { id }));
        }
        let found = index.get(parent, n);
        if found.is_none() && parent == 0 {
            // Vaa3D and others number from 1 on and give roots the parent 0.
            warnings.add(line(i), "root_parent", "a root's parent is not -1");
            continue;
        }
        let unknown = || (line(i), Fault::UnknownParent { id, parent });
        node.parent = Some(found.ok_or_else(unknown)?);
        if found > Some(i as u32) {
            let message = "samples stand above their parents: read all the same";
            warnings.add(line(i), "parent_after_child", message);
        }
    }
    Ok(())
}

impl Index {
    /// The rows of the first number that comes again, if one does.
    fn of(nodes: &[Node]) -> Result<Self, (usize, usize)> {
        let first = nodes.first().map_or(0, |n| n.id);
        if nodes
            .iter()
            .enumerate()
            .all(|(i, n)| n.id.checked_sub(first) == Some(i as i64))
        {
            return Ok(Self::Counted(first));
        }
        let least = nodes.iter().map(|n| n.id).min().unwrap_or(0);
        let greatest = nodes.iter().map(|n| n.id).max().unwrap_or(0);
        let span = greatest.abs_diff(least);
        if span < (SPARSEST_TABLE * nodes.len()) as u64 {
            Self::table(nodes, least, span as usize)
        } else {
            Self::sorted(nodes)
        }
    }

    fn table(nodes: &[Node], least: i64, span: usize) -> Result<Self, (usize, usize)> {
        let mut of = vec![NONE; span + 1];
        for (i, node) in nodes.iter().enumerate() {
            let entry = &mut of[(node.id - least) as usize];
            if *entry != NONE {
                return Err((*entry as usize, i));
            }
            *entry = i as u32;
        }
        Ok(Self::Table { least, of })
    }

    fn sorted(nodes: &[Node]) -> Result<Self, (usize, usize)> {
        let mut sorted: Vec<(i64, u32)> = nodes
            .iter()
            .zip(0_u32..)
            .map(|(node, i)| (node.id, i))
            .collect();
        sorted.sort_unstable();
        let repeated = sorted
            .windows(2)
            .filter(|w| w[0].0 == w[1].0)
            .min_by_key(|w| w[1].1);
        match repeated {
            Some(pair) => Err((pair[0].1 as usize, pair[1].1 as usize)),
            None => Ok(Self::Sorted(sorted)),
        }
    }

    /// Index of the sample `id` among `n`.
    fn get(&self, id: i64, n: usize) -> Option<u32> {
        match self {
            Self::Counted(first) => {
                let index = id.checked_sub(*first)?;
                (0..n as i64).contains(&index).then_some(index as u32)
            }
            Self::Table { least, of } => {
                let index = usize::try_from(id.checked_sub(*least)?).ok()?;
                of.get(index).copied().filter(|&i| i != NONE)
            }
            Self::Sorted(sorted) => {
                let found = sorted.binary_search_by_key(&id, |&(id, _)| id).ok()?;
                Some(sorted[found].1)
            }
        }
    }
}
