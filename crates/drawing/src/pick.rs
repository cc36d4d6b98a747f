//! What is at a pixel.

use glam::{DVec2, DVec3};
use neurotess_morphology::{SectionId, shape};
use neurotess_picture::{Camera, Placement};
use rayon::prelude::*;

use crate::Drawing;

/// What is at a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// Index of the cell among those that are drawn.
    pub cell: usize,
    /// Its name: that of the cell, or population and id of a node.
    pub name: String,
    /// The id of the node, if it is of a circuit.
    pub node: Option<u64>,
    /// The section; none on the soma.
    pub section: Option<SectionId>,
    /// The file's own number of the nearest sample; none on the soma.
    pub sample: Option<i64>,
    /// Where it is (µm).
    pub position: DVec3,
}

impl Drawing {
    /// The nearest neurite or soma at a pixel, or within `reach` pixels of it, as it was traced.
    pub fn pick(
        &self,
        camera: &Camera,
        size: [u32; 2],
        at: [f64; 2],
        reach: f64,
    ) -> Option<Picked> {
        let cursor = DVec2::from(at);
        let pixel = camera.pixel_size(f64::from(size[1]));
        // Depth, and whether the cursor is on a ball between two traced ones.
        let hit = |a: (DVec3, f64), b: (DVec3, f64)| {
            let (p, q) = (camera.pixel_of(a.0, size)?, camera.pixel_of(b.0, size)?);
            let (p, q) = (DVec2::from(p), DVec2::from(q));
            let along = (cursor - p).dot(q - p) / (q - p).length_squared().max(1e-12);
            let along = along.clamp(0.0, 1.0);
            let center = a.0.lerp(b.0, along);
            let radius = a.1 + along * (b.1 - a.1);
            let depth = camera.depth(center);
            let pixels = radius / pixel.at(depth);
            let near = cursor.distance(p.lerp(q, along)) <= pixels + reach;
            (near && pixel.at(depth) > 0.0).then_some((depth - radius, along, center))
        };
        let of_instance = |(instance, &(cell, placement)): (usize, &(usize, Placement))| {
            let morphology = &self.cells[cell].morphology;
            let place = |position: glam::Vec3, radius: f32| {
                let center = morphology.origin + position.as_dvec3();
                let radius = f64::from(radius.max(0.0)) * placement.scale;
                (placement.world_from_cell(center), radius)
            };
            let mut best: Option<(f64, Picked)> = None;
            let mut offer = |(depth, _, position), section, sample| {
                if best.as_ref().is_none_or(|(least, _)| depth < *least) {
                    let picked = Picked {
                        cell: instance,
                        name: String::new(),
                        node: None,
                        section,
                        sample,
                        position,
                    };
                    best = Some((depth, picked));
                }
            };
            for soma in &morphology.somata {
                let ball = place(soma.center, soma.radius);
                if let Some(found) = hit(ball, ball) {
                    offer(found, None, None);
                }
            }
            for (index, section) in morphology.sections.iter().enumerate() {
                let id = SectionId(index as u32);
                let before = shape::branch_point(morphology, id);
                let mut last = before.map(|p| place(p.position, p.radius));
                for point in section.range() {
                    let p = morphology.points[point];
                    let ball = place(p.position, p.radius);
                    if let Some(found) = hit(last.unwrap_or(ball), ball) {
                        let nearer = found.1 < 0.5 && point > section.first as usize;
                        let point = if nearer { point - 1 } else { point };
                        offer(found, Some(id), morphology.sample_ids.get(point).copied());
                    }
                    last = Some(ball);
                }
            }
            best
        };
        let found = self.placements.par_iter().enumerate();
        let found: Vec<_> = found.filter_map(of_instance).collect();
        let nearest = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, picked)| self.named(picked))
    }

    fn named(&self, mut picked: Picked) -> Picked {
        (picked.name, picked.node) = match &self.instances {
            Some(circuit) => (
                circuit.names().swap_remove(picked.cell),
                Some(circuit.instances[picked.cell].id),
            ),
            None => {
                let (cell, _) = self.placements[picked.cell];
                (self.cells[cell].file.clone(), None)
            }
        };
        picked
    }
}
