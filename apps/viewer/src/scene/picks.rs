//! Which part of which neuron is at each pixel of a picture, and the mask of outlines.

use std::collections::HashMap;

use glam::DVec3;
use neurotess::mesh::{CoarseMesh, PatchKind};
use neurotess::render::Placement;
use neurotess::render::outline::{HOVERED, PICKED, SELECTED};
use neurotess::render::pick::{PickHit, PickId, PickTarget};

use crate::model::document::Document;
use crate::model::markers::MarkerRef;
use crate::model::sources::SectionFacts;
use crate::model::state::{CellPart, Picked};

/// Pixels around the cursor within which something thin counts as hit.
const REACH: i64 = 4;

/// What is under the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CursorHit {
    /// What it is.
    pub target: HitTarget,
    /// The center of the patch or marker (µm, in the world).
    pub place: DVec3,
}

/// What was hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HitTarget {
    /// A part of a neuron.
    Cell(Picked),
    /// A synapse or point.
    Marker(MarkerRef),
}

impl CursorHit {
    /// The part of a neuron, if it is one.
    pub fn picked(&self) -> Option<Picked> {
        match self.target {
            HitTarget::Cell(picked) => Some(picked),
            HitTarget::Marker(_) => None,
        }
    }

    /// The synapse or point, if it is one.
    pub fn marker(&self) -> Option<MarkerRef> {
        match self.target {
            HitTarget::Cell(_) => None,
            HitTarget::Marker(marker) => Some(marker),
        }
    }
}

/// Set where an opaque mesh is, which hides what is behind it.
const MESH: u32 = 1 << 31;

/// What is at each pixel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Picks {
    size: [u32; 2],
    /// By pixel: 0 if nothing is there, else 1 + the index in `seen`, or [`MESH`] and the index of a mesh.
    index: Vec<u32>,
    seen: Vec<CursorHit>,
}

impl Picks {
    /// `resolve` returns what is drawn at a pixel with an id, `mesh` the index of the mesh that is.
    pub(crate) fn new(
        size: [u32; 2],
        ids: &[PickId],
        mut resolve: impl FnMut(PickId) -> Option<CursorHit>,
        mesh: impl Fn(PickId) -> Option<usize>,
    ) -> Self {
        let mut seen = Vec::new();
        let mut known: HashMap<PickId, u32> = HashMap::from([([0; 2], 0)]);
        let mut last = ([0; 2], 0);
        let index = ids.iter().map(|&id| {
            // Neighboring pixels mostly have the same id.
            if last.0 != id {
                let index = *known.entry(id).or_insert_with(|| match resolve(id) {
                    Some(found) => {
                        seen.push(found);
                        seen.len() as u32
                    }
                    None => mesh(id).map_or(0, |mesh| MESH | mesh as u32),
                });
                last = (id, index);
            }
            last.1
        });
        let index = index.collect();
        Self { size, index, seen }
    }

    /// Width and height (pixels).
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What is at a pixel, or nearest within a few.
    pub(crate) fn at(&self, x: f32, y: f32) -> Option<CursorHit> {
        let (x, y) = (x.floor() as i64, y.floor() as i64);
        let mut near: Vec<(i64, i64)> = (-REACH..=REACH)
            .flat_map(|dy| (-REACH..=REACH).map(move |dx| (dx, dy)))
            .filter(|(dx, dy)| dx * dx + dy * dy <= REACH * REACH)
            .collect();
        near.sort_by_key(|(dx, dy)| dx * dx + dy * dy);
        near.into_iter()
            .find_map(|(dx, dy)| self.exactly(x + dx, y + dy))
    }

    /// Index of the mesh at a pixel, unless something thin is near.
    pub(crate) fn mesh_at(&self, x: f32, y: f32) -> Option<usize> {
        let index = self.index_at(x.floor() as i64, y.floor() as i64)?;
        let is_mesh = index & MESH != 0 && self.at(x, y).is_none();
        is_mesh.then_some((index & !MESH) as usize)
    }

