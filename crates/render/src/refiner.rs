//! Who chooses levels: three compute passes between the placed parts of a scene and draws that need
//! nothing from the host.
//!
//! **Theory.** Nießner et al., Real-time rendering techniques with hardware tessellation, 2016, cull
//! and decide in the tessellation control stage. wgpu has no such stage, so a compute pass does it for
//! every patch (decide.wgsl, list.wgsl), and patches of like grids are drawn together (grids.rs).
//!
//! **Practice.** The host culls whole parts of instances, orders them by page, and cuts them into
//! **batches** of at most [`MOST_SLOTS`] patches, which share one set of work buffers: memory does not
//! grow with the level, and beyond a million patches not with the scene. Per batch: [`Refiner::choose`]
//! in an encoder, then [`Refiner::draw`] in a render pass whose pipeline was made with
//! [`Refiner::vertex_wgsl`] and [`Refiner::layout`]. Nothing is read back.

use bytemuck::{Pod, Zeroable};
use wgpu::{BufferUsages, ShaderStages};

use crate::decide::shows;
use crate::device::Gpu;
use crate::error::DeviceError;
use crate::grids::{BUCKETS, Bucket, TUBE_BUCKETS, buckets};
use crate::refining::{BatchWords, CLUSTER, FrameWords, Placed, Refining, SECTION, Sight, compose};
use crate::scene::Scene;
use crate::templates::{self, MOST_PATCHES};
use crate::work::{Work, WorkLayouts};

/// Most patches that are decided on and drawn together.
pub(crate) const MOST_SLOTS: usize = MOST_PATCHES;

/// Arguments of an indexed indirect draw. Twin of the struct of the same name in list.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct DrawIndexed {
    pub(crate) index_count: u32,
    pub(crate) instance_count: u32,
    pub(crate) first_index: u32,
    pub(crate) base_vertex: u32,
    pub(crate) first_instance: u32,
}

/// A pile of placed parts, all of one page.
#[derive(Clone, Copy, Debug)]
pub struct Batch {
    pub(crate) page: usize,
    pub(crate) words: BatchWords,
    /// Place among the batches of its frame.
    pub(crate) index: u32,
}

/// What one frame draws.
#[derive(Clone, Debug, Default)]
pub struct FramePlan {
    /// In order.
    pub batches: Vec<Batch>,
    /// Patches of all instances that are not hidden.
    pub patches: u64,
}

/// Pipelines and work buffers of adaptive refinement.
#[derive(Debug)]
pub struct Refiner {
    work_layouts: WorkLayouts,
    decide: wgpu::ComputePipeline,
    scan: wgpu::ComputePipeline,
    scatter: wgpu::ComputePipeline,
    indices: wgpu::Buffer,
    buckets: wgpu::Buffer,
    pub(crate) work: Work,
    /// By page of the scene that was prepared last.
    drawing_groups: Vec<wgpu::BindGroup>,
}

