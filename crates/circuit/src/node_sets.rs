//! Named choices of nodes, as SONATA's `node_sets.json` has them.
//!
//! ```json
//! {
//!   "layer 2 or 3": {"layer": ["L2", "L3"], "population": "cortex"},
//!   "tall":         {"y": {"$gt": 1000}, "mtype": {"$regex": "L5_.*"}},
//!   "some":         {"node_id": [0, 5, 7]},
//!   "all of these": ["layer 2 or 3", "some"]
//! }
//! ```
//!
//! All rules of a set must hold; a list of names is the union of those sets. The empty set `{}` is all
//! nodes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use regex_lite::Regex;
use serde_json::Value;

use crate::compartment_sets::CompartmentSet;
use crate::error::{CircuitError, Fault};
use crate::json::{Document, Json};
use crate::population::{Attribute, NodeRef, Population};

/// Named choices of nodes.
#[derive(Debug, Default)]
pub struct NodeSets {
    sets: BTreeMap<String, Set>,
}

#[derive(Debug)]
struct Set {
    file: String,
    choice: Choice,
}

#[derive(Debug)]
enum Choice {
    /// Nodes for which all rules hold.
    Rules(Vec<(String, Rule)>),
    /// Nodes of any of these sets.
    Union(Vec<String>),
    /// Nodes of a population by id: those of a compartment set.
    Ids(String, Vec<u64>),
}

#[derive(Debug)]
enum Rule {
    /// One of these texts or numbers.
    OneOf(Vec<String>, Vec<f64>),
    /// Text that match from end to end.
    Matches(Regex),
    /// Numbers on one side of another.
    Compares(Compare, f64),
    /// All of these.
    All(Vec<Rule>),
}

#[derive(Clone, Copy, Debug)]
enum Compare {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl NodeSets {
    /// Names of all sets, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.sets.keys().map(String::as_str)
    }

    /// Adds the sets of a file; sets that are there already are replaced.
    pub(crate) fn add_file(&mut self, path: &Path) -> Result<(), CircuitError> {
        self.add(&Document::open(path)?)
    }

    pub(crate) fn add(&mut self, document: &Document) -> Result<(), CircuitError> {
        for (name, json) in document.root().entries()? {
            let choice = if json.value.is_array() {
                let names = json.items()?;
                let names = names.iter().map(|item| item.text().map(str::to_owned));
                Choice::Union(names.collect::<Result<_, _>>()?)
            } else {
                let rules = json.entries()?.into_iter();
                let rules = rules.map(|(attribute, rule)| {
                    if attribute == "node_id" {
                        check_ids(&rule)?;
                    }
                    Ok((attribute.into(), Rule::read(&rule)?))
                });
                Choice::Rules(rules.collect::<Result<_, CircuitError>>()?)
            };
            let file = json.file.into();
            self.sets.insert(name.into(), Set { file, choice });
        }
        Ok(())
    }

    /// Makes the nodes of compartment sets choices, too, where no node set has the name.
    pub(crate) fn add_compartment_sets(
        &mut self,
        sets: &BTreeMap<String, CompartmentSet>,
        file: &str,
    ) {
        for (name, set) in sets {
            let choice = Choice::Ids(set.population.clone(), set.nodes());
            let set = Set {
                file: file.into(),
                choice,
            };
            self.sets.entry(name.clone()).or_insert(set);
        }
    }

    /// The nodes of a set, in the populations' order. `file`: of the circuit, for errors.
    ///
    /// # Errors
    /// There is no such set, it needs itself, or it asks for an attribute that no population has.
    pub fn nodes(
        &self,
        populations: &[Population],
        file: &str,
        name: &str,
    ) -> Result<Vec<NodeRef>, CircuitError> {
        let mut found = BTreeSet::new();
        self.collect(
            (populations, file),
            name,
            &mut Vec::new(),
            &mut BTreeSet::new(),
            &mut found,
        )?;
        Ok(found.into_iter().collect())
    }

