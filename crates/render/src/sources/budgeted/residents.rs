//! What exploration mode keeps on the device, and how it changes: templates, their colors,
//! instances.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::buffers::{Counts, shape_of};
use super::layout::{GpuInstance, HIDDEN, Shape};
use super::proxy::Proxy;
use super::streaming::Streaming;
use super::{Exploration, in_cells};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use neurotess_picture::Frame;
use neurotess_picture::{Instance, SceneError, TemplateId, check_placement};

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
    /// Its first chunk on the device, now.
    pub(super) first_chunk: u32,
    /// Number of its chunks, all of which are on the device if it is not streamed.
    pub(super) chunks: u32,
}

impl Known {
    fn new(proxy: &Proxy, shape: &Shape) -> Self {
        Self {
            origin: proxy.origin,
            center: proxy.center,
            reach: proxy.reach,
            points: proxy.point_count(),
            first_chunk: shape.first_chunk,
            chunks: proxy.chunks.len() as u32,
        }
    }
}

impl Exploration {
    /// Uploads templates. Their ids follow those already there.
    ///
    /// # Errors
    /// All templates together are larger than a buffer that the device can bind, or the device
    /// reports another error.
    pub fn add(&mut self, gpu: &Gpu, proxies: &[Proxy]) -> Result<Vec<TemplateId>, DeviceError> {
        self.add_whole(gpu, proxies.iter())
    }

    /// Uploads templates as far as they fit `memory` (bytes) and the device's bindings. If not all points do, the rest
    /// comes and goes by what the camera is near: see [`Exploration::prepare`](crate::VertexSource::prepare) and
    /// [`Exploration::is_pending`]. Without `memory` only the bindings count. The memory is that of all templates, those
    /// that are there already included; instances and lists of what is drawn come on top ([`Exploration::bytes`]).
    ///
    /// # Errors
    /// Templates are streamed already, or not even their coarsest form fits, or the device reports another error.
    pub fn add_streamed(
        &mut self,
        gpu: &Gpu,
        proxies: &[Arc<Proxy>],
        memory: Option<u64>,
    ) -> Result<Vec<TemplateId>, DeviceError> {
        let used = self.buffers.used();
        let counts = proxies.iter().map(|proxy| Counts::of(proxy));
        let counts = counts.fold(Counts::default(), |sum, one| sum.plus(&one));
        let all = used.plus(&counts);
        let shapes = self.buffers.shapes.used() + (proxies.len() * size_of::<Shape>()) as u64;
        let memory = memory.unwrap_or(u64::MAX);
        let bound = all
            .by_buffer()
            .iter()
            .all(|&bytes| bytes <= gpu.largest_binding());
        if bound && all.bytes() + shapes <= memory && self.streaming.is_none() {
            return self.add_whole(gpu, proxies.iter().map(Arc::as_ref));
        }
        if self.streaming.is_some() {
            // Those that are streamed have taken all room.
            let (bytes, most) = (counts.bytes(), 0);
            return Err(DeviceError::TooManyTracings { bytes, most });
        }
        let left = memory.saturating_sub(used.bytes() + shapes);
        let first = self.known.len();
        let streaming = Streaming::new(gpu, &mut self.buffers, first, proxies, left)?;
        let shapes: Vec<Shape> = (0..proxies.len())
            .map(|index| streaming.base_shape(index))
            .collect();
        self.streaming = Some(streaming);
        self.register(gpu, proxies.iter().map(Arc::as_ref).zip(shapes), true)
    }

    fn add_whole<'p>(
        &mut self,
        gpu: &Gpu,
        proxies: impl Iterator<Item = &'p Proxy> + Clone,
    ) -> Result<Vec<TemplateId>, DeviceError> {
        let (rooms, grown) = self.buffers.append(gpu, proxies.clone())?;
        let shapes: Vec<Shape> = proxies
            .clone()
            .zip(&rooms)
            .map(|(proxy, room)| shape_of(proxy, room))
            .collect();
        self.register(gpu, proxies.zip(shapes), grown)
    }

    /// Notes templates that were uploaded. `grown`: some buffer was replaced by a larger one.
    fn register<'p>(
        &mut self,
        gpu: &Gpu,
        added: impl Iterator<Item = (&'p Proxy, Shape)>,
        grown: bool,
    ) -> Result<Vec<TemplateId>, DeviceError> {
        let first = self.known.len();
        let mut shapes = Vec::new();
        for (proxy, shape) in added {
            self.known.push(Known::new(proxy, &shape));
            shapes.push(shape);
        }
        let grown = grown | self.buffers.shapes.append(gpu, &shapes)?;
        self.changed(grown);
        gpu.check()?;
        Ok((first..self.known.len())
            .map(|id| TemplateId(id as u32))
            .collect())
    }

    /// Uploads what a picture shows more finely than it is there, if templates are streamed.
    pub(super) fn stream(&mut self, gpu: &Gpu, frame: &Frame) {
        let Some(streaming) = &mut self.streaming else {
            return;
        };
        let pixel = frame.pixel().times(self.sub_pixels);
        let changed = streaming.follow(gpu, &self.buffers, &self.instances, frame, pixel);
        for (template, shape) in changed {
            self.known[template].first_chunk = shape.first_chunk;
            self.buffers.shapes.write(gpu, template, &[shape]);
            *self.stale.get_mut() = true;
        }
    }

    /// Limits what a picture may upload of streamed templates (bytes), so that none takes long: the rest follows with the
    /// next pictures. Without a limit every picture has all that it shows.
    pub fn set_most_upload(&mut self, bytes: Option<u64>) {
        if let Some(streaming) = &mut self.streaming {
            streaming.most_upload = bytes.unwrap_or(u64::MAX);
        }
    }

    /// Whether the picture that was prepared last would be finer with what is still to be uploaded.
    pub fn is_pending(&self) -> bool {
        self.streaming
            .as_ref()
            .is_some_and(|streaming| streaming.is_pending)
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
        let chunks = |instance: &Instance| self.known[instance.template.0 as usize].chunks;
        self.chunks = instances.iter().map(|i| u64::from(chunks(i))).sum();
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
