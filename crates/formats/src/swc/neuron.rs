//! What NEURON 9.0.2 makes of a file: it goes by the order of the rows, not by parents alone.

use neurotess_morphology::NeuriteKind;

use super::rows::Records;
use crate::warning::Warnings;

const MESSAGE: &str = "NEURON refuses the file, or reads other sections or even another cell: its rows are not those of one \
                       section after another with numbers that ascend (`neurotess convert` writes them so)";

/// Tells of rows that NEURON takes for something else: numbers that do not ascend, children above their parents, and samples
/// whose only child of their type is not in the next row. Behind a neurite's first sample, NEURON takes what is there for
/// its child.
pub(super) fn misreadings(records: &Records, warnings: &mut Warnings) {
    const NONE: u32 = u32::MAX;
    const SEVERAL: u32 = u32::MAX - 1;
    let nodes = &records.nodes;
    let mut only_child = vec![NONE; nodes.len()];
    for (node, child) in nodes.iter().zip(0_u32..) {
        if let Some(parent) = node.parent {
            let of_parent = &mut only_child[parent as usize];
            *of_parent = match *of_parent {
                NONE => child,
                _ => SEVERAL,
            };
        }
    }
    for (row, node) in nodes.iter().enumerate() {
        let descends = row > 0 && nodes[row - 1].id >= node.id;
        let above = node.parent.is_some_and(|parent| parent as usize >= row);
        let child = nodes.get(only_child[row] as usize);
        let goes_on = child.is_some_and(|child| child.kind == node.kind);
        let apart =
            node.kind != NeuriteKind::SOMA && goes_on && only_child[row] as usize != row + 1;
        if descends || above || apart {
            warnings.add(u64::from(records.lines[row]), "neuron_misreads", MESSAGE);
        }
    }
}
