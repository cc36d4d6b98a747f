//! Neurons of MouseLight, as its browser exports them: `{"neurons": [{"soma": …, "axon": [sample …], "dendrite":
//! [sample …]}]}`, in µm.
//!
//! Axon and dendrite are numbered each for itself, and both begin with a copy of the soma. Samples have the types of
//! SWC, of which 5 and 6, forks and ends, are those of their tree. Of several neurons the first is read, with a warning,
//! or the one that is named.

use std::collections::HashMap;

use glam::DVec3;
use neurotess_morphology::NeuriteKind;
use serde::Deserialize;
use serde_json::value::RawValue;

use super::{Source, in_range};
use crate::forest::Forest;
use crate::sample::Sample;
use crate::text::Located;
use crate::warning::Warnings;
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_member(bytes, name, "", options)
}

/// Reads one neuron of a file. `member`: its `idString`; empty: the first.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_member(
    bytes: &[u8],
    name: &str,
    member: &str,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    read_text(Format::MouseLight, name, options, |name, warnings| {
        let mut source = Source::new(bytes)?;
        let neuron = neuron(&mut source, member, warnings)?;
        let name = if member.is_empty() { name } else { member };
        forest(&mut source, &neuron)?.build(name, warnings)
    })
}

/// What a file may have outermost.
#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow, default)]
    neurons: Option<Vec<&'a RawValue>>,
    #[serde(borrow, default)]
    neuron: Option<&'a RawValue>,
}

#[derive(Deserialize)]
struct Neuron<'a> {
    #[serde(rename = "idString", default)]
    id: Option<String>,
    #[serde(rename = "DOI", default)]
    doi: Option<String>,
    #[serde(borrow, default)]
    soma: Option<&'a RawValue>,
    #[serde(borrow, default)]
    axon: Option<Vec<&'a RawValue>>,
    #[serde(borrow, default)]
    dendrite: Option<Vec<&'a RawValue>>,
}

/// Where the soma is.
#[derive(Deserialize)]
struct Place {
    x: f64,
    y: f64,
    z: f64,
    #[serde(default)]
    radius: Option<f64>,
}

/// A traced point.
#[derive(Deserialize)]
struct Traced {
    #[serde(rename = "sampleNumber")]
    id: i64,
    #[serde(rename = "structureIdentifier", default)]
    kind: Option<i32>,
    x: f64,
    y: f64,
    z: f64,
    #[serde(default)]
    radius: Option<f64>,
    #[serde(rename = "parentNumber", default)]
    parent: Option<i64>,
}

fn neuron<'a>(
    source: &mut Source<'a>,
    member: &str,
    warnings: &mut Warnings,
) -> Located<Neuron<'a>> {
    let is_list = source.text.trim_start().starts_with('[');
    let neurons: Vec<&RawValue> = match is_list {
        true => source.whole()?,
        false => {
            let file: File = source.whole()?;
            match (file.neurons, file.neuron) {
                (Some(neurons), _) => neurons,
                (None, Some(neuron)) => vec![neuron],
                (None, None) => return source.whole(),
            }
        }
    };
    let Some((&first, others)) = neurons.split_first() else {
        return Err((1, Fault::NoSample));
    };
    if member.is_empty() {
        if let Some(second) = others.first() {
            let line = source.line(second);
            super::warn_of_others(line, others.len(), warnings);
        }
        return source.value(first);
    }
    let mut known = None;
    for neuron in &neurons {
        let neuron: Neuron = source.value(neuron)?;
        if neuron.id.as_deref() == Some(member) {
            return Ok(neuron);
        }
        known = known.or(neuron.id);
    }
    Err((1, super::no_member(member, neurons.len(), known)))
}

fn forest<'a>(source: &mut Source<'a>, neuron: &Neuron<'a>) -> Located<Forest> {
    let mut forest = Forest::default();
    let named = [&neuron.id, &neuron.doi].into_iter().flatten();
    forest.header = named.filter(|name| !name.is_empty()).cloned().collect();
    let mut soma = None;
    if let Some(place) = neuron.soma {
        let line = source.line(place);
        if let Some(at) = source.value::<Option<Place>>(place)? {
            let sample = sample(line, [at.x, at.y, at.z], at.radius)?;
            soma = Some(forest.push(1, NeuriteKind::SOMA, sample, None));
        }
    }
    for (tree, kind) in [
        (&neuron.axon, NeuriteKind::AXON),
        (&neuron.dendrite, NeuriteKind::BASAL_DENDRITE),
    ] {
        add_tree(
            source,
            tree.as_deref().unwrap_or_default(),
            kind,
            &mut forest,
            &mut soma,
        )?;
    }
    Ok(forest)
}

/// Appends an axon or a dendrite. A root that is the soma, or is where it is, stands for it.
fn add_tree(
    source: &mut Source,
    rows: &[&RawValue],
    own: NeuriteKind,
    forest: &mut Forest,
    soma: &mut Option<u32>,
) -> Located<()> {
    let mut index: HashMap<i64, u32> = HashMap::new();
    let mut lines: HashMap<i64, u64> = HashMap::new();
    let mut links = Vec::new();
    for row in rows {
        let line = source.line(row);
        // A value's lifetime is the text's, not the row's.
        let traced: Traced = serde_json::from_str(row.get()).map_err(|e| super::fault(line, &e))?;
        let sample = sample(line, [traced.x, traced.y, traced.z], traced.radius)?;
        let id = traced.id;
        let parent = traced.parent.filter(|&parent| parent >= 0);
        let is_soma = parent.is_none() && traced.kind == Some(NeuriteKind::SOMA.0);
        let copies_soma = parent.is_none()
            && soma.is_some_and(|soma| forest.node(soma).position == sample.position);
        let point = match *soma {
            Some(soma) if is_soma || copies_soma => {
                // The place of the soma is told without its radius.
                if forest.node(soma).radius <= 0.0 && is_soma {
                    forest.set_radius(soma, sample.radius);
                }
                soma
            }
            _ => {
                let kind = match traced.kind {
                    _ if is_soma => NeuriteKind::SOMA,
                    None | Some(0 | 1 | 5 | 6) => own,
                    Some(kind) => NeuriteKind(kind),
                };
                forest.push(forest.len() as i64 + 1, kind, sample, None)
            }
        };
        if is_soma {
            soma.get_or_insert(point);
        }
        if index.insert(id, point).is_some() {
            let first_line = lines.get(&id).copied().unwrap_or(1);
            return Err((line, Fault::RepeatedId { id, first_line }));
        }
        lines.insert(id, line);
        links.extend(parent.map(|parent| (id, parent, point, line)));
    }
    for (id, parent, point, line) in links {
        let unknown = (line, Fault::UnknownParent { id, parent });
        forest.set_parent(point, *index.get(&parent).ok_or(unknown)?);
    }
    Ok(())
}

fn sample(line: u64, [x, y, z]: [f64; 3], radius: Option<f64>) -> Located<Sample> {
    let radius = radius.filter(|&radius| radius > 0.0).unwrap_or(0.0);
    let position = DVec3::new(
        in_range(line, "x", x)?,
        in_range(line, "y", y)?,
        in_range(line, "z", z)?,
    );
    Ok(Sample {
        position,
        radius: in_range(line, "the radius", radius)?,
        line,
    })
}
