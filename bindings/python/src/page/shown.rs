//! The cells of a page: alone, or at their places in a circuit.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use neurotess::circuit::{self as circuits, Instance, NodeRef, soma_center};
use neurotess::coloring::{self, cuts, with_middles};
use neurotess::drawing::DrawError;
use neurotess::generate::{GenerateOptions, generate_watched, unused_kinds};
use neurotess::mesh::{CoarseMesh, Watch};
use neurotess::morphology::{Morphology, NeuriteKind};
use neurotess::render::Placement;
use neurotess::web::PageCell;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

use super::Unmade;
use crate::cell::Cell;
use crate::circuit::{Circuit, node_ref};
use crate::errors;
use crate::work::detached;

/// The cells of a page: each that is meshed once, and where which is shown.
pub(super) struct Shown {
    cells: Vec<Arc<Morphology>>,
    pub(super) placed: Vec<Placed>,
    /// That the cells are of.
    pub(super) circuit: Option<Arc<circuits::Circuit>>,
}

/// A cell at its place.
pub(super) struct Placed {
    /// Index among those that are meshed.
    pub(super) cell: usize,
    pub(super) name: String,
    /// Its node and the id of that, if it is of a circuit.
    pub(super) node: Option<(NodeRef, u64)>,
    placement: Placement,
}

impl Shown {
    /// Cells in their own coordinates.
    pub(super) fn alone(cells: &[PyRef<'_, Cell>]) -> Self {
        let cells: Vec<_> = cells.iter().map(|c| Arc::clone(&c.morphology)).collect();
        let placed = cells.iter().enumerate().map(|(index, cell)| Placed {
            cell: index,
            name: cell.name.clone(),
            node: None,
            placement: Placement::default(),
        });
        Self {
            placed: placed.collect(),
            cells,
            circuit: None,
        }
    }

    /// Nodes of a circuit at their places; each morphology once.
    ///
    /// # Errors
    /// A morphology that cannot be read; no node has one.
    pub(super) fn nodes(
        py: Python<'_>,
        circuit: &Circuit,
        nodes: Vec<(u32, u32)>,
    ) -> PyResult<Self> {
        let circuit = &circuit.circuit;
        let nodes: Vec<NodeRef> = nodes.into_iter().map(node_ref).collect();
        let instances = circuit.instances(&nodes, None);
        if instances.is_empty() {
            let nothing = "no chosen cell has a morphology and a place: choose others";
            return Err(PyValueError::new_err(nothing));
        }
        let mut shown = Self {
            cells: Vec::new(),
            placed: Vec::with_capacity(instances.len()),
            circuit: Some(Arc::clone(circuit)),
        };
        let mut of_template = HashMap::new();
        for instance in &instances {
            let cell = match of_template.get(&instance.template.index()) {
                Some(&cell) => cell,
                None => {
                    let template = &circuit.templates[instance.template.index()];
                    let read = detached(py, || template.read())?;
                    let read = read.map_err(|e| errors::read(py, e))?;
                    shown.cells.push(Arc::new(read.morphology.clone()));
                    of_template.insert(instance.template.index(), shown.cells.len() - 1);
                    shown.cells.len() - 1
                }
            };
            let population = &circuit.populations[instance.node.population as usize];
            shown.placed.push(Placed {
                cell,
                name: format!("{} {}", population.name, instance.id),
                node: Some((instance.node, instance.id)),
                placement: placement(instance, &shown.cells[cell]),
            });
        }
        Ok(shown)
    }

    /// The node of each cell; none of cells of no circuit.
    pub(super) fn nodes_of(&self) -> Vec<NodeRef> {
        let placed = self.placed.iter();
        placed.filter_map(|placed| Some(placed.node?.0)).collect()
    }

    /// Gives cells a point at the middle of each compartment of a report that they show.
    ///
    /// # Errors
    /// The report is invalid, or of another circuit.
    pub(super) fn cut(&mut self, report: Option<&Path>) -> Result<(), Unmade> {
        let (Some(circuit), Some(report)) = (&self.circuit, report) else {
            return Ok(());
        };
        let placed = self.placed.iter();
        let shown: Vec<_> = placed.filter_map(|p| Some((p.cell, p.node?.0))).collect();
        let cuts = cuts(report, circuit, &shown);
        let cuts = cuts.map_err(|e| Unmade::Page(DrawError::Failed(e.to_string()).into()))?;
        for (cell, compartments) in cuts {
            self.cells[cell] = Arc::new(with_middles(&self.cells[cell], &compartments));
        }
        Ok(())
    }

    /// See [`unused_kinds`].
    pub(super) fn unused_kinds(&self, kinds: Option<&[NeuriteKind]>) -> Option<String> {
        unused_kinds(self.cells.iter().map(|cell| &**cell), kinds)
    }

    pub(super) fn meshes(
        &self,
        options: &GenerateOptions,
        stopped: &AtomicBool,
    ) -> Result<Vec<CoarseMesh>, Unmade> {
        let mesh = |cell: &Arc<Morphology>| {
            let generated = generate_watched(cell, options, &Watch::stopped_by(stopped));
            let generated = generated.map_err(|e| Unmade::Mesh(format!("{}: {e}", cell.name)))?;
            Ok(generated.mesh)
        };
        self.cells.par_iter().map(mesh).collect()
    }

    /// All cells at their places, with their meshes.
    pub(super) fn page_cells<'s>(
        &'s self,
        meshes: &'s [CoarseMesh],
        radius_factor: f64,
    ) -> Vec<PageCell<'s>> {
        let page_cell = |placed: &'s Placed| PageCell {
            cell: coloring::Cell {
                name: &placed.name,
                morphology: &self.cells[placed.cell],
                mesh: &meshes[placed.cell],
                radius_factor,
            },
            placement: placed.placement,
        };
        self.placed.iter().map(page_cell).collect()
    }
}

fn placement(instance: &Instance, cell: &Morphology) -> Placement {
    Placement {
        rotation: instance.rotation,
        scale: instance.scale,
        translation: instance.world_from_cell(soma_center(cell)).translation,
    }
}
