//! The resident form of a coarse mesh: what goes to the GPU once.
//!
//! A mesh is cut into **parts** where it would not fit one binding of a device. Parts keep the order
//! of vertices, so that an edge between two parts runs in the same direction in both, and no crack
//! opens between them.

use bytemuck::{Pod, Zeroable};
use neurotess_mesh::{CoarseMesh, Patch};

/// A corner of patches. Twin of the struct of the same name in `template.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PackedVertex {
    /// Position (µm, relative to the mesh's origin).
    pub position: [f32; 3],
    /// Its tracing point, counted from the part's first.
    pub tracing: u32,
    /// Unit normal.
    pub normal: [f32; 3],
    /// Free for the renderer: its colour.
    pub word: u32,
}

/// A tracing point. Twin of the struct of the same name in `template.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PackedTracing {
    /// Centre (µm, relative to the mesh's origin).
    pub center: [f32; 3],
    /// Radius (µm).
    pub radius: f32,
    /// Unit orientation.
    pub tangent: [f32; 3],
    /// Role in bits 0 to 7, the user's level in bits 8 to 15.
    pub role_and_value: u32,
}

/// Bits of a packed patch's first corner below its kind.
pub(crate) const PATCH_KIND_SHIFT: u32 = 30;

/// A piece of a coarse mesh that fits a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Vertices, in the mesh's order.
    pub vertices: Vec<PackedVertex>,
    /// Tracing points, in the mesh's order.
    pub tracing: Vec<PackedTracing>,
    /// Corners of patches, counted from the part's first vertex; the kind in the upper two bits of
    /// the first.
    pub patches: Vec<[u32; 4]>,
    /// Index in the mesh of the part's first patch; the others follow.
    pub first_patch: usize,
}

impl Part {
    /// Bytes on the device.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.vertices) + size_of_val(&*self.tracing) + size_of_val(&*self.patches)
    }
}

/// Packs a mesh into parts of at most `most_patches` patches. `words`: one word per tracing
/// point for the renderer; `values`: one level per tracing point. Missing ones are 0 and 1.
pub fn pack(mesh: &CoarseMesh, words: &[u32], values: &[u8], most_patches: usize) -> Vec<Part> {
    let most = most_patches.clamp(1, 1 << (PATCH_KIND_SHIFT - 2));
    let ranges = (0..mesh.patches.len()).step_by(most);
    ranges
        .map(|first| {
            let end = (first + most).min(mesh.patches.len());
            pack_part(mesh, words, values, first, &mesh.patches[first..end])
        })
        .collect()
}

fn pack_part(
    mesh: &CoarseMesh,
    words: &[u32],
    values: &[u8],
    first_patch: usize,
    patches: &[Patch],
) -> Part {
    let vertices = used(patches.iter().flat_map(|p| p.corners));
    let tracing = used(vertices.iter().map(|&v| mesh.vertices[v as usize].tracing));
    let place = |list: &[u32], id: u32| list.binary_search(&id).unwrap_or(0) as u32;
    let packed_vertex = |&v: &u32| {
        let vertex = &mesh.vertices[v as usize];
        PackedVertex {
            position: vertex.position.to_array(),
            tracing: place(&tracing, vertex.tracing),
            normal: vertex.normal.to_array(),
            word: words.get(vertex.tracing as usize).copied().unwrap_or(0),
        }
    };
    let packed_tracing = |&t: &u32| {
        let point = &mesh.tracing[t as usize];
        let value = values.get(t as usize).copied().unwrap_or(1);
        PackedTracing {
            center: point.center.to_array(),
            radius: point.radius,
            tangent: point.tangent.to_array(),
            role_and_value: point.role as u32 | (u32::from(value) << 8),
        }
    };
    let packed_patch = |p: &Patch| {
        let mut corners = p.corners.map(|v| place(&vertices, v));
        corners[0] |= (p.kind as u32) << PATCH_KIND_SHIFT;
        corners
    };
    Part {
        vertices: vertices.iter().map(packed_vertex).collect(),
        tracing: tracing.iter().map(packed_tracing).collect(),
        patches: patches.iter().map(packed_patch).collect(),
        first_patch,
    }
}

/// The ids that occur, sorted, each once.
fn used(ids: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut ids: Vec<u32> = ids.collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use neurotess_mesh::{PatchKind, TracingPoint, Vertex};

    #[test]
    fn parts_keep_the_order_and_cover_the_mesh() {
        let mut mesh = CoarseMesh::default();
        for i in 0..12_u32 {
            mesh.tracing.push(TracingPoint::default());
            mesh.vertices.push(Vertex {
                position: Vec3::splat(i as f32),
                tracing: i,
                ..Vertex::default()
            });
        }
        for i in 0..5_u32 {
            let corners = [i + 3, i, i + 7, i + 1];
            let kind = PatchKind::Cap;
            mesh.patches.push(Patch { corners, kind });
        }
        let parts = pack(&mesh, &[], &[], 2);
        assert_eq!(parts.len(), 3);
        for part in &parts {
            assert!(part.vertices.is_sorted_by_key(|v| v.position[0]));
            for (k, packed) in part.patches.iter().enumerate() {
                let patch = mesh.patches[part.first_patch + k];
                assert_eq!(packed[0] >> PATCH_KIND_SHIFT, PatchKind::Cap as u32);
                let mask = (1 << PATCH_KIND_SHIFT) - 1;
                let positions = packed.map(|c| part.vertices[(c & mask) as usize].position[0]);
                assert_eq!(positions, patch.corners.map(|v| v as f32));
            }
        }
    }
}
