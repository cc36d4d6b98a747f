//! MSH 4.1, binary: Gmsh's reference manual, "MSH file format":
//! <https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format>. `msh2.rs` writes version 2.2 with the same tags.
//!
//! **What a face belongs to.** A section is a discrete surface (an entity of dimension 2) whose tag is
//! the section plus one, so the soma's is 1. A type is a physical group whose tag is its code
//! ([`region_code`]) and that has a name. Every surface is in one group, as dolfinx wants it.
//! **Why not** the section as element data: Gmsh keeps entities when it fills the surface with
//! tetrahedra and saves them; views are lost.
//!
//! **Why no volume**: Gmsh does not fill a volume that a mesh file defines, only one of a model. A
//! surface loop over all surfaces gives it (`docs/simulation.md`).
//!
//! The elements of an entity are together in the file, in the order of the surface. So the first pass
//! counts them, and the second writes each to the part of the file of its entity. The tag of an
//! element is its number among the triangles of the surface, from 1 on.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::corners::{Corners, VertexBlocks, triangles};
use super::in_order::in_order;
use super::{File, WriteError, absolute, agree, faces_of, groups, record};
use crate::{Faces, Surface, region_code, region_name};

/// Bytes of a triangle: its tag and those of its corners.
const TRIANGLE: u64 = 32;

/// Gmsh's number for triangles of three nodes.
const TRIANGLE_TYPE: i32 = 2;

/// A section and a type: an entity. Surfaces of our own have one type in a section.
pub(super) type Label = (i32, i32);

/// The triangles of an entity.
pub(super) struct Entity {
    pub(super) tag: i32,
    pub(super) count: u64,
    low: DVec3,
    high: DVec3,
}

/// What is known of the faces before they are written.
pub(super) struct Census {
    pub(super) entities: BTreeMap<Label, Entity>,
    /// Tags of the first triangle and of the first half of a quad of each group.
    pub(super) first: Vec<[u64; 2]>,
}

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let blocks = VertexBlocks::find(surface)?;
    let census = Census::take(surface, &blocks)?;
    let mut at = 0;
    file.put(&mut at, &head(surface, &census))?;
    write_nodes(surface, &census, file, &mut at)?;
    write_elements(surface, &blocks, &census, file, at)
}

impl Census {
    pub(super) fn take(
        surface: &dyn Surface,
        blocks: &VertexBlocks<'_>,
    ) -> Result<Self, WriteError> {
        let (triangles, quads) = (surface.triangle_count(), surface.quad_count());
        let groups = groups(surface.face_blocks(), triangles + quads);
        let counted: Vec<_> = groups
            .into_par_iter()
            .map(|group| {
                let faces = faces_of(surface, group);
                let entities = count(&faces, &blocks.corners(&faces), surface.origin());
                (faces.triangles.len(), faces.quads.len(), entities)
            })
            .collect();
        let mut entities: BTreeMap<Label, Entity> = BTreeMap::new();
        let mut first = Vec::new();
        let mut found = [0, 0];
        for (of_triangles, of_quads, counted) in counted {
            first.push([1 + found[0] as u64, (1 + triangles + 2 * found[1]) as u64]);
            found = [found[0] + of_triangles, found[1] + of_quads];
            for (label, entity) in counted {
                entities
                    .entry(label)
                    .or_insert_with(Entity::none)
                    .add(&entity);
            }
        }
        agree("triangles", triangles, found[0])?;
        agree("quads", quads, found[1])?;
        give_tags(&mut entities);
        Ok(Self { entities, first })
    }

    /// Physical groups: a name by code.
    pub(super) fn names(&self) -> BTreeMap<i32, String> {
        let kinds = self.entities.keys().map(|&(_, kind)| kind);
        kinds
            .map(|kind| (region_code(kind), region_name(kind).into_owned()))
            .collect()
    }
}

impl Entity {
    fn none() -> Self {
        Self {
            tag: 0,
            count: 0,
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
        }
    }

    fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }
}

/// The triangles of a group by entity.
fn count(faces: &Faces, corners: &Corners, origin: DVec3) -> BTreeMap<Label, Entity> {
    let mut entities = BTreeMap::new();
    for triangle in triangles(faces) {
        let label = label(corners, triangle);
        let entity = entities.entry(label).or_insert_with(Entity::none);
        entity.count += 1;
        for corner in triangle {
            let at = corners.vertex(corner).position.as_dvec3() + origin;
            entity.low = entity.low.min(at);
            entity.high = entity.high.max(at);
        }
    }
    entities
}

pub(super) fn label(corners: &Corners, triangle: [u32; 3]) -> Label {
    let label = corners.label(triangle);
    (label.section, label.kind)
}

/// Tags of entities are positive and differ: the section plus one, or, where that does not do (only in
/// meshes that are not ours), the next that is free.
fn give_tags(entities: &mut BTreeMap<Label, Entity>) {
    let wanted = |section: i32| section.checked_add(1).filter(|&tag| tag > 0);
    let mut taken: BTreeSet<i32> = BTreeSet::new();
    let mut left = Vec::new();
    for (&(section, _), entity) in entities.iter_mut() {
        match wanted(section).filter(|&tag| taken.insert(tag)) {
            Some(tag) => entity.tag = tag,
            None => left.push(entity),
        }
    }
    let free = (1..=i32::MAX).filter(|tag| !taken.contains(tag));
    for (entity, tag) in left.into_iter().zip(free) {
        entity.tag = tag;
    }
}

