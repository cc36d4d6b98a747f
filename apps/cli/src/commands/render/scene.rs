//! The scene: files in their own coordinates, cells of a circuit at their placements.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use itertools::Itertools;
use neurotess::batch::{Input, Inputs, MORPHOLOGIES};
use neurotess::cache::{Cache, Summary};
use neurotess::circuit::{Compartment, Instance, soma_center};
use neurotess::coloring::cuts;
use neurotess::picture::Placement;

use super::args::RenderArgs;
use super::cells::{self, MeshedCell};
use super::circuit_instances::CircuitInstances;
use crate::io::circuits::{self, partition};
use crate::report::{Entry, Failed, Failure, Reporter, usage};

/// What is drawn.
pub(crate) struct RenderScene {
    /// Distinct cells, and inputs that failed.
    pub(crate) entries: Vec<Entry<MeshedCell>>,
    /// For each instance the index of its cell among those that did not fail, and its placement.
    pub(crate) placements: Vec<(usize, Placement)>,
    /// The circuit of the placements.
    pub(crate) instances: Option<CircuitInstances>,
    /// What the circuit's cache was good for.
    pub(crate) cache: Option<Summary>,
}

/// Reads and meshes all inputs: tracings, or one circuit.
///
/// # Errors
/// Wrong usage: a circuit beside other inputs, or a selection of cells without a circuit.
pub(crate) fn read(args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<RenderScene> {
    let (circuits, others) = partition(&args.inputs);
    match &circuits[..] {
        [path] if others.is_empty() => of_circuit(path, args, reporter),
        [] => {
            check_of_cells(args)?;
            let inputs = Inputs::find(&args.inputs, &MORPHOLOGIES);
            let entries = cells::read(&inputs, &HashMap::new(), args, None, reporter)?;
            let done = entries.iter().filter(|e| matches!(e, Entry::Done(_)));
            let placements = (0..done.count()).map(|cell| (cell, Placement::default()));
            Ok(RenderScene {
                placements: placements.collect(),
                entries,
                instances: None,
                cache: None,
            })
        }
        _ => usage("a circuit is drawn alone: leave out the other inputs"),
    }
}

/// Checks the options of cells that are not those of a circuit.
///
/// # Errors
/// Wrong usage: what only circuits have.
pub(crate) fn check_of_cells(args: &RenderArgs) -> anyhow::Result<()> {
    if args.cells.any() {
        return usage("no input is a circuit: leave out what chooses cells of one");
    }
    if args.color_by_attribute.is_some() {
        return usage("--color-by-attribute needs a circuit, whose cells have attributes");
    }
    if args.report.is_some() {
        return usage("--report needs a circuit, whose cells have its values");
    }
    Ok(())
}

fn of_circuit(path: &Path, args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<RenderScene> {
    let opened = circuits::open(path, reporter).and_then(|circuit| {
        let nodes = args.cells.select(&circuit)?;
        Ok((circuit, nodes))
    });
    let (circuit, nodes) = match opened {
        Ok(opened) => opened,
        Err(failure) => {
            reporter.failure(&failure);
            let failed = Failed {
                file: path.display().to_string(),
                error: failure.0,
            };
            return Ok(RenderScene {
                entries: vec![Entry::Failed(failed)],
                placements: Vec::new(),
                instances: None,
                cache: None,
            });
        }
    };
    let instances = circuit.instances(&nodes, None);
    if instances.len() < nodes.len() {
        reporter.warning(&format!(
            "{}: {} of {} chosen cells have no morphology or place: left out",
            circuit.file,
            nodes.len() - instances.len(),
            nodes.len()
        ));
    }
    if instances.is_empty() {
        let nothing = format!("{}: no cell to draw: choose others", path.display());
        reporter.failure(&Failure(nothing));
    }
    // Each morphology once, whatever the number of cells that show it.
    let mut of_template: BTreeMap<usize, usize> = BTreeMap::new();
    for instance in &instances {
        of_template.insert(instance.template.index(), 0);
    }
    let input = |&template: &usize| Input {
        path: circuit.templates[template].path.clone(),
        relative: circuit.templates[template].path.clone(),
    };
    let inputs = Inputs {
        files: of_template.keys().map(input).collect(),
        ..Inputs::default()
    };
    let cuts = match &args.report {
        Some(report) => {
            let cell = |i: &Instance| (i.template.index(), i.node);
            let nodes: Vec<_> = instances.iter().map(cell).collect();
            // The message only: with its source, it would be printed twice.
            cuts(report, &circuit, &nodes).map_err(|e| anyhow::anyhow!("{e}"))?
        }
        None => HashMap::new(),
    };
    let of_path = |(template, cut): (usize, Vec<Compartment>)| {
        (circuit.templates[template].path.clone(), cut)
    };
    let cuts = cuts.into_iter().map(of_path).collect();
    let cache = (!args.cache.no_cache).then(|| Cache::open(Path::new(&circuit.file)));
    let entries = cells::read(&inputs, &cuts, args, cache.as_ref(), reporter)?;
    let cache = cache.map(Cache::finish);
    for warning in cache.iter().flat_map(|summary| &summary.warnings) {
        reporter.warning(&warning.to_string());
    }
    // Indices of cells among those that did not fail; none for those that did.
    let mut centers = Vec::new();
    for (entry, index) in entries.iter().zip_eq(of_template.values_mut()) {
        *index = centers.len();
        match entry {
            Entry::Done(cell) => centers.push(soma_center(&cell.morphology)),
            Entry::Failed(_) => *index = usize::MAX,
        }
    }
    let mut placed = Vec::new();
    let placements = instances.iter().filter_map(|instance| {
        let cell = of_template[&instance.template.index()];
        let center = centers.get(cell)?;
        let placement = Placement {
            rotation: instance.rotation,
            scale: instance.scale,
            translation: instance.world_from_cell(*center).translation,
        };
        placed.push(*instance);
        Some((cell, placement))
    });
    Ok(RenderScene {
        placements: placements.collect(),
        entries,
        instances: Some(CircuitInstances {
            circuit,
            instances: placed,
        }),
        cache,
    })
}
