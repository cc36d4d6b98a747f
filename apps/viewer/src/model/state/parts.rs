//! Where parts of cells are.

use glam::DVec3;
use neurotess::mesh::Role;

use super::{CellPart, Picked, State};
use crate::model::sources::extent;

impl State {
    /// A sphere around a part of a cell where it is shown: its center and radius (µm).
    pub(crate) fn part_sphere(&self, picked: Picked) -> Option<(DVec3, f64)> {
        let source = self.source_of(picked.neuron)?;
        let placement = *self.placements().get(picked.neuron)?;
        let morphology = &source.morphology;
        let of_section = |section: usize| {
            let points = morphology
                .sections
                .get(section)
                .map(neurotess::morphology::Section::range);
            let points = points.into_iter().flatten();
            points.filter_map(|point| {
                let point = morphology.points.get(point)?;
                let center = morphology.origin + point.position.as_dvec3();
                Some((center, f64::from(point.radius).max(0.0)))
            })
        };
        let spheres: Vec<(DVec3, f64)> = match picked.part {
            CellPart::Soma => {
                let mesh = &source.generated.mesh;
                let soma = mesh.tracing.iter().filter(|p| p.role == Role::Soma);
                soma.map(|p| (mesh.origin + p.center.as_dvec3(), f64::from(p.radius)))
                    .collect()
            }
            CellPart::Section(section) => of_section(section as usize).collect(),
            CellPart::Neurite(neurite) => {
                let all = 0..morphology.sections.len();
                let own =
                    all.filter(|&s| source.sections.get(s).is_some_and(|f| f.neurite == neurite));
                own.flat_map(of_section).collect()
            }
        };
        if spheres.is_empty() {
            return None;
        }
        let placed = |&(center, radius): &(DVec3, f64)| {
            (placement.world_from_cell(center), radius * placement.scale)
        };
        let spheres: Vec<(DVec3, f64)> = spheres.iter().map(placed).collect();
        let (low, high) = extent(&spheres);
        Some(((low + high) / 2.0, (high - low).length() / 2.0))
    }
}
