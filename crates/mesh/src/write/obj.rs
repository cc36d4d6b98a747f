//! OBJ, text. Wavefront, Advanced Visualizer, appendix B1 (Object Files).
//!
//! Faces are in groups by type. They stay in the order of the surface, and `g` is written where the type changes:
//! rows of a table and triangles of the file have the same order, and one pass writes them. Surfaces follow the tracing,
//! so there are few changes: 11 or 12 in each of the sample cells at level 4.
//! **Why not** each type at a stretch: its faces would have to be made once more for each type.
//!
//! Materials are written only if a file is named that has them ([`obj_materials`]).
//! **Why not** always: trimesh makes a mesh of its own of the faces of each material, so that what it reads is no
//! longer closed. Groups divide nothing in trimesh, and in meshio only the list of cells.

use std::collections::BTreeSet;

use super::materials::type_color;
use super::{File, WriteError, push_index, push_position};
use crate::face_types::{FaceTypes, TypesOfGroups};
use crate::{Faces, Surface, region_name};

/// Faces as text, with a line where the type changes, but not before the first.
#[derive(Default)]
struct Grouped {
    text: Vec<u8>,
    /// The type of the first face, then each that it changes to.
    kinds: Vec<i32>,
}

/// Writes the surface and gives the types of its faces. `materials`: the name of the file that has them.
pub(super) fn write(
    surface: &dyn Surface,
    materials: Option<&str>,
    file: &mut File<'_>,
) -> Result<BTreeSet<i32>, WriteError> {
    let origin = surface.origin();
    let mut place = 0;
    let mut header = format!("# neurotess, units: {}\n", surface.unit());
    if let Some(name) = materials {
        header += &format!("mtllib {name}\n");
    }
    file.put(&mut place, header.as_bytes())?;
    let mut places = [place];
    let types = TypesOfGroups::default();
    file.vertices_of_blocks(surface, &mut places, |blocks, group, [text]| {
        types.add(&blocks, group);
        text.reserve(72 * group.len());
        let mut buffer = zmij::Buffer::new();
        for vertex in group {
            text.extend_from_slice(b"v ");
            push_position(text, vertex, origin);
            text.extend_from_slice(b"\nvn");
            for x in vertex.normal.to_array() {
                text.push(b' ');
                text.extend_from_slice(buffer.format(x).as_bytes());
            }
            text.push(b'\n');
        }
    })?;
    let types = types.finish();
    let with_material = materials.is_some();
    let (mut all, mut last) = (BTreeSet::new(), None);
    file.faces_as(
        surface,
        Grouped::default,
        |faces, grouped| grouped.fill(faces, types.ask(), with_material),
        |file, Grouped { text, kinds }| {
            if let Some(&first) = kinds.first().filter(|&&first| last != Some(first)) {
                let mut line = Vec::new();
                push_group(&mut line, first, with_material);
                file.put(&mut places[0], &line)?;
            }
            all.extend(kinds);
            last = kinds.last().copied().or(last);
            file.put(&mut places[0], text)
        },
    )?;
    Ok(all)
}

impl Grouped {
    fn fill(&mut self, faces: &Faces, mut types: FaceTypes<'_>, with_material: bool) {
        self.text.clear();
        self.kinds.clear();
        self.text
            .reserve(48 * faces.triangles.len() + 64 * faces.quads.len());
        for face in &faces.triangles {
            self.push(face, types.triangle(*face).kind, with_material);
        }
        for face in &faces.quads {
            self.push(face, types.quad(*face).kind, with_material);
        }
    }

    fn push(&mut self, face: &[u32], kind: i32, with_material: bool) {
        if self.kinds.last() != Some(&kind) {
            if !self.kinds.is_empty() {
                push_group(&mut self.text, kind, with_material);
            }
            self.kinds.push(kind);
        }
        push_face(&mut self.text, face);
    }
}

fn push_group(text: &mut Vec<u8>, kind: i32, with_material: bool) {
    let name = region_name(kind);
    text.extend_from_slice(format!("g {name}\n").as_bytes());
    if with_material {
        text.extend_from_slice(format!("usemtl {name}\n").as_bytes());
    }
}

/// `f a//a b//b c//c`: a position and the normal of the same number, counted from 1.
fn push_face(text: &mut Vec<u8>, face: &[u32]) {
    text.push(b'f');
    for &corner in face {
        text.push(b' ');
        let start = text.len();
        push_index(text, u64::from(corner) + 1);
        let end = text.len();
        text.extend_from_slice(b"//");
        text.extend_from_within(start..end);
    }
    text.push(b'\n');
}

/// The file of materials for an OBJ whose faces have these types: each has its name and its color.
///
/// Colors are sRGB, 0 to 1. The format does not say which, and MeshLab and trimesh take them so. Blender takes them as
/// linear light and shows them paler; it shows those of GLB as they are.
pub fn obj_materials(kinds: &BTreeSet<i32>) -> String {
    let mut text = "# neurotess\n".to_owned();
    for &kind in kinds {
        let [r, g, b] = type_color(kind).map(|byte| f32::from(byte) / 255.0);
        let name = region_name(kind);
        text += &format!(
            "\nnewmtl {name}\nKa 0 0 0\nKd {r:.4} {g:.4} {b:.4}\nKs 0 0 0\nNs 10\nd 1\nillum 1\n"
        );
    }
    text
}