/// Everything before the nodes.
fn head(surface: &dyn Surface, census: &Census) -> Vec<u8> {
    let mut head = Vec::new();
    head.extend_from_slice(b"$MeshFormat\n4.1 1 8\n");
    // How readers find out the order of bytes.
    head.extend_from_slice(&1i32.to_le_bytes());
    let names = census.names();
    let comment = format!(
        "\n$EndMeshFormat\n$Comments\nneurotess, units: {}\n$EndComments\n$PhysicalNames\n{}\n",
        surface.unit(),
        names.len()
    );
    head.extend_from_slice(comment.as_bytes());
    for (code, name) in names {
        head.extend_from_slice(format!("2 {code} \"{name}\"\n").as_bytes());
    }
    head.extend_from_slice(b"$EndPhysicalNames\n$Entities\n");
    let surfaces = census.entities.len() as u64;
    head.extend_from_slice(&record![32; 0u64, 0u64, surfaces, 0u64]);
    for (&(_, kind), entity) in &census.entities {
        let Entity { tag, low, high, .. } = entity;
        head.extend_from_slice(&record![72;
            tag, low.x, low.y, low.z, high.x, high.y, high.z, 1u64, region_code(kind), 0u64]);
    }
    head.extend_from_slice(b"\n$EndEntities\n");
    head
}

/// All nodes as one block of the first entity: nobody asks for the nodes of a surface alone.
fn write_nodes(
    surface: &dyn Surface,
    census: &Census,
    file: &mut File<'_>,
    at: &mut u64,
) -> Result<(), WriteError> {
    let count = surface.vertex_count() as u64;
    let mut head = b"$Nodes\n".to_vec();
    head.extend_from_slice(&record![32; u64::from(count > 0), count, u64::from(count > 0), count]);
    if count > 0 {
        let tag = census
            .entities
            .values()
            .next()
            .map_or(1, |entity| entity.tag);
        head.extend_from_slice(&record![20; 2i32, tag, 0i32, count]);
    }
    file.put(at, &head)?;
    let mut tags = Vec::new();
    for first in (1..=count).step_by(1 << 16) {
        tags.clear();
        tags.extend((first..=count.min(first + 0xffff)).flat_map(u64::to_le_bytes));
        file.put(at, &tags)?;
    }
    let origin = surface.origin();
    let mut places = [*at];
    file.vertices(surface, &mut places, |group, [bytes]| {
        bytes.reserve(24 * group.len());
        for vertex in group {
            let [x, y, z] = absolute(vertex, origin);
            bytes.extend_from_slice(&record![24; x, y, z]);
        }
    })?;
    [*at] = places;
    file.put(at, b"\n$EndNodes\n")
}

fn write_elements(
    surface: &dyn Surface,
    blocks: &VertexBlocks<'_>,
    census: &Census,
    file: &mut File<'_>,
    mut at: u64,
) -> Result<(), WriteError> {
    let entities = &census.entities;
    let total: u64 = entities.values().map(|entity| entity.count).sum();
    let mut head = b"$Elements\n".to_vec();
    head.extend_from_slice(&record![32; entities.len() as u64, total, u64::from(total > 0), total]);
    file.put(&mut at, &head)?;
    let mut places = BTreeMap::new();
    for (&label, entity) in entities {
        let head = record![20; 2i32, entity.tag, TRIANGLE_TYPE, entity.count];
        file.put(&mut at, &head)?;
        places.insert(label, at);
        at += TRIANGLE * entity.count;
    }
    let groups = groups(
        surface.face_blocks(),
        surface.triangle_count() + surface.quad_count(),
    );
    let groups: Vec<_> = groups.into_iter().zip(&census.first).collect();
    let encoded = |&(ref group, first): &(Range<usize>, &[u64; 2])| {
        let faces = faces_of(surface, group.clone());
        encode(&faces, &blocks.corners(&faces), *first)
    };
    in_order(&groups, encoded, |encoded| {
        for (label, bytes) in encoded {
            if let Some(place) = places.get_mut(&label) {
                file.put(place, &bytes)?;
            }
        }
        Ok(())
    })?;
    file.put(&mut at, b"\n$EndElements\n")
}

/// The elements of a group by entity.
fn encode(faces: &Faces, corners: &Corners, first: [u64; 2]) -> BTreeMap<Label, Vec<u8>> {
    let mut encoded: BTreeMap<Label, Vec<u8>> = BTreeMap::new();
    for (tag, triangle) in tagged(faces, first) {
        let [a, b, c] = triangle.map(|corner| u64::from(corner) + 1);
        let bytes = encoded.entry(label(corners, triangle)).or_default();
        bytes.extend_from_slice(&record![32; tag, a, b, c]);
    }
    encoded
}

/// The triangles of a group with their tags; these count from `first` on, for triangles and halves of quads.
pub(super) fn tagged(faces: &Faces, first: [u64; 2]) -> impl Iterator<Item = (u64, [u32; 3])> {
    let split = faces.triangles.len();
    triangles(faces).enumerate().map(move |(n, triangle)| {
        let tag = match n.checked_sub(split) {
            None => first[0] + n as u64,
            Some(half) => first[1] + half as u64,
        };
        (tag, triangle)
    })
}
