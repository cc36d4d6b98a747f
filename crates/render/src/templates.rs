//! Templates on the device: uploaded once, in pages that fit a binding.

use bytemuck::Pod;
use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Patch, PatchKind, Role};
use neurotess_refine::{PackedTracing, PackedVertex, Part, pack};
use wgpu::util::DeviceExt;

use crate::decide::patch_ball;
use crate::device::Gpu;
use crate::error::DeviceError;
use crate::refining::CLUSTER;
use crate::scene::TemplateId;

/// Most patches of a part: a batch holds at least one.
pub(crate) const MOST_PATCHES: usize = 1 << 20;

/// A coarse mesh to be uploaded.
#[derive(Clone, Copy, Debug)]
pub struct Template<'t> {
    /// The mesh.
    pub mesh: &'t CoarseMesh,
    /// One word per tracing point for whoever shades: its colour. Missing ones are 0.
    pub words: &'t [u32],
    /// One level per tracing point, for [`Choice::PerPoint`](crate::Choice::PerPoint). Missing ones
    /// are 1.
    pub values: &'t [u8],
}

/// Buffers of a page with their bind group.
#[derive(Debug)]
pub(crate) struct Page {
    /// By name: those of bindings 0 to 3.
    pub(crate) buffers: [(&'static str, wgpu::Buffer); 4],
    pub(crate) group: wgpu::BindGroup,
}

/// Where a part of a template lies.
#[derive(Clone, Debug)]
pub(crate) struct TemplatePart {
    pub(crate) page: usize,
    pub(crate) vertex: u32,
    pub(crate) tracing: u32,
    pub(crate) first_patch: u32,
    pub(crate) first_cluster: u32,
    pub(crate) patches: u32,
    /// Index in the mesh of the first patch.
    pub(crate) in_mesh: u32,
    /// Ball around each cluster of patches, relative to the template's origin (µm).
    pub(crate) balls: Vec<(Vec3, f32)>,
    /// Ball around all of them.
    pub(crate) ball: (Vec3, f32),
}

/// What the host remembers of a template.
#[derive(Clone, Debug)]
pub(crate) struct StoredTemplate {
    pub(crate) origin: DVec3,
    pub(crate) parts: Vec<TemplatePart>,
    points: usize,
}

/// Templates on a device.
#[derive(Debug, Default)]
pub struct Templates {
    pub(crate) pages: Vec<Page>,
    templates: Vec<StoredTemplate>,
}

/// What a page will hold.
#[derive(Default)]
struct Draft {
    vertices: Vec<PackedVertex>,
    tracing: Vec<PackedTracing>,
    patches: Vec<[u32; 4]>,
    clusters: Vec<[f32; 4]>,
}

impl Templates {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Uploads templates, with numbers that follow those already there.
    ///
    /// # Errors
    /// The device has no memory left, or refuses.
    pub fn add(
        &mut self,
        gpu: &Gpu,
        templates: &[Template<'_>],
    ) -> Result<Vec<TemplateId>, DeviceError> {
        let layout = layout(&gpu.device);
        let most_bytes = usize::try_from(gpu.largest_binding()).unwrap_or(usize::MAX);
        // The largest array of a part is that of its vertices: at most four per patch.
        let most = (most_bytes / (4 * size_of::<PackedVertex>())).clamp(CLUSTER, MOST_PATCHES);
        let mut draft = Draft::default();
        let first = self.templates.len();
        for template in templates {
            let mut stored = StoredTemplate {
                origin: template.mesh.origin,
                parts: Vec::new(),
                points: points(template.mesh),
            };
            for part in pack(template.mesh, template.words, template.values, most) {
                if !draft.holds(&part, most_bytes) {
                    let full = std::mem::take(&mut draft);
                    self.finish(gpu, &layout, &full);
                }
                stored
                    .parts
                    .push(draft.push(part, template.mesh, self.pages.len()));
            }
            self.templates.push(stored);
        }
        self.finish(gpu, &layout, &draft);
        gpu.check()?;
        let ids = first..self.templates.len();
        Ok(ids.map(|id| TemplateId(id as u32)).collect())
    }

    fn finish(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout, draft: &Draft) {
        if draft.patches.is_empty() {
            return;
        }
        let buffers = [
            ("vertices", upload(gpu, "vertices", &draft.vertices)),
            ("tracing", upload(gpu, "tracing", &draft.tracing)),
            ("patches", upload(gpu, "patches", &draft.patches)),
            ("clusters", upload(gpu, "clusters", &draft.clusters)),
        ];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(&buffers)
            .map(|(binding, (_, buffer))| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("page of templates"),
            layout,
            entries: &entries,
        });
        self.pages.push(Page { buffers, group });
    }

    pub(crate) fn template(&self, id: TemplateId) -> Option<&StoredTemplate> {
        self.templates.get(id.0 as usize)
    }

    /// Number of templates.
    pub fn count(&self) -> usize {
        self.templates.len()
    }

    /// Number of tracing points of all templates, those that stand for somata's vertices aside.
    pub fn point_count(&self) -> usize {
        self.templates.iter().map(|template| template.points).sum()
    }

    /// Bytes on the device per tracing point.
    pub fn bytes_per_point(&self) -> f64 {
        let bytes: u64 = self.bytes().iter().map(|&(_, bytes)| bytes).sum();
        bytes as f64 / self.point_count().max(1) as f64
    }

    /// Bytes on the device by the name of the buffer.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let mut sums: Vec<(&'static str, u64)> = Vec::new();
        for (name, buffer) in self.pages.iter().flat_map(|page| &page.buffers) {
            match sums.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += buffer.size(),
                None => sums.push((name, buffer.size())),
            }
        }
        sums
    }
}