    fn exactly(&self, x: i64, y: i64) -> Option<CursorHit> {
        let index = self.index_at(x, y)?;
        self.seen.get(index.checked_sub(1)? as usize).copied()
    }

    fn index_at(&self, x: i64, y: i64) -> Option<u32> {
        let [width, height] = self.size.map(i64::from);
        if !(0..width).contains(&x) || !(0..height).contains(&y) {
            return None;
        }
        self.index.get((y * width + x) as usize).copied()
    }

    /// Mask of outlines, with bits by pixel: selected neurons, the part under the cursor, and the
    /// part that was clicked; `markers`: the synapse or point under the cursor, and the one that was
    /// clicked.
    pub(crate) fn mask(
        &self,
        document: &Document,
        [hovered, picked]: [Option<Picked>; 2],
        markers: [Option<MarkerRef>; 2],
        sections: impl Fn(usize, u32) -> Option<SectionFacts>,
    ) -> Vec<u8> {
        let within = |part: Option<Picked>, seen: Picked| {
            part.is_some_and(|part| covers(part, seen, &sections))
        };
        let mut bits = vec![0];
        bits.extend(self.seen.iter().map(|hit| {
            let seen = match hit.target {
                HitTarget::Cell(seen) => seen,
                HitTarget::Marker(marker) => {
                    let is = |other| other == Some(marker);
                    let hovered = if is(markers[0]) { HOVERED } else { 0 };
                    return hovered | if is(markers[1]) { SELECTED | PICKED } else { 0 };
                }
            };
            let selected = if document.neurons.selected().contains(seen.neuron) {
                SELECTED
            } else {
                0
            };
            let hovered = if within(hovered, seen) { HOVERED } else { 0 };
            // The clicked part has an outline only while its neuron is selected.
            let picked = selected != 0 && within(picked, seen);
            selected | hovered | if picked { PICKED } else { 0 }
        }));
        self.join_markers(&mut bits);
        self.index
            .iter()
            .map(|&i| bits.get(i as usize).copied().unwrap_or(0))
            .collect()
    }

    /// Gives markers the bits of the parts of cells that they touch: they lie on these, and outlines go
    /// around both. `bits`: by index, as [`Picks::index`] has them.
    fn join_markers(&self, bits: &mut [u8]) {
        let is_marker = |index: u32| {
            let seen = index.checked_sub(1).and_then(|i| self.seen.get(i as usize));
            seen.is_some_and(|seen| seen.marker().is_some())
        };
        let width = self.size[0] as usize;
        let of_cells = bits.to_vec();
        if of_cells.iter().all(|&bits| bits == 0) {
            return;
        }
        for (at, &index) in self.index.iter().enumerate() {
            if !is_marker(index) {
                continue;
            }
            let around = [
                at.wrapping_sub(1),
                at + 1,
                at.wrapping_sub(width),
                at + width,
            ];
            for beside in around.into_iter().filter_map(|at| self.index.get(at)) {
                if *beside != index && !is_marker(*beside) {
                    let of_cell = of_cells.get(*beside as usize).copied();
                    bits[index as usize] |= of_cell.unwrap_or(0);
                }
            }
        }
    }
}

/// Whether a part contains another one.
fn covers(
    part: Picked,
    seen: Picked,
    sections: impl Fn(usize, u32) -> Option<SectionFacts>,
) -> bool {
    if part.neuron != seen.neuron {
        return false;
    }
    match (part.part, seen.part) {
        (CellPart::Neurite(neurite), CellPart::Section(section)) => {
            sections(seen.neuron, section).is_some_and(|facts| facts.neurite == neurite)
        }
        (a, b) => a == b,
    }
}

