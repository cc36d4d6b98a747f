//! The compute passes of the selection: their shaders, pipelines and order.
//!
//! ```text
//! classify: which clusters show ─▶ decide: levels by patch ─▶ note: counts, and corners that are needed
//!    ─▶ make: corners, once for all patches ─▶ scan: offsets from counts
//!    ─▶ flatten: triangles of level 1 ─▶ scatter: the list of all others
//! ```
//!
//! A cluster of 64 patches that does not show costs one lane. Where all edges of a cluster are
//! known to have one level, its patches are not decided one by one; and the four patches of a tube
//! are decided together. Each of these cases is a pass with a queue, not a branch: Mesa's software
//! Vulkan takes the time of both sides of a branch.

use neurotess_refine::wgsl::{Shader, ShaderParts};

use crate::gpu::device::Gpu;
use crate::gpu::parallel::all_of;
use crate::gpu::shader;
use crate::scene::templates::CLUSTER;
use crate::scene::templates::Page;
use crate::sources::adaptive::batch::Batch;
use crate::sources::adaptive::grids::BUCKETS;
use crate::sources::adaptive::layouts::WorkLayouts;
use crate::sources::adaptive::settings::{
    BatchUniforms, QUEUE_ASKED, QUEUE_PLAIN, QUEUE_RINGS, QUEUE_SECTIONS, QUEUE_SHOWN, constants,
};
use crate::sources::adaptive::work::Work;

/// The shader modules of the passes, in the order of the passes.
pub(crate) fn modules() -> [Shader; 7] {
    let of_file = |name: &'static str| {
        let mut parts = ShaderParts::new(&[shader::file(name)]);
        parts.constants = constants();
        shader::shader(name, &parts)
    };
    [
        "classify.wgsl",
        "cull.wgsl",
        "note.wgsl",
        "coarse.wgsl",
        "scan.wgsl",
        "flatten.wgsl",
        "list.wgsl",
    ]
    .map(of_file)
}

/// Entry points: index of the module, name, and number of buffers in group 2.
pub(crate) const ENTRIES: [(usize, &str, u32); 12] = [
    (0, "classify", 2),
    (1, "decide_plain", 3),
    (1, "level_rings", 3),
    (1, "decide_tubes", 3),
    (1, "decide_singles", 2),
    (2, "note", 2),
    (3, "make_rings", 1),
    (3, "make_explicit", 1),
    (4, "scan_marks", 2),
    (4, "scan_buckets", 2),
    (5, "flatten", 2),
    (6, "scatter", 3),
];

/// The pipelines of the passes.
#[derive(Debug)]
pub(crate) struct Passes {
    classify: wgpu::ComputePipeline,
    decide_plain: wgpu::ComputePipeline,
    level_rings: wgpu::ComputePipeline,
    decide_tubes: wgpu::ComputePipeline,
    decide_singles: wgpu::ComputePipeline,
    note: wgpu::ComputePipeline,
    make_rings: wgpu::ComputePipeline,
    make_explicit: wgpu::ComputePipeline,
    scan_marks: wgpu::ComputePipeline,
    scan_buckets: wgpu::ComputePipeline,
    flatten: wgpu::ComputePipeline,
    scatter: wgpu::ComputePipeline,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, page: &wgpu::BindGroupLayout, layouts: &WorkLayouts) -> Self {
        let device = &gpu.device;
        let shaders = modules();
        let modules: [_; 7] = all_of(gpu, |module| gpu.shader_module(&shaders[module]));
        let pipeline = |module: usize, entry, own: &wgpu::BindGroupLayout| {
            let groups = [page, &layouts.clusters, own].map(Some);
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry),
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout),
                module: &modules[module],
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let [
            classify,
            decide_plain,
            level_rings,
            decide_tubes,
            decide_singles,
            note,
            make_rings,
            make_explicit,
            scan_marks,
            scan_buckets,
            flatten,
            scatter,
        ] = all_of(gpu, |place| {
            let (module, entry, written) = ENTRIES[place];
            pipeline(module, entry, layouts.written(written))
        });
        Self {
            classify,
            decide_plain,
            level_rings,
            decide_tubes,
            decide_singles,
            note,
            make_rings,
            make_explicit,
            scan_marks,
            scan_buckets,
            flatten,
            scatter,
        }
    }

    /// All passes of a batch, in one compute pass of wgpu.
    pub(crate) fn dispatch(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        page: &Page,
        work: &Work,
        batch: &Batch,
    ) {
        let BatchUniforms {
            clusters,
            explicit_vertices,
            ..
        } = batch.uniforms;
        let lanes = |count: u32| count.div_ceil(CLUSTER as u32);
        let at = |queue: u32| u64::from(queue) * 12;
        let b = &work.buffers;
        let queues = &b.cluster_dispatches;
        pass.set_bind_group(0, &page.group, &[]);
        let offset = [work.batch_offset(batch.index)];
        pass.set_bind_group(1, &work.groups.clusters, &offset);

        pass.set_bind_group(2, &work.groups.classify, &[]);
        pass.set_pipeline(&self.classify);
        pass.dispatch_workgroups(lanes(clusters), 1, 1);

        pass.set_bind_group(2, &work.groups.decide, &[]);
        pass.set_pipeline(&self.decide_plain);
        pass.dispatch_workgroups_indirect(queues, at(QUEUE_PLAIN));
        pass.set_pipeline(&self.level_rings);
        pass.dispatch_workgroups_indirect(queues, at(QUEUE_ASKED));
        pass.set_pipeline(&self.decide_tubes);
        pass.dispatch_workgroups_indirect(queues, at(QUEUE_ASKED));
        pass.set_bind_group(2, &work.groups.decide_singles, &[]);
        pass.set_pipeline(&self.decide_singles);
        pass.dispatch_workgroups_indirect(&b.single_dispatch, 0);
        pass.set_bind_group(2, &work.groups.note, &[]);
        pass.set_pipeline(&self.note);
        pass.dispatch_workgroups_indirect(queues, at(QUEUE_SHOWN));

        pass.set_bind_group(2, &work.groups.coarse, &[]);
        pass.set_pipeline(&self.make_rings);
        pass.dispatch_workgroups_indirect(&b.noted_dispatches, at(QUEUE_RINGS));
        pass.set_pipeline(&self.make_explicit);
        pass.dispatch_workgroups(lanes(explicit_vertices), 1, 1);

        pass.set_bind_group(2, &work.groups.scan, &[]);
        pass.set_pipeline(&self.scan_marks);
        // A workgroup for each bucket, and one for flat patches.
        pass.dispatch_workgroups(BUCKETS as u32 + 1, 1, 1);
        pass.set_pipeline(&self.scan_buckets);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_bind_group(2, &work.groups.flatten, &[]);
        pass.set_pipeline(&self.flatten);
        pass.dispatch_workgroups_indirect(queues, at(QUEUE_SHOWN));
        pass.set_bind_group(2, &work.groups.list, &[]);
        pass.set_pipeline(&self.scatter);
        pass.dispatch_workgroups_indirect(&b.noted_dispatches, at(QUEUE_SECTIONS));
    }
}