impl Draft {
    fn holds(&self, part: &Part, most_bytes: usize) -> bool {
        let fits = |have: usize, more: usize, each: usize| (have + more) * each <= most_bytes;
        self.patches.is_empty()
            || (fits(
                self.vertices.len(),
                part.vertices.len(),
                size_of::<PackedVertex>(),
            ) && fits(
                self.tracing.len(),
                part.tracing.len(),
                size_of::<PackedTracing>(),
            ) && fits(self.patches.len(), part.patches.len(), 16))
    }

    fn push(&mut self, part: Part, mesh: &CoarseMesh, page: usize) -> TemplatePart {
        let patches = &mesh.patches[part.first_patch..part.first_patch + part.patches.len()];
        let balls = cluster_balls(mesh, patches);
        let stored = TemplatePart {
            page,
            vertex: self.vertices.len() as u32,
            tracing: self.tracing.len() as u32,
            first_patch: self.patches.len() as u32,
            first_cluster: self.clusters.len() as u32,
            patches: part.patches.len() as u32,
            in_mesh: part.first_patch as u32,
            ball: around(balls.iter().copied()),
            balls,
        };
        self.vertices.extend(part.vertices);
        self.tracing.extend(part.tracing);
        self.patches.extend(part.patches);
        let words = |&(center, radius): &(Vec3, f32)| center.extend(radius).to_array();
        self.clusters.extend(stored.balls.iter().map(words));
        stored
    }
}

fn points(mesh: &CoarseMesh) -> usize {
    let tracing = mesh.tracing.iter();
    tracing.filter(|point| point.role != Role::Soma).count()
}

/// A ball around each cluster of patches.
pub(crate) fn cluster_balls(mesh: &CoarseMesh, patches: &[Patch]) -> Vec<(Vec3, f32)> {
    let clusters = patches.chunks(CLUSTER);
    clusters
        .map(|cluster| around(cluster.iter().map(|patch| ball_of(mesh, patch))))
        .collect()
}

/// The ball around a patch.
pub(crate) fn ball_of(mesh: &CoarseMesh, patch: &Patch) -> (Vec3, f32) {
    let corners = patch.corners.map(|v| {
        let vertex = &mesh.vertices[v as usize];
        (
            vertex.position,
            mesh.tracing[vertex.tracing as usize].center,
        )
    });
    patch_ball(patch.kind == PatchKind::Soma, &corners)
}

/// A ball around balls: about the middle of their box.
pub(crate) fn around(balls: impl Iterator<Item = (Vec3, f32)> + Clone) -> (Vec3, f32) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (center, radius) in balls.clone() {
        low = low.min(center - radius);
        high = high.max(center + radius);
    }
    let middle = (low + high) / 2.0;
    let reach = balls.map(|(center, radius)| center.distance(middle) + radius);
    // Rounding, of coordinates as large as the middle's, must not uncover anything.
    let slack = 1e-6 * middle.abs().max_element();
    (middle, reach.fold(0.0, f32::max) * 1.000_01 + slack)
}

fn upload<T: Pod>(gpu: &Gpu, label: &str, data: &[T]) -> wgpu::Buffer {
    let contents = bytemuck::cast_slice(data);
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        })
}

/// Group 0 of the pass that decides: vertices, tracing points, patches and clusters.
pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let compute = wgpu::ShaderStages::COMPUTE;
    let entries = [0, 1, 2, 3].map(|binding| crate::refiner::storage(binding, compute, true));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("page of templates"),
        entries: &entries,
    })
}
