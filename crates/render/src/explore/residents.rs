//! What is resident for exploration, and how it changes: templates, their colors, instances.

use glam::{DVec3, Vec3};

use super::layout::{HIDDEN, Run, Shape, Standing};
use super::sketch::{self, Sketch};
use super::{Exploration, in_cells};
use crate::device::Gpu;
use crate::error::DeviceError;
use crate::scene::{Instance, SceneError, TemplateId, check_placement};

/// Why a scene cannot be explored.
#[derive(Debug, thiserror::Error)]
pub enum ExplorationError {
    /// An instance is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device refuses.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

/// What the host remembers of a template.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) origin: DVec3,
    pub(super) center: Vec3,
    pub(super) reach: f32,
    pub(super) points: usize,
    pub(super) first_run: u32,
    pub(super) runs: u32,
    /// Where its heap and its words begin, and how many words there is room for.
    first_heap: usize,
    first_word: usize,
    words: usize,
}

impl Known {
    /// Its runs, as they lie on the device.
    fn placed<'s>(&self, sketch: &'s Sketch) -> impl Iterator<Item = Run> + use<'s> {
        let at = (self.first_heap, self.first_word);
        sketch.runs.iter().map(move |run| sketch::moved(run, at))
    }
}

impl Exploration {
    /// Uploads templates, with numbers that follow those already there.
    ///
    /// # Errors
    /// They do not fit what the device can bind in one piece, or it refuses.
    pub fn add(&mut self, gpu: &Gpu, sketches: &[Sketch]) -> Result<Vec<TemplateId>, DeviceError> {
        let first = self.known.len();
        let (mut runs, mut shapes) = (Vec::new(), Vec::new());
        let (mut heap, mut words): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        let first_run = self.runs.used() as usize / size_of::<Run>();
        let first_heap = self.heap.used() as usize / size_of::<u32>();
        let first_word = self.words.used() as usize / size_of::<u32>();
        for sketch in sketches {
            let known = Known {
                origin: sketch.origin,
                center: sketch.center,
                reach: sketch.reach,
                points: sketch.point_count(),
                first_run: (first_run + runs.len()) as u32,
                runs: sketch.runs.len() as u32,
                first_heap: first_heap + heap.len(),
                first_word: first_word + words.len(),
                words: sketch.words.len(),
            };
            shapes.push(Shape {
                center: known.center.to_array(),
                reach: known.reach,
                first_run: known.first_run,
                runs: known.runs,
                ..Shape::default()
            });
            runs.extend(known.placed(sketch));
            heap.extend(&sketch.heap);
            words.extend(&sketch.words);
            self.known.push(known);
        }
        let grown = [
            self.runs.append(gpu, &runs)?,
            self.shapes.append(gpu, &shapes)?,
            self.heap.append(gpu, &heap)?,
            self.words.append(gpu, &words)?,
        ];
        self.changed(grown.contains(&true));
        gpu.check()?;
        Ok((first..self.known.len())
            .map(|id| TemplateId(id as u32))
            .collect())
    }

    /// Uploads the words of a template's sketch, which [`Sketch::set_words`] has changed.
    ///
    /// # Errors
    /// The device refuses.
    ///
    /// # Panics
    /// If there is no such template, or the sketch is another one's.
    pub fn recolor(
        &mut self,
        gpu: &Gpu,
        template: TemplateId,
        sketch: &Sketch,
    ) -> Result<(), DeviceError> {
        let known = &mut self.known[template.0 as usize];
        assert_eq!(known.runs as usize, sketch.runs.len(), "its own sketch");
        let mut grown = false;
        if sketch.words.len() <= known.words {
            self.words.write(gpu, known.first_word, &sketch.words);
        } else {
            known.first_word = self.words.used() as usize / size_of::<u32>();
            known.words = sketch.words.len();
            grown = self.words.append(gpu, &sketch.words)?;
        }
        let runs: Vec<Run> = known.placed(sketch).collect();
        self.runs.write(gpu, known.first_run as usize, &runs);
        self.changed(grown);
        gpu.check()
    }

    /// Notes that something changed, perhaps buffers themselves.
    pub(super) fn changed(&mut self, buffers: bool) {
        if buffers {
            self.groups = None;
        }
        *self.stale.get_mut() = true;
    }

    /// Other instances. Shaders know an instance by its place in this list.
    ///
    /// # Errors
    /// An instance without a template, or nowhere.
    pub fn set_instances(
        &mut self,
        gpu: &Gpu,
        instances: Vec<Instance>,
    ) -> Result<(), ExplorationError> {
        for (i, instance) in instances.iter().enumerate() {
            check_placement(i, instance, self.known.len())?;
        }
        let standing: Vec<Standing> = instances.iter().map(|i| self.stand(i)).collect();
        let grown = self.standing.replace(gpu, &standing)?;
        self.instances = instances;
        self.edited = 0..0;
        self.changed(grown);
        gpu.check()?;
        Ok(())
    }

    /// The instances.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Shows an instance or hides it, from the next frame on.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn set_hidden(&mut self, instance: usize, hidden: bool) {
        self.instances[instance].hidden = hidden;
        self.edit(instance);
    }

    /// Another state of an instance, from the next frame on.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn set_state(&mut self, instance: usize, state: u32) {
        self.instances[instance].state = state;
        self.edit(instance);
    }

    /// The next frame uploads it, with all between the first and the last that were edited.
    fn edit(&mut self, instance: usize) {
        self.edited = match self.edited.is_empty() {
            true => instance..instance + 1,
            false => self.edited.start.min(instance)..self.edited.end.max(instance + 1),
        };
        self.changed(false);
    }

    /// Where an instance stands, as shaders are told.
    pub(super) fn stand(&self, instance: &Instance) -> Standing {
        let at = instance.placement;
        let origin = at.world_from_cell(self.known[instance.template.0 as usize].origin);
        let (cell, offset) = in_cells(origin);
        Standing {
            rotation: at.rotation.as_quat().to_array(),
            offset,
            scale: at.scale as f32,
            cell,
            shape: instance.template.0,
            flags: if instance.hidden { HIDDEN } else { 0 },
            state: instance.state,
            ..Standing::default()
        }
    }
}
