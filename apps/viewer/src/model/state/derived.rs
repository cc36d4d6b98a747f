//! Values that are derived from the state in a time that grows with the number of neurons: kept
//! until the revision of what they are derived from changes.

use std::collections::BTreeSet;
use std::sync::Arc;

use neurotess::mesh::Role;
use neurotess::plot::Plot;
use neurotess::render::{BoundingSphere, Placement};

use super::State;
use super::meshes::MeshesKey;
use super::traces::PlotKey;
use crate::model::document::{self, Neuron, NeuronRevisions, SourceId};
use crate::model::ids::CircuitId;
use crate::model::markers::MarkerRef;
use crate::model::measuring::Figure;
use crate::model::partners::PartnerPath;
use crate::model::revision::{Memo, Revision};
use crate::model::sources::extent;
use crate::model::totals::{self, Totals};

/// From this number of neurons on, each has only a few bounding spheres.
const MANY: usize = 64;

/// What placements depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PlacementsKey {
    /// Revision of the neurons.
    pub(crate) members: Revision,
    /// Revision of the meshes, if neurons are side by side.
    grid: Option<Revision>,
}

/// What the bounding spheres of the neurons that are shown depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpheresKey {
    placements: PlacementsKey,
    hidden: Revision,
    geometry: Revision,
    /// Revision of what was read, if points are shown.
    points: Option<Revision>,
    radius_factor: f64,
    /// Of meshes beside the cells.
    meshes: MeshesKey,
}

/// Derived values.
#[derive(Debug, Default)]
pub(super) struct Derived {
    placements: Memo<PlacementsKey, Vec<Placement>>,
    spheres: Memo<SpheresKey, Vec<BoundingSphere>>,
    found: Memo<(Revision, String), Vec<usize>>,
    totals: Memo<(NeuronRevisions, Revision), Totals>,
    kinds: Memo<Revision, BTreeSet<i32>>,
    pub(super) circuits: Memo<Revision, Vec<CircuitId>>,
    pub(super) figures: Memo<FiguresKey, Vec<Option<Figure>>>,
    pub(super) partners: Memo<PartnersKey, Vec<PartnerPath>>,
    pub(super) traces: Memo<PlotKey, Plot>,
}

/// What paths of partners depend on: the synapse, what was read of synapses, placements and tracings.
type PartnersKey = (Option<MarkerRef>, Revision, PlacementsKey, Revision);

/// Revisions that figures of dimensions depend on: of the dimensions, placements and tracings.
type FiguresKey = (Revision, PlacementsKey, Revision);

impl State {
    /// Placements of all neurons, in the order of the list.
    pub fn placements(&self) -> Arc<Vec<Placement>> {
        let neurons = &self.document.neurons;
        self.derived.placements.get(self.placements_key(), || {
            if !self.document.grid {
                return neurons.iter().map(|n| n.placement).collect();
            }
            let extents = neurons.iter().map(|neuron| {
                let (low, high) = extent(&self.spheres_of(neuron.source, neuron.placement, 1.0));
                ((low + high) / 2.0, high - low)
            });
            document::grid(neurons, &extents.collect::<Vec<_>>())
        })
    }

    /// What placements depend on.
    pub(crate) fn placements_key(&self) -> PlacementsKey {
        let grid = self.document.grid;
        PlacementsKey {
            members: self.document.neurons.revisions().members,
            // Side by side, placements depend on the size of meshes.
            grid: grid.then(|| self.sources.geometry()),
        }
    }

    /// Spheres around a neuron whose neurites' radii are multiplied by a factor.
    fn spheres_of(
        &self,
        source: SourceId,
        placement: Placement,
        factor: f64,
    ) -> Vec<BoundingSphere> {
        let many = self.document.neurons.len() >= MANY;
        let Some(source) = self.sources.get(source) else {
            return Vec::new();
        };
        let spheres = match many {
            true => &source.few_spheres,
            false => &source.spheres,
        };
        // A sphere holds many points: it grows by what the thickest grows.
        let grown = (factor - 1.0).max(0.0) * source.thickest;
        spheres
            .iter()
            .map(|&(c, r)| (placement.world_from_cell(c), (r + grown) * placement.scale))
            .collect()
    }