/// The part of a neuron that was hit, and where.
pub(crate) fn seen(hit: PickHit, mesh: &CoarseMesh, placement: &Placement) -> Option<CursorHit> {
    let (middle, tracing, soma) = match hit.target {
        PickTarget::Patch(patch) => {
            let patch = mesh.patches.get(patch as usize)?;
            let corners = patch.corners.map(|v| &mesh.vertices[v as usize]);
            let sum: DVec3 = corners.iter().map(|v| v.position.as_dvec3()).sum();
            // A lateral patch belongs to the child's section, which has the larger number, whichever way its path
            // runs; a loft to the branch's, at corner 2.
            let [near, far] = [corners[0], corners[2]].map(|v| v.tracing);
            let section = |tracing: u32| mesh.tracing[tracing as usize].section;
            let runs_up = patch.kind == PatchKind::Lateral && section(near) > section(far);
            let tracing = if runs_up { near } else { far };
            (sum / 4.0, tracing, patch.kind == PatchKind::Soma)
        }
        PickTarget::Vertex(vertex) => {
            let vertex = mesh.vertices.get(vertex as usize)?;
            (vertex.position.as_dvec3(), vertex.tracing, false)
        }
        PickTarget::Point(point) | PickTarget::Soma(point) => {
            let traced = mesh.tracing.get(point as usize)?;
            let soma = matches!(hit.target, PickTarget::Soma(_));
            (traced.center.as_dvec3(), point, soma)
        }
    };
    let section = mesh.tracing[tracing as usize].section;
    let part = match soma {
        true => CellPart::Soma,
        false => section
            .index()
            .map_or(CellPart::Soma, |index| CellPart::Section(index as u32)),
    };
    Some(CursorHit {
        target: HitTarget::Cell(Picked {
            neuron: hit.instance as usize,
            part,
        }),
        place: placement.world_from_cell(mesh.origin + middle),
    })
}

#[cfg(test)]
mod tests {
    use neurotess::mesh::{Patch, SectionNumber, TracingPoint, Vertex};

    use super::*;
    use crate::model::document::{Neuron, SourceId};
    use crate::model::index_set::IndexSet;

    fn picks() -> Picks {
        // Ten pixels in a row; the fourth shows a section, the fifth and sixth a soma.
        let ids = [0, 0, 0, 7, 9, 9, 0, 0, 0, 0].map(|id| [id, id]);
        Picks::new(
            [10, 1],
            &ids,
            |id| {
                let part = if id[0] == 7 {
                    CellPart::Section(2)
                } else {
                    CellPart::Soma
                };
                Some(CursorHit {
                    target: HitTarget::Cell(Picked { neuron: 0, part }),
                    place: DVec3::ZERO,
                })
            },
            |_| None,
        )
    }

    #[test]
    fn a_patch_between_two_sections_is_the_child_s() {
        // Two rings, on a parent (1) and on a child of it (2), with a patch from each to the other.
        let point = |section| TracingPoint {
            section: SectionNumber(section),
            ..TracingPoint::default()
        };
        let vertex = |tracing| Vertex {
            tracing,
            ..Vertex::default()
        };
        let patch = |corners| Patch {
            corners,
            kind: PatchKind::Lateral,
        };
        let mesh = CoarseMesh {
            tracing: [1, 2].map(point).to_vec(),
            vertices: [0, 0, 1, 1].map(vertex).to_vec(),
            patches: vec![patch([0, 1, 2, 3]), patch([3, 2, 1, 0])],
            ..CoarseMesh::default()
        };
        for number in 0..2 {
            let target = PickTarget::Patch(number);
            let hit = PickHit {
                instance: 0,
                target,
            };
            let picked = seen(hit, &mesh, &Placement::default()).and_then(|hit| hit.picked());
            let part = picked.map(|picked| picked.part);
            assert_eq!(part, Some(CellPart::Section(1)), "{number}");
        }
    }

