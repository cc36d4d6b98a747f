//! Skeletons of CATMAID, as `compact-skeleton`, `compact-arbor` and `compact-detail` give them:
//! `[[[id, parent, user, x, y, z, radius, confidence, …] …], connectors, {tag: [ids]}, …]`, in **nanometers**
//! (<https://catmaid.readthedocs.io>, the API). Several skeletons stand by their numbers in `{"skeletons": {…}}`, of which
//! the first is read, with a warning, or the one that is named.
//!
//! A radius of −1 is none. A node that is tagged `soma`, and has a radius, is the soma. Types are not told.

use std::collections::{BTreeMap, HashSet};

use glam::DVec3;
use neurotess_morphology::NeuriteKind;
use serde::Deserialize;
use serde_json::Value;
use serde_json::value::RawValue;

use super::{Source, in_range};
use crate::forest::Forest;
use crate::sample::Sample;
use crate::text::Located;
use crate::unit::NANOMETER;
use crate::warning::Warnings;
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_member(bytes, name, "", options)
}

/// Reads one skeleton of a file. `member`: its number; empty: the first.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_member(
    bytes: &[u8],
    name: &str,
    member: &str,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    read_text(Format::Catmaid, name, options, |name, warnings| {
        let mut source = Source::new(bytes)?;
        let parts = skeleton(&mut source, member, warnings)?;
        let name = if member.is_empty() { name } else { member };
        forest(&mut source, &parts)?.build(name, warnings)
    })
}

#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow)]
    skeletons: BTreeMap<String, &'a RawValue>,
}

/// Nodes, connectors, tags and whatever else is told of a skeleton.
fn skeleton<'a>(
    source: &mut Source<'a>,
    member: &str,
    warnings: &mut Warnings,
) -> Located<Vec<&'a RawValue>> {
    if source.text.trim_start().starts_with('[') {
        return source.whole();
    }
    let file: File = source.whole()?;
    if !member.is_empty() {
        let known = file.skeletons.keys().next().cloned();
        let missing = (1, super::no_member(member, file.skeletons.len(), known));
        let skeleton = *file.skeletons.get(member).ok_or(missing)?;
        return source.value(skeleton);
    }
    let mut skeletons = file.skeletons.into_values();
    let Some(first) = skeletons.next() else {
        return Err((1, Fault::NoSample));
    };
    if let Some(second) = skeletons.next() {
        let line = source.line(second);
        super::warn_of_others(line, 1 + skeletons.count(), warnings);
    }
    source.value(first)
}

fn forest(source: &mut Source, parts: &[&RawValue]) -> Located<Forest> {
    let Some((nodes, others)) = parts.split_first() else {
        return Err((1, Fault::NoSample));
    };
    let line = source.line(nodes);
    let rows: Vec<&RawValue> =
        serde_json::from_str(nodes.get()).map_err(|e| super::fault(line, &e))?;
    let somata = somata(others);
    let mut forest = Forest::default();
    let mut parents = Vec::with_capacity(rows.len());
    for row in rows {
        let line = source.line(row);
        let fields: Vec<Value> =
            serde_json::from_str(row.get()).map_err(|e| super::fault(line, &e))?;
        let row = Row {
            line,
            fields: &fields,
        };
        let id = row.whole(0, "the node's number")?;
        let sample = Sample {
            position: DVec3::new(row.real(3, "x")?, row.real(4, "y")?, row.real(5, "z")?)
                * NANOMETER,
            radius: row.radius()? * NANOMETER,
            line,
        };
        let soma = somata.contains(&id) && sample.radius > 0.0;
        let kind = if soma {
            NeuriteKind::SOMA
        } else {
            NeuriteKind::UNDEFINED
        };
        forest.push(id, kind, sample, None);
        parents.push(match fields.get(1) {
            None | Some(Value::Null) => None,
            Some(_) => Some(row.whole(1, "the parent's number")?).filter(|&p| p >= 0),
        });
    }
    let index = forest.by_number(0)?;
    for (i, parent) in (0..).zip(parents) {
        let Some(parent) = parent else { continue };
        let id = forest.node(i).id;
        let unknown = (forest.line(i), Fault::UnknownParent { id, parent });
        forest.set_parent(i, *index.get(&parent).ok_or(unknown)?);
    }
    Ok(forest)
}

/// Nodes that a tag calls somata.
fn somata(parts: &[&RawValue]) -> HashSet<i64> {
    let mut somata = HashSet::new();
    for part in parts {
        let Ok(tags) = serde_json::from_str::<BTreeMap<String, Value>>(part.get()) else {
            continue;
        };
        for (tag, nodes) in tags {
            if tag.trim().eq_ignore_ascii_case("soma")
                && let Value::Array(nodes) = nodes
            {
                somata.extend(nodes.iter().filter_map(Value::as_i64));
            }
        }
    }
    somata
}

/// The numbers of a node.
struct Row<'a> {
    line: u64,
    fields: &'a [Value],
}

impl Row<'_> {
    fn whole(&self, index: usize, column: &'static str) -> Located<i64> {
        let number = self.fields.get(index).and_then(Value::as_i64);
        number.ok_or_else(|| self.fault(index, column))
    }

    fn real(&self, index: usize, column: &'static str) -> Located<f64> {
        let number = self.fields.get(index).and_then(Value::as_f64);
        let number = number.ok_or_else(|| self.fault(index, column))?;
        in_range(self.line, column, number)
    }

    /// The radius; 0 where there is none.
    fn radius(&self) -> Located<f64> {
        match self.fields.get(6) {
            None | Some(Value::Null) => Ok(0.0),
            Some(_) => self.real(6, "the radius").map(|radius| radius.max(0.0)),
        }
    }

    fn fault(&self, index: usize, column: &'static str) -> (u64, Fault) {
        let text = self.fields.get(index).map(Value::to_string);
        let text: String = text.unwrap_or_default().chars().take(40).collect();
        (self.line, Fault::NotANumber { column, text })
    }
}
