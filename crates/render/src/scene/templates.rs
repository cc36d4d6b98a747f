//! Templates on the device: uploaded once, in pages that fit a binding.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Role};
use neurotess_picture::{Template, TemplateId};
use neurotess_refine::{PartLayout, SHAPED_U32S, pack, sphere_around};
use wgpu::util::DeviceExt;

use crate::gpu::buffers::{group_layout, storage};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;

/// Number of patches in a cluster, which share a bounding sphere: the size of a workgroup.
pub(crate) const CLUSTER: usize = 64;
/// Number of u32s of an explicit vertex: see refine's template.wgsl.
const EXPLICIT_VERTEX_U32S: u32 = 3;
/// Most slots for patches in a part: as many as a batch has, so that each part fits a batch.
pub(crate) const MAX_PATCHES: usize = 1 << 20;
/// Most u32s that a part takes per patch: an explicit patch with four explicit vertices and their
/// anchors.
const U32S_OF_PATCH: usize = 2 + 4 * (3 + 8);

/// Where the arrays of a part are in the packed buffer of its page: [`PartLayout`] with the part's
/// offset added. Twin of the struct of the same name in refine's template.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Base {
    pub(crate) points: u32,
    pub(crate) point_count: u32,
    pub(crate) spheres: u32,
    pub(crate) explicit_vertices: u32,
    pub(crate) anchors: u32,
    pub(crate) shaped: u32,
    pub(crate) soma: u32,
    pub(crate) soma_count: u32,
    pub(crate) quads: u32,
    pub(crate) caps: u32,
    pub(crate) color_keys: u32,
}

impl Base {
    /// A part that begins at this u32 of the packed buffer.
    pub(crate) fn new(first: u32, layout: &PartLayout) -> Self {
        Self {
            points: first + layout.points,
            point_count: layout.point_count,
            spheres: first + layout.spheres,
            explicit_vertices: first + layout.explicit,
            anchors: first + layout.anchors,
            shaped: first + layout.shaped,
            soma: first + layout.soma,
            soma_count: layout.soma_count,
            quads: first + layout.quads,
            caps: first + layout.caps,
            color_keys: first + layout.color_keys,
        }
    }
}

impl Base {
    /// Number of explicit vertices and corners of shaped rings.
    pub(crate) fn explicit_count(&self) -> u32 {
        let shaped = (self.soma - self.shaped) / SHAPED_U32S as u32;
        (self.anchors - self.explicit_vertices) / EXPLICIT_VERTEX_U32S + 4 * shaped
    }
}

/// The packed buffer of a page with its bind group.
#[derive(Debug)]
pub(crate) struct Page {
    pub(crate) packed: wgpu::Buffer,
    pub(crate) group: wgpu::BindGroup,
}

/// A part of a template on the device.
#[derive(Clone, Debug)]
pub(crate) struct TemplatePart {
    pub(crate) page: usize,
    pub(crate) base: Base,
    /// Number of slots for patches, some of which are empty.
    pub(crate) slots: u32,
    /// Number of patches.
    pub(crate) patches: u32,
    /// By slot: index of the mesh's patch.
    pub(crate) in_mesh: Vec<u32>,
    /// Index of the mesh's vertex by explicit vertex, then by corner of each shaped ring.
    pub(crate) explicit: Vec<u32>,
    /// Bounding sphere of each cluster of patches, relative to the template's origin (µm).
    pub(crate) spheres: Vec<(Vec3, f32)>,
    /// Bounding sphere of the whole part.
    pub(crate) sphere: (Vec3, f32),
}

/// What the host keeps of a template.
#[derive(Clone, Debug)]
pub(crate) struct StoredTemplate {
    pub(crate) origin: DVec3,
    pub(crate) parts: Vec<TemplatePart>,
    points: usize,
    /// On the device, by the name of the array.
    bytes: Vec<(&'static str, u64)>,
}

/// Templates on a device.
#[derive(Debug, Default)]
pub struct Templates {
    pub(crate) pages: Vec<Page>,
    templates: Vec<StoredTemplate>,
    /// Pages that no template uses any more; they hold nothing.
    free: Vec<usize>,
}

impl Templates {
    /// No templates.
    pub fn new() -> Self {
        Self::default()
    }

