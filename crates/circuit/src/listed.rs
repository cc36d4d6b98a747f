//! Circuits whose cells are listed one by one, as scenes do it.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};

use crate::template::{Template, TemplateId};
use crate::transform::Placement;
use crate::{Attribute, Circuit, CircuitError, NodeSets, Population, Warning};

/// A cell of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) id: u64,
    pub(crate) placement: Placement,
    pub(crate) recentered: bool,
    /// Morphology file; `None` shows nothing.
    pub(crate) file: Option<PathBuf>,
    pub(crate) attributes: BTreeMap<String, String>,
}

impl Cell {
    pub(crate) const PLACED_AT_ORIGIN: Placement = (DVec3::ZERO, DQuat::IDENTITY, 1.0);
}

/// The circuit of these cells, in one population. Files that are not there are told of.
pub(crate) fn circuit(
    file: &Path,
    format: &'static str,
    cells: &[Cell],
    mut warnings: Vec<Warning>,
    failures: Vec<CircuitError>,
) -> Circuit {
    let name = file.display().to_string();
    let mut templates: Vec<Template> = Vec::new();
    let mut known: HashMap<&Path, Option<TemplateId>> = HashMap::new();
    let mut missing: Vec<&Path> = Vec::new();
    let mut of_cells = Vec::with_capacity(cells.len());
    for cell in cells {
        let template = cell.file.as_ref().and_then(|path| {
            *known.entry(path).or_insert_with(|| {
                // Of a container, FILE#NAME.
                if neurotess_formats::file_of(path).is_file() {
                    templates.push(Template::new(path.clone()));
                    Some(TemplateId(templates.len() as u32 - 1))
                } else {
                    missing.push(path);
                    None
                }
            })
        });
        of_cells.push(template);
    }
    if let Some(first) = missing.first() {
        let nodes = cells.iter().zip(&of_cells);
        let count = nodes
            .filter(|(c, t)| c.file.is_some() && t.is_none())
            .count();
        let message = format!(
            "{} morphologies of {count} cells are not there, the first is {}",
            missing.len(),
            first.display()
        );
        let warning = Warning::new(&name, "", "morphology_missing", message);
        warnings.push(warning.times(count as u64));
    }
    let mut names: Vec<&String> = cells.iter().flat_map(|c| c.attributes.keys()).collect();
    names.sort_unstable();
    names.dedup();
    let attributes = names.into_iter().map(|name| {
        let texts = cells
            .iter()
            .map(|c| c.attributes.get(name).map(String::as_str));
        (name.clone(), column(texts))
    });
    let population = Population {
        name: "cells".into(),
        kind: String::new(),
        ids: cells.iter().map(|c| c.id).collect(),
        positions: cells.iter().map(|c| c.placement.0).collect(),
        rotations: cells.iter().map(|c| c.placement.1).collect(),
        scales: cells.iter().map(|c| c.placement.2).collect(),
        recentered: cells.iter().map(|c| c.recentered).collect(),
        templates: of_cells,
        attributes: attributes.collect(),
    };
    Circuit {
        file: name,
        format,
        populations: vec![population],
        templates,
        node_sets: NodeSets::default(),
        edges: vec![],
        reports: BTreeMap::new(),
        compartment_sets: BTreeMap::new(),
        declared_reports: Vec::new(),
        warnings,
        failures,
    }
}

fn column<'a>(texts: impl Iterator<Item = Option<&'a str>>) -> Attribute {
    let mut library: Vec<String> = Vec::new();
    let mut places: HashMap<&str, u32> = HashMap::new();
    let mut place = |text: Option<&'a str>| match text {
        None => Attribute::NONE,
        Some(text) => *places.entry(text).or_insert_with(|| {
            library.push(text.into());
            library.len() as u32 - 1
        }),
    };
    let indices = texts.map(&mut place).collect();
    Attribute::Text { library, indices }
}
