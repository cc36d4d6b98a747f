//! A population of nodes from its file: ids, groups, types, attributes, places.
//!
//! ```text
//! /nodes/<population>/node_type_id            n rows, one per node
//!                    /node_id                 optional: 0 … n-1 without it
//!                    /node_group_id, node_group_index   optional: all in group 0, in order
//!                    /<group>/<attribute>     rows of the group, perhaps more than are used
//!                    /<group>/@library/<attribute>   texts that the attribute's numbers stand for
//! ```
//!
//! An attribute of a group overrides that of the node's type.

use std::collections::{BTreeSet, HashMap};

use crate::hdf5::{Column, Store};
use crate::sonata::types::Types;
use crate::{Attribute, CircuitError, Fault, Warning};

/// Rows of a population and where their attributes are.
pub(crate) struct Table<'a> {
    store: &'a Store,
    types: &'a Types,
    /// Path of the population.
    path: String,
    pub(crate) ids: Vec<u64>,
    type_ids: Vec<i64>,
    groups: Vec<Group>,
}

/// What a node becomes besides its columns: a place, a rotation, a template, rows of groups.
const BYTES_OF_NODE: u64 = 64;

/// Nodes that share datasets.
struct Group {
    path: String,
    /// Row in the population and row in the group; `None` if they are the same for all nodes.
    rows: Option<Vec<(u32, u64)>>,
}

/// A dataset of vectors.
pub(crate) struct Vectors {
    /// Its path.
    pub(crate) path: String,
    /// Row in the population, and the vector.
    pub(crate) rows: Vec<(u32, [f64; 3])>,
}

impl<'a> Table<'a> {
    /// Reads what rows there are.
    pub(crate) fn open(
        store: &'a Store,
        population: &str,
        types: &'a Types,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, CircuitError> {
        let path = format!("nodes/{population}");
        let type_path = format!("{path}/node_type_id");
        let n = rows_of(store, &path)?;
        store.afford(&path, n.saturating_mul(BYTES_OF_NODE))?;
        let type_ids = if store.has(&type_path) {
            store.wholes(&type_path)?
        } else {
            vec![-1; n as usize]
        };
        let mut table = Self {
            store,
            types,
            groups: groups(store, &path, n)?,
            ids: (0..n).collect(),
            type_ids,
            path,
        };
        let id_path = format!("{}/node_id", table.path);
        if store.has(&id_path) {
            table.ids = store.naturals(&id_path)?;
            table.same_length(&id_path, table.ids.len())?;
        }
        table.warn(warnings);
        Ok(table)
    }

    fn same_length(&self, path: &str, found: usize) -> Result<(), CircuitError> {
        if found == self.type_ids.len() {
            return Ok(());
        }
        let expected = format!("[{}], one row per node", self.type_ids.len());
        let found = vec![found as u64];
        Err(self.store.fault(path, Fault::Shape { found, expected }))
    }

    fn warn(&self, warnings: &mut Vec<Warning>) {
        let file = self.store.name();
        let mut sorted = self.ids.clone();
        sorted.sort_unstable();
        let repeated = sorted.windows(2).filter(|w| w[0] == w[1]).count();
        if repeated > 0 {
            let key = format!("{}/node_id", self.path);
            let message = format!("{repeated} ids stand for another node already");
            let warning = Warning::new(file, key, "node_id_repeated", message);
            warnings.push(warning.times(repeated as u64));
        }
        let unknown = |id: &&i64| !self.types.knows(**id);
        let count = self.type_ids.iter().filter(unknown).count();
        if count > 0 && !self.types.is_empty() {
            let key = format!("{}/node_type_id", self.path);
            let message = format!("{count} nodes have a type that the table of types lacks");
            let warning = Warning::new(file, key, "node_type_unknown", message);
            warnings.push(warning.times(count as u64));
        }
    }

    /// How many nodes there are.
    pub(crate) fn len(&self) -> usize {
        self.ids.len()
    }

    /// Path of the population.
    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    /// The path that an error about an attribute names.
    pub(crate) fn key(&self, attribute: &str) -> String {
        let mut paths = self
            .groups
            .iter()
            .map(|g| format!("{}/{attribute}", g.path));
        let own = paths.find(|path| self.store.has(path));
        own.unwrap_or_else(|| format!("{}: column {attribute}", self.path))
    }

    /// Whether each node is in a group that has the dataset.
    pub(crate) fn rows_with(&self, dataset: &str) -> Vec<bool> {
        let mut with = vec![false; self.len()];
        for group in &self.groups {
            if self.store.has(&format!("{}/{dataset}", group.path)) {
                match &group.rows {
                    None => with.fill(true),
                    Some(rows) => rows
                        .iter()
                        .for_each(|&(node, _)| with[node as usize] = true),
                }
            }
        }
        with
    }

