//! A cell in a page: its packed mesh as the library packs it, and what the page tells of its points.

use neurotess_color::{Cell, path_distances};
use neurotess_mesh::Role;
use neurotess_morphology::shape;
use neurotess_picture::Placement;
use neurotess_picture::color::category;
use neurotess_refine::{MeshPart, SHAPED_U32S, pack};
use serde::Serialize;

use crate::arrays::{ArrayRef, Arrays, share};

/// A cell to show, where it stands.
#[derive(Clone, Copy, Debug)]
pub struct PageCell<'c> {
    /// The tracing, its coarse mesh and its name.
    pub cell: Cell<'c>,
    /// Where it stands.
    pub placement: Placement,
}

/// A cell as the page's host reads it.
#[derive(Debug, Serialize)]
pub(crate) struct CellData {
    name: String,
    /// What to add to turned positions to get those in the world (µm).
    translation: [f64; 3],
    /// Rows of the turn, with the scale.
    linear: [[f64; 3]; 3],
    parts: Vec<PartData>,
    /// Color key of its first tracing point, and their number.
    first_key: usize,
    keys: usize,
    /// Of each tracing point: its section, [`NO_SECTION`] on somata.
    section: ArrayRef,
    /// Distance from the beginning of its neurite, as a share of `distance_most` (µm).
    distance: ArrayRef,
    distance_most: f32,
    /// Factor on the radii of the packed mesh.
    radius_factor: f64,
    /// Of each section: 1 + its parent, or 0.
    parents: ArrayRef,
    /// Of each section: distance of its end, as `distance`.
    ends: ArrayRef,
}

/// A part of a packed mesh.
#[derive(Debug, Serialize)]
pub(crate) struct PartData {
    packed: ArrayRef,
    /// The fields of `Base`, from the part's own beginning.
    layout: [u32; 11],
    slots: usize,
    /// Number of explicit vertices and corners of shaped rings.
    explicit: u32,
}

const NO_SECTION: u16 = u16::MAX;

/// Most patches of a part.
pub(crate) const MAX_PATCHES: usize = 1 << 20;

/// The packed parts of a cell whose tracing points have color keys of their own, from `first_key` on.
pub fn packed_parts(cell: &Cell<'_>, first_key: usize) -> Vec<MeshPart> {
    let keys = first_key..first_key + cell.mesh.tracing.len();
    let keys: Vec<u32> = keys.map(|key| category(key as u32)).collect();
    pack(cell.mesh, &keys, &[], MAX_PATCHES)
}

impl CellData {
    pub(crate) fn new(page: &PageCell<'_>, first_key: usize, arrays: &mut Arrays) -> Self {
        let cell = &page.cell;
        let parts = packed_parts(cell, first_key);
        let parts = parts.iter().map(|part| PartData::new(part, arrays));
        let parts = parts.collect();
        let linear = page.placement.linear();
        let tracing = &cell.mesh.tracing;
        let sections: Vec<u16> = tracing
            .iter()
            .map(|point| {
                let section = point.section.index().filter(|_| point.role != Role::Soma);
                section.map_or(NO_SECTION, |section| {
                    section.min(usize::from(NO_SECTION - 1)) as u16
                })
            })
            .collect();
        let distances = path_distances(cell);
        let distances: Vec<f32> = distances.iter().map(|d| d.unwrap_or(0.0)).collect();
        let ends: Vec<f32> = shape::path_lengths(cell.morphology)
            .iter()
            .map(|&end| end as f32)
            .collect();
        let most = |values: &[f32]| values.iter().copied().fold(0.0, f32::max);
        let distance_most = most(&distances).max(most(&ends));
        let shares = |values: &[f32], most: f32| -> Vec<u16> {
            values.iter().map(|&value| share(value, most)).collect()
        };
        let parents = cell.morphology.sections.iter();
        let parents =
            parents.map(|section| section.parent().map_or(0, |parent| parent.0 as u16 + 1));
        Self {
            name: cell.name.to_owned(),
            translation: page.placement.world_from_cell(cell.mesh.origin).to_array(),
            linear: linear.transpose().to_cols_array_2d(),
            parts,
            first_key,
            keys: tracing.len(),
            section: arrays.u16s(&sections),
            distance: arrays.u16s(&shares(&distances, distance_most)),
            distance_most,
            radius_factor: cell.radius_factor,
            parents: arrays.u16s(&parents.collect::<Vec<_>>()),
            ends: arrays.u16s(&shares(&ends, distance_most)),
        }
    }

    pub(crate) fn slots(&self) -> usize {
        self.parts.iter().map(|part| part.slots).sum()
    }
}

/// The arrays of a packed mesh with the sizes of their records. Twin of the layout in decode.rs of `refine`.
fn stretches(part: &MeshPart) -> Vec<(&[u32], usize)> {
    let l = &part.layout;
    let starts = [
        (l.points, 4),
        (l.spheres, 5),
        (l.explicit, 3),
        (l.anchors, 8),
        (l.shaped, SHAPED_U32S),
        (l.soma, 1),
        (l.quads, 2),
        (l.caps, 1),
        (l.color_keys, 1),
    ];
    let ends = starts[1..].iter().map(|&(start, _)| start as usize);
    let ends = ends.chain([part.packed.len()]);
    let stretch = |(&(start, size), end)| {
        let start: u32 = start;
        (&part.packed[start as usize..end], size)
    };
    starts.iter().zip(ends).map(stretch).collect()
}

impl PartData {
    fn new(part: &MeshPart, arrays: &mut Arrays) -> Self {
        let l = &part.layout;
        Self {
            packed: arrays.records(&stretches(part)),
            layout: [
                l.points,
                l.point_count,
                l.spheres,
                l.explicit,
                l.anchors,
                l.shaped,
                l.soma,
                l.soma_count,
                l.quads,
                l.caps,
                l.color_keys,
            ],
            slots: part.patches.len(),
            explicit: (l.anchors - l.explicit) / 3 + 4 * ((l.soma - l.shaped) / SHAPED_U32S as u32),
        }
    }
}
