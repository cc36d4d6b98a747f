//! Properties of the cells of a source: what they are called and found by.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

use glam::DAffine3;
use neurotess_circuit::{Attribute, Circuit, Instance, Population};

use crate::facts::{Facts, NUMBERS};
use crate::properties::{Column, Tag, number_name, tag_word, write_properties};
use crate::source::Source;

/// Most words of an attribute that are tags; texts that nearly each cell has for itself are only shown.
const MOST_WORDS: usize = 400;

/// What a word is of, and the word as it was given.
type Origin = (String, String);

/// The cells that can be read, with what is known of their tracings.
pub(crate) struct Table<'t> {
    pub(crate) source: &'t Source,
    /// Of each tracing; none of those that cannot be read.
    pub(crate) facts: &'t [Option<Facts>],
    /// Cells that can be read.
    pub(crate) cells: Vec<usize>,
    pub(crate) ids: Vec<u64>,
}

impl<'t> Table<'t> {
    pub(crate) fn new(source: &'t Source, facts: &'t [Option<Facts>], ids: &[u64]) -> Self {
        let readable = |&cell: &usize| facts[source.template(cell)].is_some();
        let cells: Vec<usize> = (0..source.len()).filter(readable).collect();
        Self {
            source,
            facts,
            ids: cells.iter().map(|&cell| ids[cell]).collect(),
            cells,
        }
    }

    /// What is known of a row's tracing, and the cell's place.
    pub(crate) fn row(&self, row: usize) -> (&'t Facts, DAffine3) {
        let cell = self.cells[row];
        let facts = self.facts[self.source.template(cell)].as_ref();
        let facts = facts.expect("only cells that were read");
        (facts, self.source.placement(cell, facts.soma_center))
    }

    /// Writes the properties.
    pub(crate) fn write(&self, to: impl Write) -> io::Result<()> {
        let (tags, indices) = self.tags();
        let words = move |row: usize| {
            let mut words: Vec<u32> = self.words(row).iter().map(|word| indices[word]).collect();
            words.sort_unstable();
            words.dedup();
            words
        };
        let label = |row: usize| self.source.label(self.cells[row]);
        let mut columns = vec![
            Column::Label(Box::new(label)),
            Column::Tags {
                words: &tags,
                of: Box::new(words),
            },
        ];
        for (number, (name, description, _)) in NUMBERS.iter().enumerate() {
            let of = move |row: usize| {
                let (facts, place) = self.row(row);
                facts.number(number, place)
            };
            columns.push(Column::Number {
                name: (*name).to_owned(),
                description: (*description).to_owned(),
                of: Box::new(of),
            });
        }
        if let Source::Circuit(circuit, instances) = self.source {
            let nodes = Nodes {
                circuit,
                instances,
                cells: &self.cells,
            };
            columns.extend(nodes.columns());
        }
        write_properties(to, &self.ids, &columns)
    }

    /// All words, sorted, and the index of each by what it is of.
    fn tags(&self) -> (Vec<Tag>, BTreeMap<Origin, u32>) {
        let rows = 0..self.cells.len();
        let all: BTreeSet<Origin> = rows.flat_map(|row| self.words(row)).collect();
        let mut origins: BTreeMap<String, usize> = BTreeMap::new();
        for (_, text) in &all {
            *origins.entry(tag_word(text)).or_default() += 1;
        }
        let mut tags: Vec<(Tag, Origin)> = all
            .into_iter()
            .map(|(of, text)| {
                let plain = tag_word(&text);
                // A number, or a word of two meanings, says what it is of.
                let is_clear = plain.starts_with(char::is_alphabetic) && origins[&plain] == 1;
                let word = match is_clear {
                    true => plain,
                    false => tag_word(&format!("{of}:{plain}")),
                };
                let description = of.clone();
                (Tag { word, description }, (of, text))
            })
            .collect();
        tags.sort_by(|(a, _), (b, _)| a.word.cmp(&b.word));
        let indices = tags
            .iter()
            .zip(0..)
            .map(|((_, of), n)| (of.clone(), n))
            .collect();
        (tags.into_iter().map(|(tag, _)| tag).collect(), indices)
    }

