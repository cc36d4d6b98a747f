//! Where the synapses are that chosen cells get.

use std::collections::HashMap;

use glam::DVec3;

use crate::edges::{Edges, SynapseSide};
use crate::model::{Circuit, Instance};
use crate::{CircuitError, Fault};

impl Circuit {
    /// Of each instance: places (µm, the circuit's coordinates) of the synapses that it gets, of all populations of
    /// edges in turn. Where a file has no coordinates, they follow from sections.
    ///
    /// # Errors
    /// What is wrong with a file of edges; edges onto these cells have no places.
    pub fn inputs(&self, instances: &[Instance]) -> Result<Vec<Vec<DVec3>>, CircuitError> {
        let mut inputs = vec![Vec::new(); instances.len()];
        for edges in &self.edges {
            let mut of_id: HashMap<u64, Vec<usize>> = HashMap::new();
            for (number, instance) in instances.iter().enumerate() {
                let population = &self.populations[instance.node.population as usize];
                if population.name == edges.target {
                    of_id.entry(instance.id).or_default().push(number);
                }
            }
            if !of_id.is_empty() {
                self.add_inputs(edges, instances, &of_id, &mut inputs)?;
            }
        }
        Ok(inputs)
    }

    fn add_inputs(
        &self,
        edges: &Edges,
        instances: &[Instance],
        of_id: &HashMap<u64, Vec<usize>>,
        inputs: &mut [Vec<DVec3>],
    ) -> Result<(), CircuitError> {
        let synapses = edges.synapses_on(SynapseSide::Afferent)?;
        if !synapses.positions.is_empty() {
            for (target, position) in synapses.targets.iter().zip(synapses.positions) {
                for &number in of_id.get(target).into_iter().flatten() {
                    inputs[number].push(position);
                }
            }
            return Ok(());
        }
        let shares = edges.shares_on(SynapseSide::Afferent)?;
        if shares.is_empty() && edges.count > 0 {
            let file = edges.file.display().to_string();
            let key = format!("edges/{}/0/afferent_surface_x", edges.name);
            return Err(CircuitError::new(&file, &key, Fault::Missing));
        }
        let mut of_number: HashMap<usize, Vec<usize>> = HashMap::new();
        for (row, target) in synapses.targets.iter().enumerate() {
            for &number in of_id.get(target).into_iter().flatten() {
                of_number.entry(number).or_default().push(row);
            }
        }
        for (number, rows) in of_number {
            let instance = &instances[number];
            let Some(membrane) = self.membrane(instance.template) else {
                continue;
            };
            let placed = instance.world_from_cell(membrane.soma_center());
            let place = |&row: &usize| membrane.place(shares[row]);
            let places = rows.iter().filter_map(place);
            inputs[number].extend(places.map(|place| placed.transform_point3(place.center)));
        }
        Ok(())
    }
}