    /// Datasets of this name with a row of up to three numbers a node: for each, its path, and of each node of its
    /// group row and numbers, 0 for those that are not there. Others of this name, of one dimension, are attributes.
    pub(crate) fn vectors(&self, name: &str) -> Result<Vec<Vectors>, CircuitError> {
        let mut all = Vec::new();
        for group in &self.groups {
            let path = format!("{}/{name}", group.path);
            if !self.store.has(&path) {
                continue;
            }
            let shape = self.store.shape(&path)?;
            let [available, width] = shape[..] else {
                continue;
            };
            let rows = match &group.rows {
                Some(rows) => rows.clone(),
                None => (0..self.len() as u32).map(|r| (r, u64::from(r))).collect(),
            };
            let needed = rows.iter().map(|&(_, row)| row + 1).max().unwrap_or(0);
            if !(1..=3).contains(&width) || available < needed {
                let expected = format!("at least [{needed}, 3]");
                let found = shape;
                return Err(self.store.fault(&path, Fault::Shape { found, expected }));
            }
            let numbers = self.store.matrix(&path, available, width)?;
            let width = width as usize;
            let vector = |(node, row): (u32, u64)| {
                let own = &numbers[row as usize * width..][..width];
                let mut vector = [0.0; 3];
                vector[..width].copy_from_slice(own);
                (node, vector)
            };
            all.push(Vectors {
                rows: rows.into_iter().map(vector).collect(),
                path,
            });
        }
        Ok(all)
    }

    /// Names of all attributes, sorted.
    pub(crate) fn attributes(&self) -> BTreeSet<String> {
        let of_groups = self
            .groups
            .iter()
            .flat_map(|g| self.store.datasets(&g.path));
        let of_types = self.types.attributes().map(str::to_owned);
        of_groups.chain(of_types).collect()
    }

    /// Whether any group or type has the attribute.
    pub(crate) fn has(&self, attribute: &str) -> bool {
        let mut paths = self
            .groups
            .iter()
            .map(|g| format!("{}/{attribute}", g.path));
        self.types.has(attribute) || paths.any(|path| self.store.has(&path))
    }

    /// An attribute as numbers; NaN where there is none. `None` if no node has it.
    pub(crate) fn numbers(&self, attribute: &str) -> Result<Option<Vec<f64>>, CircuitError> {
        match self.attribute(attribute)? {
            None => Ok(None),
            Some(Attribute::Numbers(values)) => Ok(Some(values)),
            Some(Attribute::Text { .. }) => {
                let (found, expected) = ("text".into(), "numbers");
                let fault = Fault::Type { found, expected };
                Err(self.store.fault(&self.key(attribute), fault))
            }
        }
    }

    /// An attribute. `None` if no node has it.
    pub(crate) fn attribute(&self, name: &str) -> Result<Option<Attribute>, CircuitError> {
        let mut column = self.of_types(name);
        for group in &self.groups {
            let path = format!("{}/{name}", group.path);
            if !self.store.has(&path) {
                continue;
            }
            let library = format!("{}/@library/{name}", group.path);
            let own = self.store.column(&path, &library)?;
            column = Some(match (column, &group.rows) {
                (None, None) if rows(&own) == self.len() => attribute(own),
                (column, _) => self.overlay(column, own, group, &path)?,
            });
        }
        Ok(column)
    }

    /// An attribute of the types, spread over the nodes.
    fn of_types(&self, name: &str) -> Option<Attribute> {
        if !self.types.has(name) {
            return None;
        }
        let values = self.types.values(name);
        let parsed: HashMap<i64, Option<f64>> = values
            .iter()
            .map(|(&id, text)| (id, text.parse().ok()))
            .collect();
        // A file may be called 471087815.
        if name != "morphology" && parsed.values().all(Option::is_some) {
            let number = |id| parsed.get(id).copied().flatten().unwrap_or(f64::NAN);
            return Some(Attribute::Numbers(
                self.type_ids.iter().map(number).collect(),
            ));
        }
        let mut library: Vec<String> = values.values().map(|&text| text.into()).collect();
        library.sort();
        library.dedup();
        let place = |(&id, &text): (&i64, &&str)| {
            let place = library.binary_search_by(|w| w.as_str().cmp(text));
            (id, place.map_or(Attribute::NONE, |p| p as u32))
        };
        let places: HashMap<i64, u32> = values.iter().map(place).collect();
        let index = |id| places.get(id).copied().unwrap_or(Attribute::NONE);
        let indices = self.type_ids.iter().map(index).collect();
        Some(Attribute::Text { library, indices })
    }

