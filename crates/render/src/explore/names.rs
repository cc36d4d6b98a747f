//! What an id of exploration means: instance, and traced point of its mesh. Twin of pieces_id.wgsl.

use std::sync::Arc;

use super::Exploration;
use super::layout::RUN_SOMA;
use super::sketch::Sketch;
use crate::ids::Id;
use crate::named::{Named, Spot};

/// Bits of an id's second word for the point of a run; those above are the run's.
const POINT_BITS: u32 = 7;

/// What the points of a sketch's runs are in its mesh.
#[derive(Clone, Debug, Default)]
pub struct SketchNames {
    /// By run: where its points begin, and whether it is a soma.
    runs: Vec<(u32, bool)>,
    /// Tracing points.
    points: Vec<u32>,
}

impl SketchNames {
    /// Of a sketch.
    pub fn new(sketch: &Sketch) -> Self {
        let mut names = Self::default();
        for (run, colors) in sketch.runs.iter().zip(&sketch.colors) {
            let soma = run.flags & RUN_SOMA != 0;
            names.runs.push((names.points.len() as u32, soma));
            names.points.extend(colors);
        }
        names
    }

    /// What a point of a run is.
    fn spot(&self, run: usize, point: usize) -> Option<Spot> {
        let &(first, soma) = self.runs.get(run)?;
        let end = self
            .runs
            .get(run + 1)
            .map_or(self.points.len(), |r| r.0 as usize);
        let points = self.points.get(first as usize..end)?;
        let point = points.get(point).or(points.last()).copied()?;
        Some(if soma {
            Spot::Soma(point)
        } else {
            Spot::Point(point)
        })
    }
}

/// Knows what the ids of a frame of exploration mean, also when other frames came after.
#[derive(Clone, Debug)]
pub struct SketchNamer {
    names: Arc<[SketchNames]>,
    /// By instance: its template, and the first of that one's runs.
    instances: Vec<(u32, u32)>,
}

impl SketchNamer {
    /// What an id of the frame means; nothing where nothing was drawn.
    pub fn name(&self, [first, place]: Id) -> Option<Named> {
        let instance = first.checked_sub(1)?;
        let &(template, first_run) = self.instances.get(instance as usize)?;
        let run = (place >> POINT_BITS).checked_sub(first_run)?;
        let point = place & ((1 << POINT_BITS) - 1);
        let names = self.names.get(template as usize)?;
        let spot = names.spot(run as usize, point as usize)?;
        Some(Named { instance, spot })
    }
}

impl Exploration {
    /// Who tells what ids of the instances of now mean. `names`: of all sketches that were added.
    pub fn namer(&self, names: Arc<[SketchNames]>) -> SketchNamer {
        let instances = self.instances.iter().map(|instance| {
            let template = instance.template.0;
            (template, self.known[template as usize].first_run)
        });
        SketchNamer {
            names,
            instances: instances.collect(),
        }
    }
}

/// The text that tells ids.
pub(super) const ID_WGSL: &str = include_str!("pieces_id.wgsl");
