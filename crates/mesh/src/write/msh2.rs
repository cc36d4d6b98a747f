//! MSH 2.2, text: Gmsh's reference manual, "MSH file format version 2 (Legacy)":
//! <https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format-version-2-_0028Legacy_0029>.
//!
//! Each triangle carries two tags: its physical group, which is the code of its type, and its surface. Both are those
//! of version 4.1 (`msh.rs`), and so are the numbers of nodes and triangles.
//! **Why text**: readers of version 2.2 that are no Gmsh, as that of STEPS, know nothing else.

use std::ops::Range;

use super::corners::VertexBlocks;
use super::in_order::in_order;
use super::msh::{Census, label, tagged};
use super::{File, WriteError, faces_of, groups, push_index, push_position};
use crate::{Surface, region_code};

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let blocks = VertexBlocks::find(surface)?;
    let census = Census::take(surface, &blocks)?;
    let mut at = 0;
    file.put(&mut at, &head(surface, &census))?;
    let mut places = [at];
    write_nodes(surface, &blocks, file, &mut places)?;
    [at] = places;
    write_elements(surface, &blocks, &census, file, at)
}

/// Everything before the nodes, and their number.
fn head(surface: &dyn Surface, census: &Census) -> Vec<u8> {
    let (unit, names) = (surface.unit(), census.names());
    let mut head = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nneurotess, units: {unit}\n$EndComments\n\
         $PhysicalNames\n{}\n",
        names.len()
    );
    for (code, name) in names {
        head += &format!("2 {code} \"{name}\"\n");
    }
    head += &format!("$EndPhysicalNames\n$Nodes\n{}\n", surface.vertex_count());
    head.into_bytes()
}

fn write_nodes(
    surface: &dyn Surface,
    blocks: &VertexBlocks<'_>,
    file: &mut File<'_>,
    places: &mut [u64; 1],
) -> Result<(), WriteError> {
    let origin = surface.origin();
    file.vertices_of_blocks(surface, places, |made_of, group, [text]| {
        let first = blocks.start(made_of.start) + 1;
        for (n, vertex) in group.iter().enumerate() {
            push_index(text, (first + n) as u64);
            text.push(b' ');
            push_position(text, vertex, origin);
            text.push(b'\n');
        }
    })?;
    file.put(&mut places[0], b"$EndNodes\n")
}

fn write_elements(
    surface: &dyn Surface,
    blocks: &VertexBlocks<'_>,
    census: &Census,
    file: &mut File<'_>,
    mut at: u64,
) -> Result<(), WriteError> {
    let total: u64 = census.entities.values().map(|entity| entity.count).sum();
    file.put(&mut at, format!("$Elements\n{total}\n").as_bytes())?;
    let faces = surface.triangle_count() + surface.quad_count();
    let groups = groups(surface.face_blocks(), faces);
    let groups: Vec<_> = groups.into_iter().zip(&census.first).collect();
    let encoded = |&(ref group, first): &(Range<usize>, &[u64; 2])| {
        let faces = faces_of(surface, group.clone());
        let corners = blocks.corners(&faces);
        let mut text = Vec::new();
        for (tag, triangle) in tagged(&faces, *first) {
            let label = label(&corners, triangle);
            let surface = census.entities.get(&label).map_or(1, |entity| entity.tag);
            push_index(&mut text, tag);
            // A triangle of three nodes, and two tags.
            text.extend_from_slice(b" 2 2");
            for number in [region_code(label.1), surface] {
                text.push(b' ');
                push_index(&mut text, u64::from(number.unsigned_abs()));
            }
            for corner in triangle {
                text.push(b' ');
                push_index(&mut text, u64::from(corner) + 1);
            }
            text.push(b'\n');
        }
        text
    };
    in_order(&groups, encoded, |text| file.put(&mut at, &text))?;
    file.put(&mut at, b"$EndElements\n")
}
