//! Selection of levels: compute passes that turn the placed parts of a scene into arguments of
//! indirect draws.
//!
//! **Theory.** Nießner et al., Real-time rendering techniques with hardware tessellation, 2016,
//! cull and decide in the tessellation control stage. wgpu has no such stage, so compute passes do
//! it for every patch (passes.rs), and patches with grids of the same size are drawn together
//! (grids.rs).
//!
//! **Practice.** The host culls whole parts of instances, orders them by page, and cuts them into
//! **batches** of at most a million patches, which share one set of work buffers: memory does not
//! grow with the level, and beyond a million patches not with the scene. Per batch:
//! [`Refiner::select`] in an encoder, then [`Refiner::draw`] in a render pass whose pipeline was
//! made with [`Refiner::vertex_shader`] and [`Refiner::layout`]. Nothing is read back.

use std::sync::Arc;

use neurotess_refine::wgsl::{Constants, ShaderParts};
use wgpu::BufferUsages;

use crate::gpu::buffers::upload;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::scene::Scene;
use crate::scene::templates;
use crate::scene::templates::CLUSTER;
use crate::sources::adaptive::batch::{Batch, DrawIndexed, FramePlan, cut, place_all};
use crate::sources::adaptive::grids::{BUCKETS, Bucket, TUBE_BUCKETS, buckets};
use crate::sources::adaptive::layouts::WorkLayouts;
use crate::sources::adaptive::passes::Passes;
use crate::sources::adaptive::settings::{
    BatchUniforms, FlatIndices, FrameUniforms, Placed, constants,
};
use crate::sources::adaptive::work::{Sizes, Work};
use neurotess_picture::{AdaptiveSettings, CullView};

/// Pipelines and work buffers of adaptive refinement.
#[derive(Debug)]
pub struct Refiner {
    work_layouts: WorkLayouts,
    passes: Passes,
    indices: wgpu::Buffer,
    buckets: wgpu::Buffer,
    pub(crate) work: Work,
    /// By page of the scene that was prepared last.
    drawing_groups: Vec<wgpu::BindGroup>,
    /// Whether frames are prepared for shaders that look color keys up.
    keyed: bool,
    /// Indices of the instances that are drawn; none: all.
    only: Option<Arc<[usize]>>,
}

