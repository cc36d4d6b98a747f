//! Selection of a circuit's cells on the command line.

use clap::Args;
use glam::DVec3;
use neurotess::circuit::{Circuit, NodeRef, Selection};

use crate::report::Failure;

/// Which cells of a circuit.
#[derive(Args, Clone, Debug, Default, PartialEq)]
#[command(next_help_heading = "Cells of a circuit")]
pub(crate) struct CellArgs {
    /// Only cells with these ids, as in 0,5,10-19
    #[arg(long, value_name = "IDS", value_parser = ids)]
    nodes: Option<Ids>,
    /// Only cells of this node set
    #[arg(long, value_name = "NAME")]
    node_set: Option<String>,
    /// Only cells of this population
    #[arg(long, value_name = "NAME")]
    population: Option<String>,
    /// Only N cells, spread at random
    #[arg(long, value_name = "N")]
    sample: Option<usize>,
    /// Seed of the sample
    #[arg(long, value_name = "S", default_value_t = 1)]
    sample_seed: u64,
    /// Only cells with their soma in this box: X,Y,Z,X,Y,Z of two corners (µm)
    #[arg(long, value_name = "BOX", value_parser = region, allow_hyphen_values = true)]
    region: Option<Region>,
    /// Only these cells: of programs that hold the circuit in memory.
    #[arg(skip)]
    listed: Option<Vec<NodeRef>>,
}

/// Ranges of ids, both ends included.
#[derive(Clone, Debug, PartialEq)]
struct Ids(Vec<(u64, u64)>);

/// Least and greatest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Region(DVec3, DVec3);

impl CellArgs {
    /// Whether any option is given.
    pub(crate) fn any(&self) -> bool {
        let chosen = Self {
            sample_seed: 0,
            ..self.clone()
        };
        chosen != Self::default()
    }

    #[cfg(feature = "render")]
    /// Selects these cells alone.
    pub(crate) fn list(&mut self, nodes: &[NodeRef]) {
        self.listed = Some(nodes.to_vec());
    }

    /// The selected cells.
    pub(crate) fn select(&self, circuit: &Circuit) -> Result<Vec<NodeRef>, Failure> {
        let selection = Selection {
            population: self.population.clone(),
            ids: self.nodes.as_ref().map(|ids| ids.0.clone()),
            nodes: self.listed.clone(),
            node_set: self.node_set.clone(),
            region: self.region.map(|Region(min, max)| (min, max)),
            sample: self.sample.map(|count| (count, self.sample_seed)),
        };
        circuit
            .select(&selection)
            .map_err(|e| Failure(e.to_string()))
    }
}

fn ids(text: &str) -> Result<Ids, String> {
    let range = |part: &str| {
        let (from, to) = part.split_once('-').unwrap_or((part, part));
        let (from, to) = (from.trim().parse().ok()?, to.trim().parse().ok()?);
        (from <= to).then_some((from, to))
    };
    let ranges: Option<Vec<(u64, u64)>> = text.split(',').map(range).collect();
    ranges
        .map(Ids)
        .ok_or_else(|| "ids and ranges of them are needed, as in 0,5,10-19".into())
}

fn region(text: &str) -> Result<Region, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[a, b, c, d, e, f]) if [a, b, c, d, e, f].iter().all(|n| n.is_finite()) => {
            let (one, other) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
            Ok(Region(one.min(other), one.max(other)))
        }
        _ => Err("six numbers are needed: X,Y,Z of one corner, X,Y,Z of the other".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_and_boxes_are_understood() {
        assert_eq!(ids("0, 5,10-19"), Ok(Ids(vec![(0, 0), (5, 5), (10, 19)])));
        for wrong in ["", "a", "5-3", "1,,2", "-1"] {
            assert!(ids(wrong).is_err(), "{wrong}");
        }
        let unordered = region("0,10,-5, 1,2,5").expect("a box");
        let sorted = Region(DVec3::new(0.0, 2.0, -5.0), DVec3::new(1.0, 10.0, 5.0));
        assert_eq!(unordered, sorted);
        assert!(region("1,2,3").is_err() && region("1,2,3,4,5,inf").is_err());
    }
}