impl Refiner {
    /// Makes pipelines on a device.
    ///
    /// # Errors
    /// The device refuses.
    pub fn new(gpu: &Gpu) -> Result<Self, DeviceError> {
        let device = &gpu.device;
        let template_layout = templates::layout(device);
        let work_layouts = WorkLayouts::new(device);
        let pipeline = |text: String, entry: &str, groups: [&wgpu::BindGroupLayout; 2]| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(entry),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            });
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry),
                bind_group_layouts: &groups.map(Some),
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let WorkLayouts {
            decisions, lists, ..
        } = &work_layouts;
        let (all, indices) = buckets();
        let decide = pipeline(decide_wgsl(), "decide", [&template_layout, decisions]);
        let scan = pipeline(list_wgsl(), "scan", [decisions, lists]);
        let scatter = pipeline(list_wgsl(), "scatter", [decisions, lists]);
        let indices = upload(gpu, "grid indices", BufferUsages::INDEX, &indices);
        let usages = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let buckets = upload(gpu, "buckets", usages, &all);
        let work = Work::new(gpu, &work_layouts, &buckets, CLUSTER, 1, 1)?;
        gpu.check()?;
        Ok(Self {
            work_layouts,
            decide,
            scan,
            scatter,
            indices,
            buckets,
            work,
            drawing_groups: Vec::new(),
        })
    }

    /// Shaders that draw: one for tubes at level 1, one for other tubes, one for all else.
    pub const SHADERS: usize = 3;

    /// What makes vertices, to stand after [`SURFACE_VERTEX_WGSL`](crate::SURFACE_VERTEX_WGSL): `fn
    /// surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex`. Binds group 0.
    ///
    /// All shaders find an edge's vertices by the same expressions, and their positions must be
    /// `@invariant`.
    pub fn vertex_wgsl(shader: usize) -> String {
        compose(&[&draws(shader), include_str!("vertices.wgsl")])
    }

    /// Layout of group 0 of a pipeline that draws.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.work_layouts.drawing
    }

    /// Culls whole parts, uploads where the others stand, and cuts them into batches.
    ///
    /// # Errors
    /// The device has no memory left, or refuses.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        sight: &Sight,
        refining: &Refining,
    ) -> Result<FramePlan, DeviceError> {
        let frame = FrameWords::new(sight, refining);
        let (mut placed, patches) = place_all(scene, sight, &frame);
        // By page, else in the scene's order.
        placed.sort_by_key(|&(page, _)| page);
        let batches = cut(&mut placed);
        let slots = batches.iter().map(|b| b.words.slots as usize).max();
        let slots = slots.unwrap_or(0).max(CLUSTER);
        let most = gpu.largest_binding();
        let bytes = size_of_val(&*placed) as u64;
        if bytes > most {
            let what = "the list of visible instances";
            return Err(DeviceError::TooLarge { what, bytes, most });
        }
        if !self.work.holds(slots, placed.len(), batches.len()) {
            let layouts = &self.work_layouts;
            let (placed, batches) = (placed.len(), batches.len());
            self.work = Work::new(gpu, layouts, &self.buckets, slots, placed, batches)?;
        }
        let places: Vec<Placed> = placed.into_iter().map(|(_, place)| place).collect();
        self.work.write(gpu, &frame, &places, &batches);
        let pages = scene.templates().pages.iter().map(|page| {
            let layout = &self.work_layouts.drawing;
            self.work.drawing_group(gpu, layout, page, &self.buckets)
        });
        self.drawing_groups = pages.collect();
        gpu.check()?;
        Ok(FramePlan { batches, patches })
    }

    /// Decides on a batch's patches and lists those that show; without a batch, an empty pass.
    /// `timestamps`: where the device notes the beginning and the end.
    pub fn choose(
        &self,
        scene: &Scene,
        encoder: &mut wgpu::CommandEncoder,
        batch: Option<&Batch>,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        if batch.is_some() {
            encoder.clear_buffer(&self.work.counts, 0, None);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("levels"),
            timestamp_writes: timestamps,
        });
        let Some(batch) = batch else { return };
        let BatchWords {
            slots, sections, ..
        } = batch.words;
        let offset = [self.work.batch_offset(batch.index)];
        pass.set_pipeline(&self.decide);
        pass.set_bind_group(0, &scene.templates().pages[batch.page].group, &[]);
        pass.set_bind_group(1, &self.work.decisions_group, &offset);
        pass.dispatch_workgroups(slots / CLUSTER as u32, 1, 1);
        pass.set_pipeline(&self.scan);
        pass.set_bind_group(0, &self.work.decisions_group, &offset);
        pass.set_bind_group(1, &self.work.lists_group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(&self.scatter);
        pass.dispatch_workgroups(sections, 1, 1);
    }

    /// Draws a batch that was chosen just before, with the pipeline of the shader that is set. Sets
    /// group 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, shader: usize) {
        pass.set_bind_group(0, self.drawing_group(batch), &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        let buckets = match shader {
            0 => 0..1,
            1 => 1..TUBE_BUCKETS,
            _ => TUBE_BUCKETS..BUCKETS,
        };
        let offset = (buckets.start * size_of::<DrawIndexed>()) as u64;
        pass.multi_draw_indexed_indirect(&self.work.draws, offset, buckets.len() as u32);
    }

    /// Group 0 of whoever makes the vertices of a batch.
    pub(crate) fn drawing_group(&self, batch: &Batch) -> &wgpu::BindGroup {
        &self.drawing_groups[batch.page]
    }

    /// Bytes on the device by the name of the buffer, templates aside.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let mut bytes = vec![
            ("grid_indices", self.indices.size()),
            ("buckets", self.buckets.size()),
        ];
        bytes.extend(self.work.bytes());
        bytes
    }

    /// The buffer of buckets, to be read back.
    pub(crate) fn bucket_buffer(&self) -> &wgpu::Buffer {
        &self.buckets
    }
}