impl Refiner {
    /// Makes pipelines on a device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn new(gpu: &Gpu) -> Result<Self, DeviceError> {
        let device = &gpu.device;
        let template_layout = templates::layout(device);
        let work_layouts = WorkLayouts::new(device);
        let passes = Passes::new(gpu, &template_layout, &work_layouts);
        let (all, indices) = buckets();
        let indices = upload(gpu, "grid indices", BufferUsages::INDEX, &indices);
        let buckets = upload(gpu, "buckets", BufferUsages::STORAGE, &all);
        let work = Work::new(gpu, &work_layouts, &buckets, Sizes::default())?;
        gpu.check()?;
        Ok(Self {
            work_layouts,
            passes,
            indices,
            buckets,
            work,
            drawing_groups: Vec::new(),
            keyed: false,
            only: None,
        })
    }

    /// Number of shaders that draw: one for patches at level 1, one for other tubes, one for all
    /// else.
    pub const SHADERS: usize = 3;

    /// Defines `fn surface_vertex(vertex_index: u32, instance_index: u32) -> SurfaceVertex`. Binds
    /// group 0.
    ///
    /// All shaders compute an edge's vertices by the same expressions, so that there are no cracks.
    /// For that, a vertex shader that calls it must declare its position `@invariant`.
    pub fn vertex_shader(shader: usize) -> ShaderParts {
        ShaderParts {
            files: vec![shader::file("vertices.wgsl")],
            constants: drawing_constants(shader),
        }
    }

    /// The text of [`Refiner::vertex_shader`] with all that it imports.
    pub fn vertex_text(shader: usize) -> String {
        shader::shader("vertices", &Self::vertex_shader(shader)).text
    }

    /// Layout of group 0 of a pipeline that draws.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.work_layouts.drawing
    }

    /// Whether frames are prepared for shaders with vertex_keys.wgsl from now on.
    pub(crate) fn set_keyed(&mut self, keyed: bool) {
        self.keyed = keyed;
    }

    /// The instances that are drawn from the next frame on; none: all.
    pub(crate) fn set_only(&mut self, only: Option<Arc<[usize]>>) {
        self.only = only;
    }

    /// The instances that are drawn; none: all.
    pub(crate) fn only(&self) -> Option<&[usize]> {
        self.only.as_deref()
    }

    /// Culls whole parts, uploads the placements of the others, and cuts them into batches.
    ///
    /// # Errors
    /// The device has no memory left, or reports another error.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        view: &CullView,
        settings: &AdaptiveSettings,
    ) -> Result<FramePlan, DeviceError> {
        let flat = match (self.keyed, settings.wireframe) {
            (true, _) => FlatIndices::Slots,
            (false, true) => FlatIndices::Corners,
            (false, false) => FlatIndices::Places,
        };
        let mut frame = FrameUniforms::new(view, settings, flat);
        let (mut placed, patches) = place_all(scene, self.only(), view, &frame);
        // A stable sort: within a page the scene's order stays.
        placed.sort_by_key(|&(page, _)| page);
        let (batches, first_explicit) = cut(&mut placed);
        frame.first_explicit = first_explicit;
        let most_of = |of: fn(&BatchUniforms) -> u32| {
            let all = batches.iter().map(|batch| of(&batch.uniforms) as usize);
            all.max().unwrap_or(0)
        };
        let sizes = Sizes {
            slots: most_of(|uniforms| uniforms.slots).max(CLUSTER),
            explicit: most_of(|uniforms| uniforms.explicit_vertices),
            placed: placed.len(),
            batches: batches.len(),
        };
        let most = gpu.largest_binding();
        let bytes = size_of_val(&*placed) as u64;
        if bytes > most {
            let what = "the list of visible instances";
            return Err(DeviceError::TooLarge { what, bytes, most });
        }
        if !self.work.holds(&sizes) {
            self.work = Work::new(gpu, &self.work_layouts, &self.buckets, sizes)?;
        }
        let placed: Vec<Placed> = placed.into_iter().map(|(_, part)| part).collect();
        self.work.write(gpu, &frame, &placed, &batches);
        let pages = scene.templates().pages.iter().map(|page| {
            let layout = &self.work_layouts.drawing;
            self.work.drawing_group(gpu, layout, page, &self.buckets)
        });
        self.drawing_groups = pages.collect();
        gpu.check()?;
        Ok(FramePlan {
            batches,
            patches,
            placed,
        })
    }

    /// Decides on a batch's patches and lists those that show; without a batch, an empty pass.
    /// `timestamps`: where the device notes the beginning and the end.
    pub fn select(
        &self,
        scene: &Scene,
        encoder: &mut wgpu::CommandEncoder,
        batch: Option<&Batch>,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        if batch.is_some() {
            self.work.begin(encoder);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("levels"),
            timestamp_writes: timestamps,
        });
        if let Some(batch) = batch {
            let page = &scene.templates().pages[batch.page];
            self.passes.dispatch(&mut pass, page, &self.work, batch);
        }
    }

    /// Draws a batch that was selected just before, with the pipeline that is set, which must be
    /// that of the shader. Sets group 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, batch: &Batch, shader: usize) {
        pass.set_bind_group(0, self.drawing_group(batch), &[]);
        let (indices, draws) = match shader {
            0 => (&self.work.buffers.flat_indices, 0..1),
            1 => (&self.indices, 1..1 + TUBE_BUCKETS),
            _ => (&self.indices, 1 + TUBE_BUCKETS..1 + BUCKETS),
        };
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        let offset = (draws.start * size_of::<DrawIndexed>()) as u64;
        let count = draws.len() as u32;
        pass.multi_draw_indexed_indirect(&self.work.buffers.draws, offset, count);
    }

    /// Group 0 of the shaders that compute the vertices of a batch.
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
}

/// Constants of the shaders that compute vertices; flags say which kind of patches vertices.wgsl draws.
pub(crate) fn drawing_constants(shader: usize) -> Constants {
    let mut constants = constants();
    match shader {
        0 => constants.flag("DRAWS_FLAT"),
        1 => constants.flag("DRAWS_TUBES"),
        _ => {}
    }
    constants
}

const _: () = assert!(size_of::<Bucket>() == 20 && size_of::<DrawIndexed>() == 20);