    /// Uploads templates. Their ids follow those already there.
    ///
    /// # Errors
    /// The device has no memory left, or reports another error.
    pub fn add(
        &mut self,
        gpu: &Gpu,
        templates: &[Template<'_>],
    ) -> Result<Vec<TemplateId>, DeviceError> {
        let layout = layout(&gpu.device);
        let most_u32s = usize::try_from(gpu.largest_binding() / 4).unwrap_or(usize::MAX);
        let most = (most_u32s / U32S_OF_PATCH).clamp(CLUSTER, MAX_PATCHES);
        let mut packed = Vec::new();
        let first = self.templates.len();
        for template in templates {
            let mut stored = StoredTemplate {
                origin: template.mesh.origin,
                parts: Vec::new(),
                points: points(template.mesh),
                bytes: Vec::new(),
            };
            for part in pack(template.mesh, template.color_keys, template.values, most) {
                if packed.len() + part.packed.len() > most_u32s {
                    self.finish(gpu, &layout, &packed);
                    packed.clear();
                }
                add_bytes(&mut stored.bytes, part.bytes());
                stored.parts.push(TemplatePart {
                    page: self.pages.len(),
                    base: Base::new(packed.len() as u32, &part.layout),
                    slots: part.patches.len() as u32,
                    patches: part.patches.iter().filter(|&&p| p != u32::MAX).count() as u32,
                    sphere: sphere_around(part.spheres.iter().copied()),
                    spheres: part.spheres,
                    in_mesh: part.patches,
                    explicit: part.explicit,
                });
                packed.extend(part.packed);
            }
            self.templates.push(stored);
        }
        self.finish(gpu, &layout, &packed);
        gpu.check()?;
        let ids = first..self.templates.len();
        Ok(ids.map(|id| TemplateId(id as u32)).collect())
    }

    /// Replaces a template's mesh. The new mesh gets pages of its own, in place of those that no
    /// other template uses; what these held is given up. An empty mesh takes no memory.
    ///
    /// # Errors
    /// The device has no memory left, or reports another error; the old mesh stays.
    pub fn replace(
        &mut self,
        gpu: &Gpu,
        id: TemplateId,
        template: &Template<'_>,
    ) -> Result<(), DeviceError> {
        let Some(old) = self.templates.get(id.0 as usize) else {
            return Ok(());
        };
        let mut fresh = Self::new();
        fresh.add(gpu, &[*template])?;
        let pages = |t: &StoredTemplate| -> Vec<usize> { t.parts.iter().map(|p| p.page).collect() };
        let own = pages(old);
        let others = self.templates.iter().enumerate();
        let others: Vec<usize> = others
            .filter(|&(i, _)| i != id.0 as usize)
            .flat_map(|(_, t)| pages(t))
            .collect();
        let mut free: Vec<usize> = own.into_iter().filter(|p| !others.contains(p)).collect();
        free.append(&mut self.free);
        free.sort_unstable();
        free.dedup();
        let mut moved = Vec::new();
        for page in fresh.pages.drain(..) {
            match free.pop() {
                Some(place) => {
                    self.pages[place] = page;
                    moved.push(place);
                }
                None => {
                    moved.push(self.pages.len());
                    self.pages.push(page);
                }
            }
        }
        for &page in &free {
            self.pages[page] = new_page(gpu, &layout(&gpu.device), &[0]);
        }
        self.free = free;
        if let Some(mut stored) = fresh.templates.pop() {
            for part in &mut stored.parts {
                part.page = moved[part.page];
            }
            self.templates[id.0 as usize] = stored;
        }
        Ok(())
    }

    fn finish(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout, packed: &[u32]) {
        if !packed.is_empty() {
            self.pages.push(new_page(gpu, layout, packed));
        }
    }

    pub(crate) fn template(&self, id: TemplateId) -> Option<&StoredTemplate> {
        self.templates.get(id.0 as usize)
    }

    /// Number of templates.
    pub fn count_of_templates(&self) -> usize {
        self.templates.len()
    }

    /// Number of tracing points of all templates, without those of somata.
    pub fn point_count(&self) -> usize {
        self.templates.iter().map(|template| template.points).sum()
    }

    /// Bytes on the device per tracing point.
    pub fn bytes_per_point(&self) -> f64 {
        let bytes: u64 = self.pages.iter().map(|page| page.packed.size()).sum();
        bytes as f64 / self.point_count().max(1) as f64
    }

    /// Bytes on the device by the name of the buffer.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let mut bytes = Vec::new();
        for template in &self.templates {
            add_bytes(&mut bytes, template.bytes.iter().copied());
        }
        bytes
    }
}

fn add_bytes(
    to: &mut Vec<(&'static str, u64)>,
    more: impl IntoIterator<Item = (&'static str, u64)>,
) {
    for (name, bytes) in more {
        match to.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += bytes,
            None => to.push((name, bytes)),
        }
    }
}

fn new_page(gpu: &Gpu, layout: &wgpu::BindGroupLayout, packed: &[u32]) -> Page {
    let packed = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("packed of templates"),
            contents: bytemuck::cast_slice(packed),
            usage: wgpu::BufferUsages::STORAGE,
        });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("page of templates"),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: packed.as_entire_binding(),
        }],
    });
    Page { packed, group }
}

fn points(mesh: &CoarseMesh) -> usize {
    let tracing = mesh.tracing.iter();
    tracing.filter(|point| point.role != Role::Soma).count()
}

/// Group 0 of the passes that select: the packed buffer.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    vec![storage(0, wgpu::ShaderStages::COMPUTE, true)]
}

pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    group_layout(device, "page of templates", &entries())
}