/// Which of its ways vertices.wgsl goes in a shader.
pub(crate) fn draws(shader: usize) -> String {
    let [bare, tubes] = [0, 1];
    format!(
        "const DRAWS: u32 = {shader}u;\nconst DRAWS_BARE: u32 = {bare}u;\n\
         const DRAWS_TUBES: u32 = {tubes}u;\n"
    )
}

/// The module of the pass that decides.
pub(crate) fn decide_wgsl() -> String {
    compose(&[include_str!("decide.wgsl")])
}

/// The module of the passes that list.
pub(crate) fn list_wgsl() -> String {
    compose(&[include_str!("list.wgsl")])
}

/// Parts of instances that may show, with their pages, and the number of patches of all.
fn place_all(scene: &Scene, sight: &Sight, frame: &FrameWords) -> (Vec<(usize, Placed)>, u64) {
    let mut placed = Vec::new();
    let mut patches = 0;
    for (i, instance) in scene.instances().iter().enumerate() {
        let Some(template) = scene.templates().template(instance.template) else {
            continue;
        };
        if instance.hidden {
            continue;
        }
        let stand = Placed::new(sight, &instance.placement, template.origin);
        for part in &template.parts {
            patches += u64::from(part.patches);
            let place = Placed {
                base: part.base,
                patches: part.places,
                instance: i as u32,
                state: instance.state,
                ..stand
            };
            if shows(frame, &place, part.ball.0, part.ball.1) {
                placed.push((part.page, place));
            }
        }
    }
    (placed, patches)
}

/// Gives every placed part its slots, a whole number of clusters, and begins a new batch where the
/// page changes or the slots end.
fn cut(placed: &mut [(usize, Placed)]) -> Vec<Batch> {
    let mut batches: Vec<Batch> = Vec::new();
    for (i, (page, place)) in placed.iter_mut().enumerate() {
        let slots = (place.patches as usize).next_multiple_of(CLUSTER);
        let fits = |b: &Batch| b.page == *page && b.words.slots as usize + slots <= MOST_SLOTS;
        if !batches.last().is_some_and(fits) {
            batches.push(Batch {
                page: *page,
                index: batches.len() as u32,
                words: BatchWords {
                    first: i as u32,
                    ..BatchWords::default()
                },
            });
        }
        let Some(batch) = batches.last_mut() else {
            continue;
        };
        place.first_slot = batch.words.slots;
        batch.words.placed += 1;
        batch.words.slots += slots as u32;
        batch.words.sections = batch.words.slots.div_ceil(SECTION as u32);
    }
    batches
}

fn upload<T: Pod>(gpu: &Gpu, label: &str, usage: BufferUsages, data: &[T]) -> wgpu::Buffer {
    use wgpu::util::DeviceExt;
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: bytemuck::cast_slice(data),
            usage,
        })
}

/// A binding of a storage buffer.
pub(crate) fn storage(
    binding: u32,
    visibility: ShaderStages,
    read_only: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

const _: () = assert!(size_of::<Bucket>() == 20 && size_of::<DrawIndexed>() == 20);