    fn collect<'a>(
        &'a self,
        (populations, circuit): (&[Population], &str),
        name: &'a str,
        way: &mut Vec<&'a str>,
        done: &mut BTreeSet<&'a str>,
        found: &mut BTreeSet<NodeRef>,
    ) -> Result<(), CircuitError> {
        let Some(set) = self.sets.get(name) else {
            let file = way.last().and_then(|last| self.sets.get(*last));
            let file = file.map_or(circuit, |set| &set.file);
            let fault = Fault::NoNodeSet {
                name: name.into(),
                there: self.names().collect::<Vec<_>>().join(", "),
            };
            return Err(CircuitError {
                file: file.into(),
                line: None,
                key: way.last().map(|&last| last.into()),
                fault,
            });
        };
        if way.contains(&name) || way.len() > 100 {
            way.push(name);
            let way = way.join(" → ");
            return Err(CircuitError::new(&set.file, name, Fault::Cycle { way }));
        }
        match &set.choice {
            Choice::Union(names) => {
                way.push(name);
                for inner in names {
                    if !done.contains(inner.as_str()) {
                        self.collect((populations, circuit), inner, way, done, found)?;
                    }
                }
                way.pop();
            }
            Choice::Ids(name, ids) => {
                let own = populations.iter().zip(0..).filter(|(p, _)| p.name == *name);
                for (population, index) in own {
                    let rows = population.ids.iter().zip(0..);
                    let rows = rows.filter(|(id, _)| ids.binary_search(id).is_ok());
                    found.extend(rows.map(|(_, row)| NodeRef {
                        population: index,
                        row,
                    }));
                }
            }
            Choice::Rules(rules) => {
                for (attribute, _) in rules {
                    let known = |p: &Population| column(p, attribute).is_some();
                    if !populations.iter().any(known) {
                        let key = format!("{name}.{attribute}");
                        let name = attribute.clone();
                        return Err(CircuitError::new(
                            &set.file,
                            key,
                            Fault::NoAttribute { name },
                        ));
                    }
                }
                for (population, index) in populations.iter().zip(0..) {
                    let rows = rows(population, rules);
                    found.extend(rows.map(|row| NodeRef {
                        population: index,
                        row,
                    }));
                }
            }
        }
        done.insert(name);
        Ok(())
    }
}

/// Ids are whole numbers of 0 or more.
fn check_ids(rule: &Json) -> Result<(), CircuitError> {
    let items = match rule.value {
        Value::Array(_) => rule.items()?,
        _ => vec![rule.clone()],
    };
    let wrong = |item: &&Json| item.value.is_number() && item.natural().is_err();
    items
        .iter()
        .find(wrong)
        .map_or(Ok(()), |item| item.natural().map(drop))
}

/// What a rule is about.
enum Of<'a> {
    Id(&'a [u64]),
    Name(&'a str),
    Place(&'a Population, usize),
    Attribute(&'a Attribute),
}

fn column<'a>(population: &'a Population, attribute: &str) -> Option<Of<'a>> {
    match attribute {
        "node_id" => Some(Of::Id(&population.ids)),
        "population" => Some(Of::Name(&population.name)),
        "x" => Some(Of::Place(population, 0)),
        "y" => Some(Of::Place(population, 1)),
        "z" => Some(Of::Place(population, 2)),
        other => population.attributes.get(other).map(Of::Attribute),
    }
}

/// Rows for which all rules hold; none if the population lacks an attribute.
fn rows<'a>(
    population: &'a Population,
    rules: &'a [(String, Rule)],
) -> impl Iterator<Item = u32> + 'a {
    let columns = rules.iter();
    let tests: Option<Vec<Test<'a>>> = columns
        .map(|(attribute, rule)| Some(Test::new(&column(population, attribute)?, rule)))
        .collect();
    let n = if tests.is_some() { population.len() } else { 0 };
    let holds = move |row: &u32| tests.iter().flatten().all(|test| test.holds(*row as usize));
    (0..n as u32).filter(holds)
}

/// A rule made ready for a column: texts are judged once each.
enum Test<'a> {
    All(bool),
    Text(&'a [u32], Vec<bool>),
    Numbers(Box<dyn Fn(usize) -> f64 + 'a>, &'a Rule),
    Ids(&'a [u64], BTreeSet<u64>, &'a Rule),
}

