//! Nodes of equal attributes, for colors.

use std::collections::BTreeMap;

use crate::population::{Attribute, NodeRef, Population};

/// The nodes of a circuit by the value of an attribute.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groups {
    /// Distinct values over all populations, sorted; numbers as text. Nodes without a value come last,
    /// as the empty text, if there are such.
    pub texts: Vec<String>,
    /// Place in `texts` by population and row.
    rows: Vec<Vec<u32>>,
}

impl Groups {
    /// Groups all nodes of these populations by an attribute, or by `population`.
    pub fn by(populations: &[Population], attribute: &str) -> Self {
        let columns: Vec<(Vec<String>, Vec<u32>)> = populations
            .iter()
            .map(|population| match population.attributes.get(attribute) {
                Some(Attribute::Text { library, indices }) => (library.clone(), indices.clone()),
                Some(Attribute::Numbers(values)) => numbers(values),
                None if attribute == "population" => {
                    (vec![population.name.clone()], vec![0; population.len()])
                }
                None => (vec![], vec![Attribute::NONE; population.len()]),
            })
            .collect();
        let mut texts: Vec<String> = columns.iter().flat_map(|(w, _)| w.clone()).collect();
        texts.sort_by(|a, b| natural(a, b));
        texts.dedup();
        let none = columns
            .iter()
            .any(|(_, rows)| rows.contains(&Attribute::NONE));
        let last = texts.len() as u32;
        let place: BTreeMap<&str, u32> = texts.iter().map(String::as_str).zip(0..).collect();
        let rows = columns
            .iter()
            .map(|(library, rows)| {
                let places: Vec<u32> = library.iter().map(|text| place[text.as_str()]).collect();
                let of = |&row: &u32| places.get(row as usize).copied().unwrap_or(last);
                rows.iter().map(of).collect()
            })
            .collect();
        if none {
            texts.push(String::new());
        }
        Self { texts, rows }
    }

    /// The place of a node's value in [`Groups::texts`].
    ///
    /// # Panics
    /// If the node is not of the circuit.
    pub fn of(&self, node: NodeRef) -> u32 {
        self.rows[node.population as usize][node.row as usize]
    }
}

/// Distinct numbers as texts, and the place of each.
fn numbers(values: &[f64]) -> (Vec<String>, Vec<u32>) {
    let mut distinct: Vec<f64> = values.iter().copied().filter(|v| !v.is_nan()).collect();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup_by(|a, b| a.total_cmp(b).is_eq());
    let place = |value: &f64| match distinct.binary_search_by(|other| other.total_cmp(value)) {
        Ok(place) => place as u32,
        Err(_) => Attribute::NONE,
    };
    let rows = values.iter().map(place).collect();
    (distinct.iter().map(f64::to_string).collect(), rows)
}

/// The order of texts for people: numbers by value and before texts, texts by letters.
pub fn natural(a: &str, b: &str) -> std::cmp::Ordering {
    match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(x), Ok(y)) => x.total_cmp(&y).then_with(|| a.cmp(b)),
        (Ok(_), Err(_)) => std::cmp::Ordering::Less,
        (Err(_), Ok(_)) => std::cmp::Ordering::Greater,
        (Err(_), Err(_)) => a.cmp(b),
    }
}
