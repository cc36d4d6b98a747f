//! What exploration mode keeps on the device, and how it changes: templates, their colors,
//! instances.

use glam::{DVec3, Vec3};

use super::layout::{Chunk, GpuInstance, HIDDEN, Shape};
use super::proxy::{self, Proxy};
use super::{Exploration, in_cells};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::scene::{Instance, SceneError, TemplateId, check_placement};

/// Why a scene cannot be drawn in exploration mode.
#[derive(Debug, thiserror::Error)]
pub enum ExplorationError {
    /// An instance is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device reports an error.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

/// What the host keeps of a template.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) origin: DVec3,
    pub(super) center: Vec3,
    pub(super) reach: f32,
    pub(super) points: usize,
    pub(super) first_chunk: u32,
    pub(super) chunks: u32,
    /// Where its packed u32s and its color keys begin, and how many color keys there is room for.
    first_packed: usize,
    first_color_key: usize,
    color_keys: usize,
}

impl Known {
    /// The proxy's chunks, with indices into the buffers on the device.
    fn placed<'s>(&self, proxy: &'s Proxy) -> impl Iterator<Item = Chunk> + use<'s> {
        let at = (self.first_packed, self.first_color_key);
        proxy
            .chunks
            .iter()
            .map(move |chunk| proxy::moved(chunk, at))
    }
}

impl Exploration {
    /// Uploads templates. Their ids follow those already there.
    ///
    /// # Errors
    /// All templates together are larger than a buffer that the device can bind, or the device
    /// reports another error.
    pub fn add(&mut self, gpu: &Gpu, proxies: &[Proxy]) -> Result<Vec<TemplateId>, DeviceError> {
        let first = self.known.len();
        let (mut chunks, mut shapes) = (Vec::new(), Vec::new());
        let (mut packed, mut color_keys): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        let first_chunk = self.chunks.used() as usize / size_of::<Chunk>();
        let first_packed = self.packed.used() as usize / size_of::<u32>();
        let first_color_key = self.color_keys.used() as usize / size_of::<u32>();
        for proxy in proxies {
            let known = Known {
                origin: proxy.origin,
                center: proxy.center,
                reach: proxy.reach,
                points: proxy.point_count(),
                first_chunk: (first_chunk + chunks.len()) as u32,
                chunks: proxy.chunks.len() as u32,
                first_packed: first_packed + packed.len(),
                first_color_key: first_color_key + color_keys.len(),
                color_keys: proxy.color_keys.len(),
            };
            let (before_twigs, twig_length) = proxy.twigs();
            shapes.push(Shape {
                center: known.center.to_array(),
                reach: known.reach,
                first_chunk: known.first_chunk,
                chunks: known.chunks,
                somata: proxy.somata().len() as u32,
                soma_radius: proxy.somata().iter().map(|c| c.radius).fold(0.0, f32::max),
                before_twigs: before_twigs as u32,
                twig_length,
                pad: [0; 2],
            });
            chunks.extend(known.placed(proxy));
            packed.extend(&proxy.packed);
            color_keys.extend(&proxy.color_keys);
            self.known.push(known);
        }
        let grown = [
            self.chunks.append(gpu, &chunks)?,
            self.shapes.append(gpu, &shapes)?,
            self.packed.append(gpu, &packed)?,
            self.color_keys.append(gpu, &color_keys)?,
        ];
        self.changed(grown.contains(&true));
        gpu.check()?;
        Ok((first..self.known.len())
            .map(|id| TemplateId(id as u32))
            .collect())
    }

    /// Uploads the color keys of a template's proxy, which [`Proxy::set_color_keys`] has changed.
    ///
    /// # Errors
    /// The device reports an error.
    ///
    /// # Panics
    /// If there is no such template, or the proxy is another template's.
    pub fn recolor(
        &mut self,
        gpu: &Gpu,
        template: TemplateId,
        proxy: &Proxy,
    ) -> Result<(), DeviceError> {
        let known = &mut self.known[template.0 as usize];
        assert_eq!(known.chunks as usize, proxy.chunks.len(), "its own proxy");
        let mut grown = false;
        if proxy.color_keys.len() <= known.color_keys {
            self.color_keys
                .write(gpu, known.first_color_key, &proxy.color_keys);
        } else {
            known.first_color_key = self.color_keys.used() as usize / size_of::<u32>();
            known.color_keys = proxy.color_keys.len();
            grown = self.color_keys.append(gpu, &proxy.color_keys)?;
        }
        let chunks: Vec<Chunk> = known.placed(proxy).collect();
        self.chunks.write(gpu, known.first_chunk as usize, &chunks);
        self.changed(grown);
        gpu.check()
    }

    /// Notes that something changed. `buffers`: some buffer was replaced by a larger one.
    pub(super) fn changed(&mut self, buffers: bool) {
        if buffers {
            self.groups = None;
        }
        *self.stale.get_mut() = true;
    }

    /// Replaces the instances. Shaders know an instance by its index in this list.
    ///
    /// # Errors
    /// An instance has no template or a placement that is not finite, or the device reports an
    /// error.
    pub fn set_instances(
        &mut self,
        gpu: &Gpu,
        instances: Vec<Instance>,
    ) -> Result<(), ExplorationError> {
        for (i, instance) in instances.iter().enumerate() {
            check_placement(i, instance, self.known.len())?;
        }
        let gpu_instances: Vec<GpuInstance> =
            instances.iter().map(|i| self.cull_instances(i)).collect();
        let grown = self.gpu_instances.replace(gpu, &gpu_instances)?;
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

    /// Sets the state of an instance, from the next frame on.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn set_state(&mut self, instance: usize, state: u32) {
        self.instances[instance].state = state;
        self.edit(instance);
    }

    /// Marks an instance as edited. The next frame uploads all from the first to the last edited
    /// one.
    fn edit(&mut self, instance: usize) {
        self.edited = match self.edited.is_empty() {
            true => instance..instance + 1,
            false => self.edited.start.min(instance)..self.edited.end.max(instance + 1),
        };
        self.changed(false);
    }

    /// An instance in the form that shaders read.
    pub(super) fn cull_instances(&self, instance: &Instance) -> GpuInstance {
        let at = instance.placement;
        let origin = at.world_from_cell(self.known[instance.template.0 as usize].origin);
        let (cell, offset) = in_cells(origin);
        GpuInstance {
            rotation: at.rotation.as_quat().to_array(),
            offset,
            scale: at.scale as f32,
            cell,
            shape: instance.template.0,
            flags: if instance.hidden { HIDDEN } else { 0 },
            state: instance.state,
            ..GpuInstance::default()
        }
    }
}
