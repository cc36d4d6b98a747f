//! A circuit: populations of placed nodes, and the distinct morphologies that they show.

use std::collections::BTreeMap;

use glam::{DAffine3, DQuat, DVec3};

use crate::compartment_sets::CompartmentSet;
use crate::declared::DeclaredReport;
use crate::edges::Edges;
use crate::error::CircuitError;
use crate::groups::Groups;
use crate::node_sets::NodeSets;
use crate::population::{NodeRef, Population};

use crate::template::{Template, TemplateId};
use crate::warning::Warning;

/// Many neurons, placed.
#[derive(Debug)]
pub struct Circuit {
    /// The configuration or scene as it was named.
    pub file: String,
    /// Short name of the format: `sonata`, `snudda`, `nsol`, `scene` or `table`.
    pub format: &'static str,
    /// Populations in the order of the files, each in a file by name.
    pub populations: Vec<Population>,
    /// Distinct morphology files; read when they are asked for.
    pub templates: Vec<Template>,
    /// Named choices of nodes.
    pub node_sets: NodeSets,
    /// Connections; counted, not read.
    pub edges: Vec<Edges>,
    /// Files of simulation reports by name; those that exist.
    pub reports: BTreeMap<String, std::path::PathBuf>,
    /// Named places on neurons.
    pub compartment_sets: BTreeMap<String, CompartmentSet>,
    /// What the configuration says of reports.
    pub declared_reports: Vec<DeclaredReport>,
    /// What was odd.
    pub warnings: Vec<Warning>,
    /// Parts that could not be opened; the rest is there.
    pub failures: Vec<CircuitError>,
}

/// A node that shows a morphology: all that a renderer needs to know of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Which node.
    pub node: NodeRef,
    /// Its id in the file.
    pub id: u64,
    /// What it shows.
    pub template: TemplateId,
    /// Where the soma's center goes (µm), if `recentered`; else where the morphology's origin goes.
    pub position: DVec3,
    /// From the morphology's axes to the circuit's.
    pub rotation: DQuat,
    /// Factor on its size.
    pub scale: f64,
    /// Whether the soma's center is moved to the origin first.
    pub recentered: bool,
    /// Cells of one group have one color: place in [`Groups::texts`]; 0 without a grouping.
    pub group: u32,
}

impl Instance {
    /// From the morphology's coordinates (µm) to the circuit's: the soma's center moves to the origin,
    /// then the cell turns, then it goes to its place. This is how the SONATA guide has it; bmtk does
    /// so, and bluepysnap leaves the first step out.
    ///
    /// `soma_center`: in the morphology's coordinates, its origin included (see
    /// [`crate::soma_center`]); zero for a cell without a soma.
    pub fn world_from_cell(&self, soma_center: DVec3) -> DAffine3 {
        let center = if self.recentered {
            soma_center
        } else {
            DVec3::ZERO
        };
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(self.scale),
            self.rotation,
            self.position,
        ) * DAffine3::from_translation(-center)
    }
}

impl Circuit {
    /// The node of an id in a population.
    pub fn node(&self, population: &str, id: u64) -> Option<NodeRef> {
        let mut populations = self.populations.iter();
        let place = populations.position(|p| p.name == population)?;
        let ids = &self.populations[place].ids;
        // Most files count from 0.
        let own = usize::try_from(id).ok();
        let own = own.filter(|&row| ids.get(row) == Some(&id));
        let row = own.or_else(|| ids.iter().position(|&other| other == id))?;
        Some(NodeRef {
            population: place as u32,
            row: row as u32,
        })
    }

    /// How many nodes there are.
    pub fn n_neurons(&self) -> usize {
        self.populations.iter().map(Population::len).sum()
    }

    /// How many nodes show a morphology.
    pub fn n_shown(&self) -> usize {
        let shown = |p: &Population| p.templates.iter().flatten().count();
        self.populations.iter().map(shown).sum()
    }

    /// Smallest box (µm) around the places of all nodes; `None` if no node has one.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let places = self.populations.iter().flat_map(|p| &p.positions);
        places
            .filter(|p| p.is_finite())
            .fold(None, |bounds, &p| match bounds {
                None => Some((p, p)),
                Some((min, max)) => Some((p.min(min), p.max(max))),
            })
    }

    /// The nodes among these that show a morphology, in the same order; `groups` tells their groups.
    ///
    /// # Panics
    /// If a node is not of this circuit.
    pub fn instances(&self, nodes: &[NodeRef], groups: Option<&Groups>) -> Vec<Instance> {
        let instance = |&node: &NodeRef| {
            let population = &self.populations[node.population as usize];
            let row = node.row as usize;
            let template = population.templates[row]?;
            Some(Instance {
                node,
                id: population.ids[row],
                template,
                position: population.positions[row],
                rotation: population.rotations[row],
                scale: population.scales.get(row).copied().unwrap_or(1.0),
                recentered: population.recentered.get(row).copied().unwrap_or(true),
                group: groups.map_or(0, |groups| groups.of(node)),
            })
        };
        nodes.iter().filter_map(instance).collect()
    }
}
