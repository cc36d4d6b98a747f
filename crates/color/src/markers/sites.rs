//! Where synapses lie on the cells that are shown, and which way is outwards there.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec3};
use neurotess_circuit::{CellMembrane, TemplateId};
use rayon::prelude::*;

use super::edges::{Places, ShownCell, SynapsesOf};

/// Rows that a thread takes at once.
const ROWS: usize = 16_384;

/// The place of a synapse.
pub(super) struct Site {
    /// In the scene (µm).
    pub(super) position: DVec3,
    /// Unit vector away from the center line; zero if it is not known.
    pub(super) outwards: Vec3,
}

/// Synapses of the cells that are shown.
pub(super) struct Sites {
    /// Those that have a place, each with its row.
    pub(super) sites: Vec<(usize, Site)>,
    /// How many there are, with and without places.
    pub(super) of_shown: usize,
}

/// A cell that is shown.
struct PlacedCell<'c> {
    moved: DAffine3,
    /// If places on the membrane are asked for.
    membrane: Option<(&'c CellMembrane<'c>, DAffine3)>,
}

/// The synapses of the cells that are shown. `contacts`: whether directions are needed.
pub(super) fn placed(of: &SynapsesOf<'_>, contacts: bool) -> Sites {
    let none = HashMap::new();
    let shown = of.shown.get(&of.edges.cells).unwrap_or(&none);
    let along = matches!(of.edges.places, Places::Along(_));
    let membranes = match along || contacts {
        true => membranes(of, shown),
        false => HashMap::new(),
    };
    let cell = |(&id, cell): (&u64, &ShownCell)| (id, PlacedCell::of(of, *cell, &membranes));
    let cells: HashMap<u64, PlacedCell<'_>> = shown.iter().map(cell).collect();
    let nodes = of.edges.nodes.par_iter().enumerate().with_min_len(ROWS);
    let here = nodes.filter_map(|(row, node)| Some((row, cells.get(node)?)));
    let found: Vec<(usize, Option<Site>)> = here
        .map(|(row, cell)| (row, cell.site(row, &of.edges.places, contacts)))
        .collect();
    let of_shown = found.len();
    let sites = found.into_iter();
    let sites = sites.filter_map(|(row, site)| Some((row, site?)));
    Sites {
        sites: sites.collect(),
        of_shown,
    }
}

/// The membranes of the cells that are shown and have synapses, by template.
fn membranes<'c>(
    of: &SynapsesOf<'c>,
    shown: &HashMap<u64, ShownCell>,
) -> HashMap<TemplateId, CellMembrane<'c>> {
    let with_synapses = of.edges.nodes.iter().filter_map(|id| shown.get(id));
    let templates = with_synapses.filter_map(|cell| {
        let population = of.circuit.populations.get(cell.node.population as usize)?;
        *population.templates.get(cell.node.row as usize)?
    });
    let mut templates: Vec<TemplateId> = templates.collect();
    templates.sort_unstable();
    templates.dedup();
    let membrane = |id: TemplateId| Some((id, of.circuit.membrane(id)?));
    templates.into_par_iter().filter_map(membrane).collect()
}

impl<'c> PlacedCell<'c> {
    fn of(
        of: &SynapsesOf<'_>,
        cell: ShownCell,
        membranes: &'c HashMap<TemplateId, CellMembrane<'c>>,
    ) -> Self {
        let instances = match membranes.is_empty() {
            true => Vec::new(),
            false => of.circuit.instances(&[cell.node], None),
        };
        let membrane = instances.first().and_then(|instance| {
            let membrane = membranes.get(&instance.template)?;
            let world_from_cell = instance.world_from_cell(membrane.soma_center());
            Some((membrane, world_from_cell))
        });
        Self {
            moved: cell.moved,
            membrane,
        }
    }

    /// The place of the synapse of a row; none if it has none.
    fn site(&self, row: usize, places: &Places, contacts: bool) -> Option<Site> {
        match places {
            Places::At(places) => {
                let given = Some(places[row]).filter(|place| place.is_finite())?;
                let near = self.membrane.as_ref().filter(|_| contacts);
                let on_membrane = near.and_then(|(membrane, world_from_cell)| {
                    let here = world_from_cell.inverse().transform_point3(given);
                    let place = membrane.nearest(here)?;
                    let outwards = place.towards(here);
                    let outwards = outwards.unwrap_or_else(|| place.outwards(row as u64));
                    let moved = self.moved * *world_from_cell;
                    Some(site(&moved, place.at(outwards), outwards))
                });
                Some(on_membrane.unwrap_or_else(|| Site {
                    position: self.moved.transform_point3(given),
                    outwards: Vec3::ZERO,
                }))
            }
            Places::Along(shares) => {
                let (membrane, world_from_cell) = self.membrane.as_ref()?;
                let place = membrane.place(shares[row])?;
                let outwards = place.outwards(row as u64);
                let moved = self.moved * *world_from_cell;
                Some(site(&moved, place.at(outwards), outwards))
            }
        }
    }
}

fn site(world_from_cell: &DAffine3, place: DVec3, outwards: DVec3) -> Site {
    let outwards = world_from_cell.transform_vector3(outwards);
    Site {
        position: world_from_cell.transform_point3(place),
        outwards: outwards.normalize_or_zero().as_vec3(),
    }
}
