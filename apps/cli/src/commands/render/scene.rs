//! Where cells stand: files in their own coordinates, cells of a circuit where it puts them.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use neurotess::circuit::{Compartment, Instance, soma_center};
use neurotess::coloring::cuts;
use neurotess::render::{BoundingSphere, Placement, bounds, merged};
use rayon::prelude::*;

use super::args::RenderArgs;
use super::cells::{self, Cell};
use super::circuit_instances::Shown;
use crate::io::circuits::{self, partition};
use crate::io::inputs::{Input, Inputs};
use crate::report::{Entry, Failed, Failure, Reporter, usage};

/// From so many places on, a cell is framed by a few balls instead of one per point.
const MANY: usize = 64;

/// Most balls that a scene is framed by, and its tiles are tested with: milliseconds of work.
const MOST_BALLS: usize = 400_000;
/// Fewest of a cell.
const FEWEST: usize = 16;

/// What is drawn.
pub(crate) struct Cast {
    /// Distinct cells, and inputs that failed.
    pub(crate) entries: Vec<Entry<Cell>>,
    /// Cell, as counted among those that did not fail, and where it stands.
    pub(crate) places: Vec<(usize, Placement)>,
    /// The circuit that the places are of.
    pub(crate) shown: Option<Shown>,
}

/// Reads and meshes all inputs: tracings, or one circuit.
///
/// # Errors
/// Wrong usage: a circuit beside other inputs, or a choice of cells without a circuit.
pub(crate) fn cast(args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<Cast> {
    let (circuits, others) = partition(&args.inputs);
    match &circuits[..] {
        [path] if others.is_empty() => of_circuit(path, args, reporter),
        [] if args.cells.any() => {
            usage("no input is a circuit: leave out what chooses cells of one")
        }
        [] if args.color_by_attribute.is_some() => {
            usage("--color-by-attribute needs a circuit, whose cells have attributes")
        }
        [] if args.report.is_some() => {
            usage("--report needs a circuit, whose cells have its values")
        }
        [] => {
            let inputs = Inputs::find(&args.inputs, &crate::io::morphologies::MORPHOLOGIES);
            let entries = cells::read(&inputs, &HashMap::new(), args, reporter)?;
            let done = entries.iter().filter(|e| matches!(e, Entry::Done(_)));
            let places = (0..done.count()).map(|cell| (cell, Placement::default()));
            Ok(Cast {
                places: places.collect(),
                entries,
                shown: None,
            })
        }
        _ => usage("a circuit is drawn alone: leave out the other inputs"),
    }
}

fn of_circuit(path: &Path, args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<Cast> {
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
            return Ok(Cast {
                entries: vec![Entry::Failed(failed)],
                places: Vec::new(),
                shown: None,
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
            let stand: Vec<_> = instances.iter().map(cell).collect();
            // The whole message is the error's own: its source would be told twice.
            cuts(report, &circuit, &stand).map_err(|e| anyhow::anyhow!("{e}"))?
        }
        None => HashMap::new(),
    };
    let of_path = |(template, cut): (usize, Vec<Compartment>)| {
        (circuit.templates[template].path.clone(), cut)
    };
    let cuts = cuts.into_iter().map(of_path).collect();
    let entries = cells::read(&inputs, &cuts, args, reporter)?;
    // Cells that did not fail keep their order; those that did are marked.
    let mut centers = Vec::new();
    for (entry, place) in entries.iter().zip(of_template.values_mut()) {
        *place = centers.len();
        match entry {
            Entry::Done(cell) => centers.push(soma_center(&cell.morphology)),
            Entry::Failed(_) => *place = usize::MAX,
        }
    }
    let mut stand = Vec::new();
    let places = instances.iter().filter_map(|instance| {
        let cell = of_template[&instance.template.index()];
        let center = centers.get(cell)?;
        let placement = Placement {
            rotation: instance.rotation,
            scale: instance.scale,
            translation: instance.world_from_cell(*center).translation,
        };
        stand.push(*instance);
        Some((cell, placement))
    });
    Ok(Cast {
        places: places.collect(),
        entries,
        shown: Some(Shown {
            circuit,
            instances: stand,
        }),
    })
}

/// Bounding spheres around all that is shown, to fit a camera to.
pub(crate) fn balls(cells: &[&Cell], places: &[(usize, Placement)]) -> Vec<BoundingSphere> {
    if places.len() >= MANY {
        return covering(cells, places);
    }
    let own: Vec<Vec<BoundingSphere>> = cells
        .iter()
        .map(|cell| cells::balls(cell).collect())
        .collect();
    placed(&own, places)
}

/// Bounding spheres that hold all surfaces, at any level.
pub(crate) fn covering(cells: &[&Cell], places: &[(usize, Placement)]) -> Vec<BoundingSphere> {
    let of_cell = (MOST_BALLS / places.len().max(1)).max(FEWEST);
    let own: Vec<Vec<BoundingSphere>> = cells
        .par_iter()
        .map(|cell| merged(&bounds(&cell.mesh), of_cell))
        .collect();
    placed(&own, places)
}

/// Balls of cells where the cells stand.
fn placed(own: &[Vec<BoundingSphere>], places: &[(usize, Placement)]) -> Vec<BoundingSphere> {
    let at = |&(cell, placement): &(usize, Placement)| {
        let balls = own[cell].iter();
        balls.map(move |&(center, radius)| {
            (placement.world_from_cell(center), radius * placement.scale)
        })
    };
    places.iter().flat_map(at).collect()
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;

    #[test]
    fn balls_go_where_cells_stand() {
        let own = [vec![(DVec3::X, 1.0)]];
        let turned = Placement {
            rotation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            scale: 2.0,
            translation: DVec3::new(0.0, 0.0, 5.0),
        };
        let balls = placed(&own, &[(0, Placement::default()), (0, turned)]);
        assert_eq!(balls[0], (DVec3::X, 1.0));
        assert!(balls[1].0.distance(DVec3::new(0.0, 2.0, 5.0)) < 1e-12 && balls[1].1 == 2.0);
    }
}