    #[test]
    fn a_mesh_is_named_where_nothing_thin_is_near() {
        use crate::model::markers::MarkerRef::Point;
        // A marker on the left, and a mesh elsewhere.
        let mut ids = [[5, 5]; 12];
        ids[0] = [9, 9];
        let marker = CursorHit {
            target: HitTarget::Marker(Point(0)),
            place: DVec3::ZERO,
        };
        let resolve = |[id, _]: PickId| (id == 9).then_some(marker);
        let picks = Picks::new([12, 1], &ids, resolve, |[id, _]| (id == 5).then_some(3));
        let places = [0.5, 2.5, 8.5].map(|x| (picks.at(x, 0.5), picks.mesh_at(x, 0.5)));
        assert_eq!(
            places,
            [(Some(marker), None), (Some(marker), None), (None, Some(3))]
        );
        assert_eq!(picks.mesh_at(20.0, 0.5), None);
        let mask = picks.mask(
            &Document::default(),
            [None; 2],
            [Some(Point(0)), None],
            |_, _| None,
        );
        assert_eq!(mask[..3], [2, 0, 0]);
    }

    #[test]
    fn the_exact_pixel_wins_then_the_nearest() {
        let picks = picks();
        let part = |x| picks.at(x, 0.5).and_then(|s| s.picked()).map(|p| p.part);
        assert_eq!(part(3.9), Some(CellPart::Section(2)));
        assert_eq!(part(4.1), Some(CellPart::Soma));
        assert_eq!(part(1.0), Some(CellPart::Section(2)));
        assert_eq!(part(9.9), Some(CellPart::Soma));
        assert_eq!(picks.at(3.0, 9.0), None);
        assert_eq!(picks.at(-50.0, 0.0), None);
    }

    #[test]
    fn masks_show_selected_neurons_and_hovered_parts() {
        let mut document = Document::default();
        document.neurons.push(Neuron::new(SourceId(0), "n".into()));
        document.neurons.select(IndexSet::below(1));
        let facts = |_, section| {
            Some(SectionFacts {
                neurite: section / 2,
                ..Default::default()
            })
        };
        let hovered = |part| Some(Picked { neuron: 0, part });
        let mask = picks().mask(
            &document,
            [hovered(CellPart::Neurite(1)), None],
            [None; 2],
            facts,
        );
        assert_eq!(mask, [0, 0, 0, 3, 1, 1, 0, 0, 0, 0]);
        let mask = picks().mask(&document, [hovered(CellPart::Soma), None], [None; 2], facts);
        assert_eq!(mask, [0, 0, 0, 1, 3, 3, 0, 0, 0, 0]);
        // The clicked part keeps its outline while the neuron is selected.
        let mask = picks().mask(&document, [None, hovered(CellPart::Soma)], [None; 2], facts);
        assert_eq!(mask, [0, 0, 0, 1, 5, 5, 0, 0, 0, 0]);
        document.neurons.select(IndexSet::default());
        let mask = picks().mask(&document, [None, hovered(CellPart::Soma)], [None; 2], facts);
        assert_eq!(mask, [0; 10]);
    }

    #[test]
    fn markers_are_within_the_outline_of_what_they_lie_on() {
        use crate::model::markers::MarkerRef::Point;
        // Five pixels in a row: a soma with a marker on it, another marker beside, nothing.
        let ids = [9, 7, 9, 8, 0].map(|id| [id, id]);
        let picks = Picks::new(
            [5, 1],
            &ids,
            |[id, _]| {
                let soma = Picked {
                    neuron: 0,
                    part: CellPart::Soma,
                };
                Some(CursorHit {
                    target: match id {
                        9 => HitTarget::Cell(soma),
                        id => HitTarget::Marker(Point(u64::from(id))),
                    },
                    place: DVec3::ZERO,
                })
            },
            |_| None,
        );
        let mut document = Document::default();
        document.neurons.push(Neuron::new(SourceId(0), "n".into()));
        let mask =
            |document: &Document, markers| picks.mask(document, [None; 2], markers, |_, _| None);
        assert_eq!(
            mask(&document, [Some(Point(7)), Some(Point(8))]),
            [0, 2, 0, 5, 0]
        );
        document.neurons.select(IndexSet::below(1));
        assert_eq!(mask(&document, [None; 2]), [1, 1, 1, 1, 0]);
        assert_eq!(mask(&document, [None, Some(Point(7))]), [1, 5, 1, 1, 0]);
    }
}