    /// Words of a row: types of its cell, folders of its file, attributes of its node.
    fn words(&self, row: usize) -> Vec<Origin> {
        let (facts, _) = self.row(row);
        let cell = self.cells[row];
        let of = |origin: &str, text: String| (origin.to_owned(), text);
        let kinds = facts.kinds.iter().map(|kind| of("type", kind.name()));
        let folders = self.source.folders(cell).into_iter();
        let mut words: Vec<Origin> = kinds
            .chain(folders.map(|name| of("folder", name)))
            .collect();
        if let Source::Circuit(circuit, instances) = self.source {
            words.extend(words_of_node(circuit, &instances[cell]));
        }
        words.retain(|(_, text)| !text.trim().is_empty());
        words
    }
}

/// The population and texts of a node.
fn words_of_node(circuit: &Circuit, instance: &Instance) -> Vec<Origin> {
    let population = &circuit.populations[instance.node.population as usize];
    let row = instance.node.row as usize;
    let own = ("population".to_owned(), population.name.clone());
    let attributes = population
        .attributes
        .iter()
        .filter(|(_, values)| is_tag(values));
    let texts = attributes.filter_map(|(name, values)| {
        let text = values.text(row)?;
        Some((name.clone(), text.to_owned()))
    });
    std::iter::once(own).chain(texts).collect()
}

fn is_tag(values: &Attribute) -> bool {
    matches!(values, Attribute::Text { library, .. } if library.len() <= MOST_WORDS)
}

/// The nodes of a circuit that are rows.
#[derive(Clone, Copy)]
struct Nodes<'n> {
    circuit: &'n Circuit,
    instances: &'n [Instance],
    cells: &'n [usize],
}

impl<'n> Nodes<'n> {
    /// Columns of the nodes' attributes that are no tags.
    fn columns(self) -> Vec<Column<'n>> {
        let mut columns = Vec::new();
        let id = move |row: usize| u32::try_from(self.node(row).1.id);
        if (0..self.cells.len()).all(|row| id(row).is_ok()) {
            columns.push(Column::Whole {
                name: "node_id".into(),
                description: "id in the population".into(),
                of: Box::new(move |row| id(row).unwrap_or_default()),
            });
        }
        let is_own = |name: &str| name == "node_id" || NUMBERS.iter().any(|own| own.0 == name);
        for name in self.names(|values| matches!(values, Attribute::Numbers(_))) {
            let plain = number_name(name);
            columns.push(Column::Number {
                name: if is_own(&plain) {
                    format!("node_{plain}")
                } else {
                    plain
                },
                description: name.to_owned(),
                of: Box::new(move |row| self.number(name, row).unwrap_or(f64::NAN)),
            });
        }
        for name in self.names(|values| !matches!(values, Attribute::Numbers(_)) && !is_tag(values))
        {
            columns.push(Column::Text {
                name: name.to_owned(),
                of: Box::new(move |row| self.text(name, row).unwrap_or_default().to_owned()),
            });
        }
        columns
    }

    fn node(self, row: usize) -> (&'n Population, &'n Instance) {
        let instance = &self.instances[self.cells[row]];
        let population = instance.node.population as usize;
        (&self.circuit.populations[population], instance)
    }

    /// Names of attributes of a kind, of any population.
    fn names(self, is: impl Fn(&Attribute) -> bool) -> BTreeSet<&'n str> {
        let populations = self.circuit.populations.iter();
        let all = populations.flat_map(|population| &population.attributes);
        let some = all.filter(|(_, values)| is(values));
        some.map(|(name, _)| name.as_str()).collect()
    }

    fn number(self, name: &str, row: usize) -> Option<f64> {
        let (population, instance) = self.node(row);
        let values = population.attributes.get(name)?;
        values.number(instance.node.row as usize)
    }

    fn text(self, name: &str, row: usize) -> Option<&'n str> {
        let (population, instance) = self.node(row);
        let values = population.attributes.get(name)?;
        values.text(instance.node.row as usize)
    }
}
