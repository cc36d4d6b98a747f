//! Meshes a tracing again: with another soma, with other spines.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use neurotess::circuit::{Circuit, NodeRef, soma_center};
use neurotess::generate::generate_watched;
use neurotess::mesh::Watch;
use neurotess::morphology::edit::{self, Edit, SpinePlaces};
use neurotess::morphology::{Measures, Morphology};

use crate::io::load::section_facts;
use crate::model::document::{self, SomaEdit, SourceId, SpineEdit};
use crate::model::sources::{Grown, Meshed};

/// What is to be meshed.
#[derive(Clone, Debug)]
pub(crate) struct MeshRequest {
    pub(crate) id: SourceId,
    /// The tracing without spines, and with those that it has now.
    pub(crate) traced: Arc<Morphology>,
    pub(crate) drawn: Arc<Morphology>,
    pub(crate) soma: SomaEdit,
    /// Spines that it is to have.
    pub(crate) spines: Option<SpineEdit>,
    /// Whether they are those that it has.
    pub(crate) same_spines: bool,
    /// The node at whose synapses they grow.
    pub(crate) node: Option<(Arc<Circuit>, NodeRef)>,
}

/// Grows spines where they are others, and meshes.
///
/// # Errors
/// Why there is no mesh, or why there are no spines.
pub(crate) fn remesh(request: &MeshRequest) -> Result<Meshed, String> {
    let grown = match request.same_spines {
        true => None,
        false => Some(grown(request)?),
    };
    let morphology = grown.as_ref().map_or(&request.drawn, |g| &g.morphology);
    let clock = Instant::now();
    let seconds = || clock.elapsed().as_secs_f64();
    let watch = Watch::default().with_clock(&seconds);
    let generated = generate_watched(morphology, &request.soma.options(), &watch);
    let generated = generated.map_err(|e| e.to_string())?;
    Ok(Meshed { generated, grown })
}

fn grown(request: &MeshRequest) -> Result<Grown, String> {
    let (morphology, left) = match request.spines {
        None => (Arc::clone(&request.traced), 0),
        Some(spines) => {
            let places = places(request, spines)?;
            let seed = spines.seed;
            let edits = [Edit::Spines { places, seed }];
            let edited = edit::apply(&request.traced, &edits).map_err(|e| e.to_string())?;
            (Arc::new(edited.morphology), edited.reports[0].left)
        }
    };
    Ok(Grown {
        measures: Measures::of(&morphology),
        sections: section_facts(&morphology),
        morphology,
        left,
    })
}

fn places(request: &MeshRequest, spines: SpineEdit) -> Result<SpinePlaces, String> {
    match spines.places {
        document::SpinePlaces::Random => {
            Ok(SpinePlaces::Density(spines.density.clamp(0.001, 100.0)))
        }
        document::SpinePlaces::File if request.traced.spines.is_empty() => {
            Err("the file tells of no spines: grow them at random".into())
        }
        document::SpinePlaces::File => Ok(SpinePlaces::File),
        document::SpinePlaces::Synapses => synapses(request).map(SpinePlaces::At),
    }
}

/// Places of the synapses that the node gets, in the coordinates of its tracing.
fn synapses(request: &MeshRequest) -> Result<Vec<DVec3>, String> {
    let none = "spines grow at synapses of a circuit's cell that has its tracing for itself: remove the others from \
                the list";
    let (circuit, node) = request.node.as_ref().ok_or(none)?;
    let instances = circuit.instances(&[*node], None);
    let instance = instances.first().ok_or(none)?;
    let inputs = circuit.inputs(&instances).map_err(|e| e.to_string())?;
    let placed = instance.world_from_cell(soma_center(&request.traced));
    let cell_from_world = placed.inverse();
    let places = inputs.iter().flatten();
    Ok(places
        .map(|&place| cell_from_world.transform_point3(place))
        .collect())
}