    /// Puts a group's rows over what is known already.
    fn overlay(
        &self,
        base: Option<Attribute>,
        own: Column,
        group: &Group,
        path: &str,
    ) -> Result<Attribute, CircuitError> {
        let available = rows(&own) as u64;
        let in_order: Vec<(u32, u64)>;
        let pairs = match &group.rows {
            Some(pairs) => pairs,
            None => {
                in_order = (0..self.len() as u32).map(|r| (r, u64::from(r))).collect();
                &in_order
            }
        };
        if let Some(&(_, row)) = pairs.iter().find(|&&(_, row)| row >= available) {
            let expected = format!("at least [{}], for the group's nodes", row + 1);
            let found = vec![available];
            return Err(self.store.fault(path, Fault::Shape { found, expected }));
        }
        let own = attribute(own);
        let mut base = base.unwrap_or_else(|| match own {
            Attribute::Numbers(_) => Attribute::Numbers(vec![f64::NAN; self.len()]),
            Attribute::Text { .. } => Attribute::Text {
                library: vec![],
                indices: vec![Attribute::NONE; self.len()],
            },
        });
        if let (Attribute::Numbers(values), Attribute::Numbers(own)) = (&mut base, &own) {
            for &(node, row) in pairs {
                values[node as usize] = own[row as usize];
            }
            return Ok(base);
        }
        let (mut library, mut indices) = texts(base);
        let (own_library, own_indices) = texts(own);
        let mut places: Vec<u32> = Vec::with_capacity(own_library.len());
        for text in own_library {
            let known = library.iter().position(|other| *other == text);
            places.push(known.unwrap_or(library.len()) as u32);
            if known.is_none() {
                library.push(text);
            }
        }
        for &(node, row) in pairs {
            let place = places.get(own_indices[row as usize] as usize);
            indices[node as usize] = place.copied().unwrap_or(Attribute::NONE);
        }
        Ok(Attribute::Text { library, indices })
    }
}

/// How many nodes there are: as many as the datasets of the population have rows, or else as the first
/// attribute of group 0.
fn rows_of(store: &Store, path: &str) -> Result<u64, CircuitError> {
    let own = ["node_type_id", "node_id", "node_group_id"].map(|name| format!("{path}/{name}"));
    if let Some(dataset) = store.first_of(&own) {
        return store.rows(&dataset);
    }
    let Some(attribute) = store.datasets(&format!("{path}/0")).into_iter().next() else {
        return Err(store.fault(&own[0], Fault::Missing));
    };
    let attribute = format!("{path}/0/{attribute}");
    match store.shape(&attribute)?[..] {
        // Like `positions`.
        [rows, _] if rows <= u64::from(u32::MAX) => store.believe(&attribute).map(|()| rows),
        _ => store.rows(&attribute),
    }
}

fn groups(store: &Store, path: &str, n: u64) -> Result<Vec<Group>, CircuitError> {
    let id_path = format!("{path}/node_group_id");
    if !store.has(&id_path) {
        let path = format!("{path}/0");
        return Ok(vec![Group { path, rows: None }]);
    }
    let ids = store.naturals(&id_path)?;
    let index_path = format!("{path}/node_group_index");
    let indices = if store.has(&index_path) {
        store.naturals(&index_path)?
    } else {
        (0..n).collect()
    };
    for (path, found) in [(&id_path, ids.len()), (&index_path, indices.len())] {
        if found as u64 != n {
            let (found, expected) = (vec![found as u64], format!("[{n}], one row per node"));
            return Err(store.fault(path, Fault::Shape { found, expected }));
        }
    }
    let mut rows: HashMap<u64, Vec<(u32, u64)>> = HashMap::new();
    for (node, (&id, &index)) in (0..).zip(ids.iter().zip(&indices)) {
        rows.entry(id).or_default().push((node, index));
    }
    let mut groups: Vec<(u64, Vec<(u32, u64)>)> = rows.into_iter().collect();
    groups.sort_unstable_by_key(|&(id, _)| id);
    let group = |(id, rows): (u64, Vec<(u32, u64)>)| {
        let path = format!("{path}/{id}");
        if !store.has_group(&path) {
            return Err(store.fault(&path, Fault::Missing));
        }
        let in_order = rows.len() as u64 == n && rows.iter().all(|&(r, i)| u64::from(r) == i);
        let rows = (!in_order).then_some(rows);
        Ok(Group { path, rows })
    };
    groups.into_iter().map(group).collect()
}

fn rows(column: &Column) -> usize {
    match column {
        Column::Numbers(values) => values.len(),
        Column::Text { indices, .. } => indices.len(),
    }
}

fn attribute(column: Column) -> Attribute {
    match column {
        Column::Numbers(values) => Attribute::Numbers(values),
        Column::Text { library, indices } => Attribute::Text { library, indices },
    }
}

/// Text of an attribute; numbers as text.
fn texts(attribute: Attribute) -> (Vec<String>, Vec<u32>) {
    match attribute {
        Attribute::Text { library, indices } => (library, indices),
        Attribute::Numbers(values) => {
            let mut library = Vec::new();
            let mut places: HashMap<u64, u32> = HashMap::new();
            let mut place = |value: f64| {
                if value.is_nan() {
                    return Attribute::NONE;
                }
                *places.entry(value.to_bits()).or_insert_with(|| {
                    library.push(value.to_string());
                    library.len() as u32 - 1
                })
            };
            let indices = values.into_iter().map(&mut place).collect();
            (library, indices)
        }
    }
}
