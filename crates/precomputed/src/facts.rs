//! What is known of a tracing without its mesh: what properties tell, and where its cells are.

use glam::{DAffine3, DVec3};
use neurotess_morphology::{Measures, Morphology, NeuriteKind};

/// What is kept of a tracing.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    /// Types, rising, that of the soma among them.
    pub(crate) kinds: Vec<NeuriteKind>,
    /// [`NUMBERS`], in the tracing's own size.
    pub(crate) numbers: [f64; NUMBERS.len()],
    /// Box (µm) around all centers.
    pub(crate) bounds: Option<(DVec3, DVec3)>,
    /// Center (µm) of the main soma; zero without one.
    pub(crate) soma_center: DVec3,
}

/// Numbers of a cell: name, what it is, and which power of its size it grows with.
pub(crate) const NUMBERS: [(&str, &str, i32); 8] = [
    ("length", "length of all neurites (µm)", 1),
    ("axon_length", "length of axons (µm)", 1),
    (
        "dendrite_length",
        "length of basal and apical dendrites (µm)",
        1,
    ),
    ("area", "area of the neurites' membrane (µm²)", 2),
    ("volume", "volume of the neurites (µm³)", 3),
    ("soma_radius", "radius of the soma (µm)", 1),
    ("points", "traced points of neurites", 0),
    ("ends", "ends of neurites", 0),
];

impl Facts {
    /// Those of a tracing.
    pub(crate) fn of(morphology: &Morphology) -> Self {
        let measures = Measures::of(morphology);
        let soma = morphology.soma();
        let mut kinds: Vec<NeuriteKind> = morphology.sections.iter().map(|s| s.kind).collect();
        kinds.extend(soma.map(|_| NeuriteKind::SOMA));
        kinds.sort_unstable();
        kinds.dedup();
        let by_type = measures.length_by_type;
        Self {
            kinds,
            numbers: [
                measures.length,
                by_type.axon,
                by_type.basal_dendrite + by_type.apical_dendrite,
                measures.area,
                measures.volume,
                soma.map_or(f64::NAN, |soma| f64::from(soma.radius)),
                measures.n_points as f64,
                measures.n_ends as f64,
            ],
            bounds: measures
                .bbox
                .map(|bounds| (DVec3::from_array(bounds.min), DVec3::from_array(bounds.max))),
            soma_center: soma_center(morphology),
        }
    }

    /// One of the [`NUMBERS`] of a cell at a place.
    pub(crate) fn number(&self, number: usize, world_from_cell: DAffine3) -> f64 {
        let scale = world_from_cell.matrix3.determinant().cbrt();
        self.numbers[number] * scale.powi(NUMBERS[number].2)
    }

    /// Box (µm) around a cell at a place.
    pub(crate) fn bounds_at(&self, world_from_cell: DAffine3) -> Option<(DVec3, DVec3)> {
        let (min, max) = self.bounds?;
        let corners = (0..8).map(|n| {
            let share = DVec3::new(f64::from(n & 1), f64::from(n >> 1 & 1), f64::from(n >> 2));
            world_from_cell.transform_point3(min + (max - min) * share)
        });
        Some(around(corners))
    }
}

/// Smallest box around points.
pub(crate) fn around(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
        (min.min(p), max.max(p))
    })
}

/// Center (µm) of the main soma; zero without one.
pub(crate) fn soma_center(morphology: &Morphology) -> DVec3 {
    let center = |soma: &neurotess_morphology::Soma| morphology.origin + soma.center.as_dvec3();
    morphology.soma().map_or(DVec3::ZERO, center)
}