impl<'a> Test<'a> {
    fn new(of: &Of<'a>, rule: &'a Rule) -> Self {
        match *of {
            Of::Name(name) => Self::All(rule.holds_for_text(name)),
            Of::Id(ids) => {
                let set = match rule {
                    Rule::OneOf(_, numbers) => numbers.iter().map(|&n| n as u64).collect(),
                    _ => BTreeSet::new(),
                };
                Self::Ids(ids, set, rule)
            }
            Of::Place(population, axis) => {
                Self::Numbers(Box::new(move |row| population.positions[row][axis]), rule)
            }
            Of::Attribute(Attribute::Numbers(values)) => {
                Self::Numbers(Box::new(move |row| values[row]), rule)
            }
            Of::Attribute(Attribute::Text { library, indices }) => {
                let holds = library.iter().map(|text| rule.holds_for_text(text));
                Self::Text(indices, holds.collect())
            }
        }
    }

    fn holds(&self, row: usize) -> bool {
        match self {
            Self::All(holds) => *holds,
            Self::Text(indices, holds) => {
                holds.get(indices[row] as usize).copied().unwrap_or(false)
            }
            Self::Numbers(value, rule) => rule.holds_for_number(value(row)),
            Self::Ids(ids, set, Rule::OneOf(..)) => set.contains(&ids[row]),
            Self::Ids(ids, _, rule) => rule.holds_for_number(ids[row] as f64),
        }
    }
}

impl Rule {
    fn read(json: &Json) -> Result<Self, CircuitError> {
        match json.value {
            Value::Array(_) => {
                let (mut texts, mut numbers) = (Vec::new(), Vec::new());
                for item in json.items()? {
                    match item.value {
                        Value::String(text) => texts.push(text.clone()),
                        Value::Number(_) => numbers.push(item.real()?),
                        _ => return Err(item.wrong("a string or a number")),
                    }
                }
                Ok(Self::OneOf(texts, numbers))
            }
            Value::String(text) => Ok(Self::OneOf(vec![text.clone()], vec![])),
            Value::Bool(yes) => Ok(Self::OneOf(vec![yes.to_string()], vec![f64::from(*yes)])),
            Value::Number(_) => Ok(Self::OneOf(vec![], vec![json.real()?])),
            Value::Object(_) => {
                let rules = json.entries()?.into_iter();
                let rules = rules.map(|(operator, operand)| Self::operator(operator, &operand));
                Ok(Self::All(rules.collect::<Result<_, _>>()?))
            }
            Value::Null => Err(json.wrong("a value, a list or a rule")),
        }
    }

    fn operator(operator: &str, operand: &Json) -> Result<Self, CircuitError> {
        let compare = match operator {
            "$regex" => {
                let pattern = format!("^(?:{})$", operand.text()?);
                let regex = Regex::new(&pattern).map_err(|e| {
                    let reason = e.to_string();
                    operand.fault(Fault::Regex { reason })
                })?;
                return Ok(Self::Matches(regex));
            }
            "$lt" => Compare::Less,
            "$lte" => Compare::LessOrEqual,
            "$gt" => Compare::Greater,
            "$gte" => Compare::GreaterOrEqual,
            other => {
                return Err(operand.fault(Fault::Type {
                    found: other.into(),
                    expected: "$regex, $lt, $lte, $gt or $gte",
                }));
            }
        };
        Ok(Self::Compares(compare, operand.real()?))
    }

    fn holds_for_text(&self, text: &str) -> bool {
        match self {
            Self::OneOf(texts, numbers) => {
                let number = || text.parse::<f64>();
                texts.iter().any(|w| w == text)
                    || !numbers.is_empty() && number().is_ok_and(|n| numbers.contains(&n))
            }
            Self::Matches(regex) => regex.is_match(text),
            Self::Compares(..) => text.parse().is_ok_and(|n| self.holds_for_number(n)),
            Self::All(rules) => rules.iter().all(|rule| rule.holds_for_text(text)),
        }
    }

    fn holds_for_number(&self, number: f64) -> bool {
        match self {
            Self::OneOf(texts, numbers) => {
                let text = || number.to_string();
                numbers.contains(&number) || !texts.is_empty() && texts.contains(&text())
            }
            Self::Matches(regex) => regex.is_match(&number.to_string()),
            Self::Compares(compare, limit) => match compare {
                Compare::Less => number < *limit,
                Compare::LessOrEqual => number <= *limit,
                Compare::Greater => number > *limit,
                Compare::GreaterOrEqual => number >= *limit,
            },
            Self::All(rules) => rules.iter().all(|rule| rule.holds_for_number(number)),
        }
    }
}
