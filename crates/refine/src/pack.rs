//! Packs a coarse mesh into the form that is uploaded to the GPU. Its layout is described in
//! decode.rs.

use neurotess_mesh::CoarseMesh;

use crate::anchors::Reaches;
use crate::decode::SPHERE_U32S;
use crate::packer::Packer;
use crate::part::{MeshPart, PATCHES_OF_SPHERE};
use crate::plan::patch_bends;

/// Packs a mesh into parts of at most `most_patches` slots for patches, some of which stay empty.
/// `color_keys`: one per tracing point, for the renderer; `values`: one level per tracing point.
/// Missing ones are 0 and 1.
///
/// A soma has the color key of its first vertex. A part's points have at most 1,024 different color
/// keys. If no color key is from 2²⁰ to 2³¹, they are taken for indices, and a mesh with more
/// different ones is cut into more parts; else they are taken for fractions of a scale, and lose
/// their lowest bits.
pub fn pack(
    mesh: &CoarseMesh,
    color_keys: &[u32],
    values: &[u8],
    most_patches: usize,
) -> Vec<MeshPart> {
    let mut packer = Packer::new(mesh, color_keys, values);
    packer.find_explicit();
    let most = most_patches.max(4 * PATCHES_OF_SPHERE);
    let mut piles = packer.piles(most);
    while packer.make_parted_explicit(&piles) {
        piles = packer.piles(most);
    }
    let reaches = Reaches::new(mesh, &packer.explicit);
    let mut parts: Vec<MeshPart> = piles
        .iter()
        .map(|pile| packer.write(&packer.contents(pile), &reaches))
        .collect();
    write_bends(mesh, &mut parts);
    parts
}

/// Writes into every sphere how much the edges of its patches bend, with positions as shaders read
/// them.
fn write_bends(mesh: &CoarseMesh, parts: &mut [MeshPart]) {
    let bends = patch_bends(&dequantized(mesh, parts));
    for part in parts {
        let first = part.layout.spheres as usize;
        for (sphere, patches) in part.patches.chunks(PATCHES_OF_SPHERE).enumerate() {
            let there = patches
                .iter()
                .filter_map(|&patch| bends.get(patch as usize));
            // A little more, since devices may round the last bits differently.
            let bend = there.copied().fold(0.0, f32::max) * 1.001 + 1e-12;
            part.packed[first + SPHERE_U32S * sphere + SPHERE_U32S - 1] = bend.to_bits();
        }
    }
}

/// The mesh as shaders read it: the same patches, with positions, radii and directions rounded.
pub fn dequantized(mesh: &CoarseMesh, parts: &[MeshPart]) -> CoarseMesh {
    let mut rounded = mesh.clone();
    for part in parts {
        for &(vertex, position, normal) in &part.vertices {
            let vertex = &mut rounded.vertices[vertex as usize];
            (vertex.position, vertex.normal) = (position, normal);
        }
        for &(index, point) in &part.tracing {
            rounded.tracing[index as usize] = point;
        }
    }
    rounded
}
