//! The compute passes that choose: their shaders, pipelines and order.
//!
//! ```text
//! classify: which clusters show ─▶ decide: levels by patch ─▶ note: counts, and corners that are needed
//!    ─▶ make: corners, once for all patches ─▶ scan: counts to places
//!    ─▶ flatten: triangles of level 1 ─▶ scatter: the list of all others
//! ```
//!
//! What does not show costs one lane per 64 patches; a cluster whose edges are known to have one level is
//! not asked for each of them; and the four patches of a tube are asked together. Each of these ways is a
//! pass of its own with a queue, not a branch: Mesa's software Vulkan takes the time of both sides.

use neurotess_refine::gpu::CORNER_SOURCE_WGSL;

use crate::scene::templates::CLUSTER;
use crate::scene::templates::Page;
use crate::sources::adaptive::batch::Batch;
use crate::sources::adaptive::grids::BUCKETS;
use crate::sources::adaptive::layouts::WorkLayouts;
use crate::sources::adaptive::settings::{
    BatchUniforms, QUEUE_ASKED, QUEUE_PLAIN, QUEUE_RINGS, QUEUE_SECTIONS, QUEUE_SHOWN, compose,
};
use crate::sources::adaptive::work::Work;

/// What coarse.wgsl writes and vertices.wgsl reads.
pub(crate) const COARSE_POINT_WGSL: &str = include_str!("coarse_point.wgsl");
const CLUSTERS_WGSL: &str = include_str!("clusters.wgsl");
const SHOWN_WGSL: &str = include_str!("shown.wgsl");

/// The modules of the passes, by name.
pub(crate) fn modules() -> [(&'static str, String); 7] {
    let classify = [CLUSTERS_WGSL, SHOWN_WGSL, include_str!("classify.wgsl")];
    let decide = [CLUSTERS_WGSL, SHOWN_WGSL, include_str!("cull.wgsl")];
    let note = [CLUSTERS_WGSL, include_str!("note.wgsl")];
    let coarse = [
        CLUSTERS_WGSL,
        COARSE_POINT_WGSL,
        include_str!("coarse.wgsl"),
    ];
    let scan = [CLUSTERS_WGSL, include_str!("scan.wgsl")];
    let flatten = [CLUSTERS_WGSL, include_str!("flatten.wgsl")];
    let list = [CLUSTERS_WGSL, include_str!("list.wgsl")];
    [
        ("classify", &classify[..]),
        ("decide", &decide),
        ("note", &note),
        ("coarse", &coarse),
        ("scan", &scan),
        ("flatten", &flatten),
        ("list", &list),
    ]
    .map(|(name, own)| (name, compose(&[&[CORNER_SOURCE_WGSL], own].concat())))
}

/// Pipelines.
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
    pub(crate) fn new(
        device: &wgpu::Device,
        page: &wgpu::BindGroupLayout,
        layouts: &WorkLayouts,
    ) -> Self {
        let modules = modules().map(|(name, text)| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            })
        });
        let [classify, decide, note, coarse, scan, flatten, list] = &modules;
        let pipeline = |module, entry, own: &wgpu::BindGroupLayout| {
            let groups = [page, &layouts.clusters, own].map(Some);
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry),
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout),
                module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let WorkLayouts {
            one, two, three, ..
        } = layouts;
        Self {
            classify: pipeline(classify, "classify", two),
            decide_plain: pipeline(decide, "decide_plain", three),
            level_rings: pipeline(decide, "level_rings", three),
            decide_tubes: pipeline(decide, "decide_tubes", three),
            decide_singles: pipeline(decide, "decide_singles", two),
            note: pipeline(note, "note", two),
            make_rings: pipeline(coarse, "make_rings", one),
            make_explicit: pipeline(coarse, "make_explicit", one),
            scan_marks: pipeline(scan, "scan_marks", two),
            scan_buckets: pipeline(scan, "scan_buckets", two),
            flatten: pipeline(flatten, "flatten", two),
            scatter: pipeline(list, "scatter", three),
        }
    }

    /// All passes of a batch, in one pass of the device.
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
        // One for each bucket, and one for flat patches.
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