    /// Bounding spheres (µm) of the neurons that are shown, and of points and opaque meshes beside them.
    pub fn spheres(&self) -> Arc<Vec<BoundingSphere>> {
        let derive = || {
            let mut spheres = self.spheres_where(|_| true);
            spheres.extend(self.sphere_of_points());
            spheres.extend(self.mesh_points(false));
            spheres
        };
        self.derived.spheres.get(self.spheres_key(), derive)
    }

    /// What the bounding spheres of the neurons that are shown depend on.
    pub(crate) fn spheres_key(&self) -> SpheresKey {
        SpheresKey {
            placements: self.placements_key(),
            hidden: self.document.neurons.revisions().hidden,
            geometry: self.sources.geometry(),
            points: self.shows_points().then(|| self.marker_data.revision()),
            radius_factor: self.document.look.radius_factor(),
            meshes: self.meshes_key(),
        }
    }

    fn spheres_where(&self, fits: impl Fn(usize) -> bool) -> Vec<BoundingSphere> {
        let factor = self.document.look.radius_factor();
        let placements = self.placements();
        let neurons = self.document.neurons.iter().zip(placements.iter());
        let shown = neurons
            .enumerate()
            .filter(|(i, _)| self.document.neurons.shows(*i) && fits(*i));
        shown
            .flat_map(|(_, (n, placement))| self.spheres_of(n.source, *placement, factor))
            .collect()
    }

    /// Spheres (µm) at the tracing points of the neurons that are shown and fit `fits`: tighter
    /// than [`State::spheres`], to fit a camera to. With many neurons a few spheres each.
    pub fn outline(&self, fits: impl Fn(usize) -> bool) -> Vec<BoundingSphere> {
        let placements = self.placements();
        let neurons = self.document.neurons.iter().zip(placements.iter());
        let shown = neurons
            .enumerate()
            .filter(|(i, _)| self.document.neurons.shows(*i) && fits(*i));
        let shown: Vec<_> = shown.map(|(_, shown)| shown).collect();
        if shown.len() >= MANY {
            return self.spheres_where(fits);
        }
        let factor = self.document.look.radius_factor();
        let spheres = |(neuron, placement): (&Neuron, &Placement)| {
            let mesh = self.sources.get(neuron.source).map(|s| &s.generated.mesh);
            let points = mesh.into_iter().flat_map(|mesh| {
                let points = mesh.tracing.iter();
                points.map(|p| {
                    let center = mesh.origin + p.center.as_dvec3();
                    let grown = if p.role == Role::Soma { 1.0 } else { factor };
                    (center, grown * f64::from(p.radius))
                })
            });
            let placed = points.map(|(c, r)| (placement.world_from_cell(c), r * placement.scale));
            placed.collect::<Vec<_>>()
        };
        shown.into_iter().flat_map(spheres).collect()
    }

    /// Indices of the neurons whose names contain the search text.
    pub(crate) fn found(&self) -> Arc<Vec<usize>> {
        let members = self.document.neurons.revisions().members;
        let derive = || {
            let text = self.layout.search.to_lowercase();
            let neurons = self.document.neurons.iter().enumerate();
            let found =
                neurons.filter(|(_, n)| text.is_empty() || n.name.to_lowercase().contains(&text));
            found.map(|(i, _)| i).collect()
        };
        self.derived
            .found
            .get((members, self.layout.search.clone()), derive)
    }

    /// Sums over the selected neurons; over all if none is selected.
    pub(crate) fn totals(&self) -> Arc<Totals> {
        let neurons = &self.document.neurons;
        let key = (neurons.revisions(), self.sources.geometry());
        self.derived.totals.get(key, || {
            let selected = neurons.selected();
            let counted = neurons.iter().enumerate();
            let counted = counted.filter(|(i, _)| selected.is_empty() || selected.contains(*i));
            Totals::of(counted.filter_map(|(_, n)| Some(&*self.sources.get(n.source)?.measures)))
        })
    }

    /// Kinds of sections of all open tracings.
    pub(crate) fn kinds(&self) -> Arc<BTreeSet<i32>> {
        let derive = || totals::kinds(&self.sources);
        self.derived.kinds.get(self.sources.geometry(), derive)
    }

    /// How many times placements and spheres were derived.
    pub(crate) fn derivations(&self) -> [u64; 2] {
        [
            self.derived.placements.derived(),
            self.derived.spheres.derived(),
        ]
    }
}
