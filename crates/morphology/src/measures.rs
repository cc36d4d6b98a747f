//! Morphometrics of a cell, as `neurotess info` prints them.
//!
//! Neurites are frusta between consecutive points, those of a section's first point and the point
//! it branches from included; the way from the soma to a neurite's first point is not. Sums are
//! `f64`, in the order of the points. Negative radii count as zero.

mod rows;

use serde::Serialize;

use crate::frustum::{distance, frustum_area, frustum_volume};
use crate::{Attachment, Morphology, NeuriteKind, SectionId, shape, soma_area_volume};

/// What `info --json` tells of one cell, µm, µm², µm³.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// Samples outside the somata.
    pub n_points: usize,
    /// Sections; they end at forks, ends, and where the type changes.
    pub n_sections: usize,
    /// Trees on a soma or on nothing.
    pub n_neurites: usize,
    /// Points with two children.
    pub n_bifurcations: usize,
    /// Points with three children or more.
    pub n_multifurcations: usize,
    /// Points without children.
    pub n_ends: usize,
    /// Greatest number of forks between a neurite's start and a section.
    pub max_branch_order: u32,
    /// Length of all neurites.
    pub length: f64,
    /// Area of their frusta without caps.
    pub area: f64,
    /// Volume of their frusta.
    pub volume: f64,
    /// The length by kind.
    pub length_by_type: LengthByType,
    /// The main soma.
    pub soma: SomaMeasures,
    /// Box around all centers in the file's coordinates; `None` without samples.
    pub bbox: Option<Bounds>,
}

/// Length of the neurites of each kind (µm).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LengthByType {
    /// Type 2.
    pub axon: f64,
    /// Type 3.
    pub basal_dendrite: f64,
    /// Type 4.
    pub apical_dendrite: f64,
    /// Undefined and custom types, and soma samples inside neurites.
    pub other: f64,
}

/// The main soma: see [`soma_area_volume`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SomaMeasures {
    /// `none`, `point`, `three_point`, `contour` or `cylinders`.
    pub kind: &'static str,
    /// Center in the file's coordinates.
    pub center: Option<[f64; 3]>,
    /// Radius of the sphere that stands for it.
    pub radius: f64,
    /// Area.
    pub area: f64,
    /// Volume.
    pub volume: f64,
}

/// A box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounds {
    /// Least coordinates.
    pub min: [f64; 3],
    /// Greatest coordinates.
    pub max: [f64; 3],
}

impl Measures {
    /// Measures a cell. Linear in its points.
    pub fn of(morphology: &Morphology) -> Self {
        let mut measures = Self {
            n_points: morphology.points.len(),
            n_sections: morphology.sections.len(),
            n_neurites: 0,
            n_bifurcations: 0,
            n_multifurcations: 0,
            n_ends: 0,
            max_branch_order: shape::branch_orders(morphology)
                .into_iter()
                .max()
                .unwrap_or(0),
            length: 0.0,
            area: 0.0,
            volume: 0.0,
            length_by_type: LengthByType::default(),
            soma: soma_measures(morphology),
            bbox: bounds(morphology),
        };
        measures.count_forks(morphology);
        for index in 0..morphology.sections.len() {
            measures.add_section(morphology, SectionId(index as u32));
        }
        measures
    }

    fn count_forks(&mut self, morphology: &Morphology) {
        for count in shape::child_counts(morphology) {
            match count {
                0 => self.n_ends += 1,
                1 => {} // the type changes
                2 => self.n_bifurcations += 1,
                _ => self.n_multifurcations += 1,
            }
        }
        let start = |a: &Attachment| !matches!(a, Attachment::Section(_));
        self.n_neurites = morphology
            .sections
            .iter()
            .filter(|s| start(&s.attachment))
            .count();
    }

    fn add_section(&mut self, morphology: &Morphology, id: SectionId) {
        let mut length = 0.0;
        for (a, b) in shape::links(morphology, id) {
            let link = distance(a, b);
            length += link;
            self.area += frustum_area(a.radius, b.radius, link);
            self.volume += frustum_volume(a.radius, b.radius, link);
        }
        self.length += length;
        let by_type = &mut self.length_by_type;
        *match morphology.sections[id.index()].kind {
            NeuriteKind::AXON => &mut by_type.axon,
            NeuriteKind::BASAL_DENDRITE => &mut by_type.basal_dendrite,
            NeuriteKind::APICAL_DENDRITE => &mut by_type.apical_dendrite,
            _ => &mut by_type.other,
        } += length;
    }
}

fn soma_measures(morphology: &Morphology) -> SomaMeasures {
    let Some(soma) = morphology.soma() else {
        return SomaMeasures {
            kind: "none",
            ..SomaMeasures::default()
        };
    };
    let (area, volume) = soma_area_volume(soma);
    let center = Some((morphology.origin + soma.center.as_dvec3()).to_array());
    SomaMeasures {
        kind: soma.kind.name(),
        center,
        radius: f64::from(soma.radius),
        area,
        volume,
    }
}

fn bounds(morphology: &Morphology) -> Option<Bounds> {
    let somata = morphology
        .somata
        .iter()
        .flat_map(|s| &s.samples)
        .map(|s| s.position);
    let mut positions = somata.chain(morphology.points.iter().map(|p| p.position));
    let first = positions.next()?;
    let (min, max) = positions.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
    let global = |p: glam::Vec3| (morphology.origin + p.as_dvec3()).to_array();
    Some(Bounds {
        min: global(min),
        max: global(max),
    })
}
